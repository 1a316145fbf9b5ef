#pragma once

#include <string>
#include <vector>

namespace wavetank::bench {

/// A Markdown table whose columns are padded to one width.
class TextTable {
 public:
  explicit TextTable(std::vector<std::string> header) : rows_{std::move(header)} {}

  /// As many cells as the header has.
  void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
  std::string text() const;

 private:
  std::vector<std::vector<std::string>> rows_;  ///< the header first
};

/// In four digits at the most; "–" for what is not finite.
std::string figure(double value);

}  // namespace wavetank::bench

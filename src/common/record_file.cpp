#include "wavetank/common/record_file.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <locale>
#include <optional>
#include <sstream>

#include "wavetank/common/error.h"
#include "wavetank/common/visible_text.h"

namespace wavetank {
namespace {

constexpr std::size_t longest_shown = 40, most_listed = 20;  // of a file's words, in messages

std::string trimmed(const std::string& text) {
  const char* const blanks = " \t\r";
  const std::size_t first = text.find_first_not_of(blanks);
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// Commas between quotes do not separate.
std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> values(1);
  bool quoted = false;
  for (const char letter : line) {
    if (letter == '"') quoted = !quoted;
    if (letter == ',' && !quoted) {
      values.emplace_back();
    } else {
      values.back() += letter;
    }
  }
  for (std::string& value : values) {
    value = trimmed(value);
    if (value.size() > 1 && value.front() == '"' && value.back() == '"') value = trimmed(value.substr(1, value.size() - 2));
  }
  return values;
}

/// Six significant digits, for messages.
std::string brief(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

/// The same whatever language the process is set to.
std::optional<double> number(const std::string& text) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  double value = 0;
  if (!(stream >> value) || stream.peek() != std::istringstream::traits_type::eof() || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace

RecordFile::RecordFile(const std::string& path, const std::string& what, const std::string& kind) : path_(path), what_(what), kind_(kind) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(place(0) + " cannot be read");
  int line = 0;
  for (std::string text; std::getline(file, text);) {
    if (++line == 1 && text.compare(0, 3, "\xEF\xBB\xBF") == 0) text.erase(0, 3);  // some spreadsheets' byte-order mark
    text = trimmed(text);
    if (text.empty() || text.front() == '#') continue;
    if (names_.empty()) {
      names_ = split(text);
      header_line_ = line;
      continue;
    }
    rows_.push_back({line, split(text)});
    if (rows_.back().values.size() != names_.size()) {
      throw Error(place(line) + " has " + std::to_string(rows_.back().values.size()) + " values, where the header in line " +
                  std::to_string(header_line_) + " names " + std::to_string(names_.size()) + " columns");
    }
  }
  if (names_.empty()) throw Error(place(0) + " has no header line with the columns' names");
  if (rows_.size() < 2) {
    throw Error(place(0) + " has " + std::to_string(rows_.size()) + (rows_.size() == 1 ? " line" : " lines") +
                " of values after its header; a " + kind_ + " takes at least two");
  }
}

std::string RecordFile::place(int line) const {
  return what_ + ": " + kind_ + " record file '" + path_ + "'" + (line > 0 ? ", line " + std::to_string(line) + "," : "");
}

bool RecordFile::has(const std::string& column) const { return std::find(names_.begin(), names_.end(), column) != names_.end(); }

std::string RecordFile::listed_columns() const {
  std::string list;
  for (std::size_t k = 0; k < names_.size(); ++k) {
    if (k > 0) list += k + 1 < names_.size() ? ", " : " and ";
    if (k == most_listed) return list + std::to_string(names_.size() - k) + " more";
    list += "'" + visible_text(names_[k], longest_shown) + "'";
  }
  return list;
}

std::size_t RecordFile::index_of(const std::string& column) const {
  const auto found = std::find(names_.begin(), names_.end(), column);
  if (found == names_.end()) throw Error(place(header_line_) + " names no column '" + column + "'; it names " + listed_columns());
  if (std::find(found + 1, names_.end(), column) != names_.end())
    throw Error(place(header_line_) + " names the column '" + column + "' twice");
  return static_cast<std::size_t>(found - names_.begin());
}

std::vector<double> RecordFile::numbers(const std::string& column) const {
  const std::size_t index = index_of(column);
  std::vector<double> values;
  values.reserve(rows_.size());
  for (const Row& row : rows_) {
    const std::optional<double> value = number(row.values[index]);
    if (!value)
      throw Error(place(row.line) + " column '" + column + "': '" + visible_text(row.values[index], longest_shown) +
                  "' is not a finite number");
    values.push_back(*value);
  }
  return values;
}

std::vector<double> RecordFile::times(const std::string& column) const {
  std::vector<double> values = numbers(column);
  for (std::size_t k = 1; k < values.size(); ++k) {
    if (!(values[k] > values[k - 1])) {
      throw Error(place(rows_[k].line) + " column '" + column + "': the time " + brief(values[k]) + " s does not come after " +
                  brief(values[k - 1]) + " s; times must increase from line to line");
    }
  }
  return values;
}

}  // namespace wavetank

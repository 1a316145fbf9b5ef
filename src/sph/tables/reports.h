#pragma once

#include <string>
#include <vector>

namespace wavetank {

/// A value that a step reports of all particles together.
struct ReportRow {
  enum class Kind {
    greatest,  ///< real: the greatest value, 0 at the least
    count,     ///< integer: the sum of the values
    first      ///< integer: the least index of a particle for which the value is true
  };

  std::string name;  ///< one word; kernels have its place as GREATEST_NAME or COUNTED_NAME
  Kind kind = Kind::greatest;
  std::string unit;  ///< "" of what has none
  std::string meaning;
  std::string value;             ///< of particle i, as device code: of w (watched_t), p, state, rates, stride, i
  std::string end = "greatest";  ///< of the greatest value, as device code of `greatest`: what is reported
};

/// Where the report has what: Δt of the next step, the greatest values, the integers, and then what else is added to it.
class ReportTable {
 public:
  static constexpr int nobody = 0x7fffffff;  ///< the first of none

  /// Throws Error if two rows have one name.
  explicit ReportTable(std::vector<ReportRow> rows);

  int greatest_count() const { return static_cast<int>(greatest_.size()); }
  int integer_count() const { return static_cast<int>(integers_.size()); }
  /// Places in the report, whose values are reals; an integer lies in the bytes from integers() on.
  int greatest(const std::string& name) const { return 1 + place(greatest_, name); }
  int integers() const { return 1 + greatest_count(); }
  int size() const { return integers() + integer_count(); }
  /// Among the integers; throws Error for one that there is not, as greatest() does.
  int integer(const std::string& name) const { return place(integers_, name); }
  const std::vector<ReportRow>& rows() const { return rows_; }
  /// The device's names for the places, and what finds the values.
  std::string header() const;

 private:
  static int place(const std::vector<std::string>& names, const std::string& name);

  std::vector<ReportRow> rows_;
  std::vector<std::string> greatest_, integers_;
};

/// Those that every case has.
const std::vector<ReportRow>& common_reports();

}  // namespace wavetank

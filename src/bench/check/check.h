#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "wavetank/compute/device.h"

namespace wavetank::bench {

/// A figure that was found, and what it may be.
struct Check {
  std::string what;
  double value = 0;
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  std::string unit;

  bool ok() const { return value >= least && value <= most; }  ///< what is no number is not
};

/// Checks that belong together, by one name.
struct CheckPart {
  std::string name;
  std::function<std::vector<Check>(const compute::DeviceInfo& device)> checks;  ///< may throw
};

/// What a part found.
struct PartResult {
  std::string name;
  std::vector<Check> checks;
  std::string failure;  ///< the sentence that ended it; empty = it went to its end
  double seconds = 0;   ///< wall clock

  bool ok() const;
};

struct CheckReport {
  std::string device;       ///< in one line
  std::size_t planned = 0;  ///< parts
  std::vector<PartResult> parts;

  /// Of all parts that were planned, and at least one.
  bool ok() const;
};

/// The parts of the self-check: every kernel, tiles, a dam break, a still tank.
const std::vector<CheckPart>& all_parts();
/// Those of these names, all of them without any. Throws Error for a name that no part has.
std::vector<CheckPart> chosen_parts(const std::vector<std::string>& names);

/// One part after the other, whatever becomes of those before. `each` is given the report so far after each part.
CheckReport run_parts(const std::vector<CheckPart>& parts, const compute::DeviceInfo& device,
                      const std::function<void(const CheckReport&)>& each);

/// A Markdown table, a check a line.
std::string table_of(const CheckReport& report);
std::string json_of(const CheckReport& report);

}  // namespace wavetank::bench

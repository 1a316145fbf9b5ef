#pragma once

#include <string>
#include <vector>

#include "device_limits.h"
#include "measurement.h"

namespace wavetank::bench {

struct Skipped {
  std::string name;
  std::string why;  ///< one sentence
};

/// All that one run of the benchmark tells.
struct Report {
  std::string device;  ///< in one line
  int repeats = 0;
  bool interrupted = false;
  DeviceLimits limits;
  std::vector<Measurement> cases;
  std::vector<Skipped> skipped;
};

/// Markdown tables: a case a line, times by kernel, the device's limits.
std::string table_of(const Report& report);
/// The same and each repeat's value, in SI units.
std::string json_of(const Report& report);

}  // namespace wavetank::bench

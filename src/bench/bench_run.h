#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bench_case.h"
#include "bench_options.h"
#include "report.h"
#include "wavetank/compute/device.h"

namespace wavetank::bench {

/// Goes through cases one after the other. Progress is told on standard error.
class BenchRun {
 public:
  /// `command`: starts this program, for cold builds. `stopped`: asked after each step; once it is true the run ends.
  BenchRun(const BenchOptions& options, const compute::DeviceInfo& device, std::vector<std::string> command, std::function<bool()> stopped);

  Report run(const std::vector<BenchCase>& cases);

 private:
  /// What is found out once for all cases that have the same kernels.
  struct Kernels {
    double bytes_per_particle = 0;
    double cold_build = 0;  ///< s; NaN if it was not measured
  };

  /// Throws Error for a case that cannot be measured; nothing if it was stopped before its first repeat.
  std::optional<Measurement> measure(const BenchCase& bench_case);
  /// They lie in the caches afterwards.
  const Kernels& kernels_of(const std::string& twin);
  void check_memory(const BenchCase& bench_case, double bytes_per_particle) const;

  BenchOptions options_;
  compute::DeviceInfo device_;
  std::vector<std::string> command_;
  std::function<bool()> stopped_;
  std::map<std::string, Kernels> kernels_;  ///< by the name of the small twin
};

}  // namespace wavetank::bench

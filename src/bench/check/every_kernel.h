#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "check.h"

namespace wavetank::bench {

/// What small cases have come to in a step or two each.
struct EveryKernel {
  std::vector<std::string> run;      ///< names of the kernels that were launched
  std::vector<std::string> missing;  ///< and of those in the sources that were not
  std::size_t cases = 0;
  std::size_t not_finite = 0;   ///< particles, readings and energies that are no numbers
  std::size_t violations = 0;   ///< cases that the watchdog would have stopped
  std::size_t wrong_pairs = 0;  ///< cases that count no pairs, or more of them than candidates
};

enum class KernelCases {
  few,  ///< of two sets of definitions that kernels are compiled with: a driver's compiler takes seconds for each
  all   ///< every kind of walls, diffusion, integrator and motion
};

/// Either runs every kernel. `tell` is given a line about each case.
EveryKernel run_every_kernel(const compute::DeviceInfo& device, KernelCases cases, const std::function<void(const std::string&)>& tell);

/// Of the few cases.
std::vector<Check> check_every_kernel(const compute::DeviceInfo& device);

}  // namespace wavetank::bench

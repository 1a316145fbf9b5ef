// Runs every kernel of the solver on some tens of particles in 2-D and 3-D, to be watched by oclgrind. Prints what it ran.
#include "../../src/bench/check/every_kernel.h"

#include <cstdio>
#include <exception>

#include "wavetank/compute/device.h"

int main() {
  using namespace wavetank;
  try {
    const compute::DeviceInfo device = compute::choose_device("auto");
    std::printf("%s\n", device.describe().c_str());
    const bench::EveryKernel found =
        bench::run_every_kernel(device, bench::KernelCases::all, [](const std::string& line) { std::printf("%s\n", line.c_str()); });
    std::printf("kernels run:");
    for (const std::string& kernel : found.run) std::printf(" %s", kernel.c_str());
    std::printf("\n");
    if (found.not_finite + found.violations + found.wrong_pairs == 0) return 0;
    std::fprintf(stderr, "%zu values are not finite, %zu cases are in violation, %zu count their pairs wrongly\n", found.not_finite,
                 found.violations, found.wrong_pairs);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
  }
  return 1;
}

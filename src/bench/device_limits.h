#pragma once

#include "wavetank/compute/device.h"

namespace wavetank::bench {

/// What a device does at the most, in single precision, as small kernels measure it: the best of several tries.
struct DeviceLimits {
  double flops = 0;          ///< 1/s, of fused multiply-adds, two each
  double bytes = 0;          ///< 1/s, to and from memory, of a triad over arrays much larger than the caches
  double inverse_roots = 0;  ///< 1/s, of 1/√x
};

DeviceLimits measure_limits(const compute::DeviceInfo& info);

}  // namespace wavetank::bench

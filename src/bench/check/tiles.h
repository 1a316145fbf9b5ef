#pragma once

#include <vector>

#include "check.h"

namespace wavetank::bench {

/// Disordered water beside a box, with spray, for a few steps: whatever is taken at a time, the same within rounding.
std::vector<Check> check_tiles(const compute::DeviceInfo& device);

}  // namespace wavetank::bench

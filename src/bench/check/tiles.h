#pragma once

#include <vector>

#include "check.h"

namespace wavetank::bench {

/// Disordered water about a plate thinner than the support, with spray, for a few steps: whatever is taken at a time, the same within
/// rounding.
std::vector<Check> check_tiles(const compute::DeviceInfo& device);

}  // namespace wavetank::bench

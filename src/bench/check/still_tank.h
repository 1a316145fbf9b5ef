#pragma once

#include <vector>

#include "check.h"

namespace wavetank::bench {

/// A tank at rest: hydrostatic pressure, and nothing moves.
std::vector<Check> check_still_tank(const compute::DeviceInfo& device);

}  // namespace wavetank::bench

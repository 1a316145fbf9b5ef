#pragma once

#include <vector>

#include "check.h"

namespace wavetank::bench {

/// One second of SPHERIC benchmark 2, 24 thousand particles: its key figures.
std::vector<Check> check_dam_break(const compute::DeviceInfo& device);

}  // namespace wavetank::bench

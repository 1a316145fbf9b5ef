#pragma once

#include <algorithm>

#include "wavetank/sph/solver.h"

namespace wavetank {

/// How much of the kernel about a point the fluid fills, the walls' share apart: 1 in the fluid, 1/2 on its surface, 0 in the air.
inline double filled(const PointValue& value) {
  if (value.shepard < 0.1) return 0.0;
  return std::min(value.filling / std::min(value.shepard, 1.0), 1.0);
}

}  // namespace wavetank

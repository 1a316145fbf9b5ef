#pragma once

#include <vector>

#include "wavetank/geometry/layout.h"
#include "wavetank/sph/solver.h"

namespace wavetank {

/// About the walls of each owner, as the layout has them; of an owner without walls the first centre.
std::vector<Box> owner_boxes(const Layout& layout, const std::vector<Vector3d>& centres);

/// The greatest speed of any point of a body, m/s; `boxes` and `centres` as at rest, the tank's first.
double fastest_wall(const std::vector<Box>& boxes, const std::vector<Vector3d>& centres, const WallMotions& motions);

}  // namespace wavetank

#pragma once

#include <vector>

#include "convex_hull.h"
#include "wavetank/geometry/mesh.h"

namespace wavetank {

/// Convex parts that together hold all of a closed solid, and little more. Planes, most of them of the solid's own faces, cut it until what
/// the pieces' hulls hold beyond the pieces is below 2 % of its volume, or 4 % once there are many of them. A solid of more triangles than
/// that, or that is round within and thin, may come out worse: ask volume_difference(). Empty if it encloses next to nothing.
std::vector<ConvexHull> convex_parts(const TriangleMesh& solid, const HullPrecision& precision, const std::string& what);

}  // namespace wavetank

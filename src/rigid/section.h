#pragma once

#include <vector>

#include "wavetank/geometry/mesh.h"

namespace wavetank {

/// The corners of a mesh's section with the plane y = 0, in any order; those of a box without width besides are its own. m.
std::vector<Vector3d> section_points(const TriangleMesh& mesh);

/// The section as convex polygons that fill it, without gaps or overlaps. Throws Error if it is not made of closed lines.
std::vector<std::vector<Vector3d>> convex_polygons(const TriangleMesh& mesh);

}  // namespace wavetank

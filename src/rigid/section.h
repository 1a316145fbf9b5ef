#pragma once

#include <utility>
#include <vector>

#include "wavetank/geometry/mesh.h"

namespace wavetank {

/// The corners of a mesh's section with the plane y = 0, in any order; those of a box without width besides are its own. m.
std::vector<Vector3d> section_points(const TriangleMesh& mesh);

/// The section as trapezoids with upright sides, anticlockwise as x goes right and z up, which fill it exactly; solids that overlap count
/// once. Throws Error if it is not made of closed lines.
std::vector<std::vector<Vector3d>> section_bands(const TriangleMesh& mesh);

/// The section as convex polygons that fill it, and hold at most 0.1 % more. Throws Error if it is not made of closed lines.
std::vector<std::vector<Vector3d>> convex_polygons(const TriangleMesh& mesh);

/// Where the upright lines through the abscissae (m) are in the section: from and to, upwards, a list a line.
std::vector<std::vector<std::pair<double, double>>> section_along(const TriangleMesh& mesh, const std::vector<double>& abscissae);

}  // namespace wavetank

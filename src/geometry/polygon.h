#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "wavetank/scene/case.h"

namespace wavetank {

/// Corners of a flat convex polygon, in order. m.
using Polygon = std::vector<Vector3d>;

/// Unit normal × area, by the corners' turn (right hand). m².
Vector3d vector_area(const Polygon& polygon);

/// Centre of area; the mean of the corners where the polygon has no area.
Vector3d centroid(const Polygon& polygon);

/// The part of a convex polygon where normal · x <= offset. Corners within `tolerance` of the plane count as on it; empty if nothing is
/// left.
Polygon part_below(const Polygon& polygon, const Vector3d& normal, double offset, double tolerance);

/// Of a face of a mesh file: ears are cut off one by one.
constexpr std::size_t most_corners = 4096;

/// Cuts a flat polygon, convex or not, into triangles over its corners by clipping ears; indices into `corners`.
std::vector<Eigen::Vector3i> triangulate(const std::vector<Vector3d>& corners);

/// "(1.2, 0, 3)", for messages.
std::string describe(const Vector3d& point);
std::string describe(double value);

/// How many cells of about `cell` fit into `length`: at least one. Ties round up even where the length carries rounding noise.
int cells_in(double length, double cell);

}  // namespace wavetank

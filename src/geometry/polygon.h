#pragma once

#include <Eigen/Geometry>
#include <cstdint>
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

/// That triangulate() may make for the faces of a mesh file: some ten seconds. A convex face takes the square of its corners.
constexpr std::uint64_t most_comparisons = 1000000000;

/// Cuts a flat polygon, convex or not, into triangles over its corners by clipping ears; indices into `corners`.
/// `budget`: how many comparisons it may make, at worst the cube of the corners, which it takes off; where that is not enough it leaves 0
/// and returns nothing.
std::vector<Eigen::Vector3i> triangulate(const std::vector<Vector3d>& corners, std::uint64_t* budget = nullptr);

/// "(1.2, 0, 3)", for messages.
std::string describe(const Vector3d& point);
std::string describe(double value);

/// How many cells of about `cell` fit into `length`: at least one. Ties round up even where the length carries rounding noise.
int cells_in(double length, double cell);

}  // namespace wavetank

#pragma once

#include <vector>

#include "triangle_grid.h"
#include "wavetank/geometry/mesh.h"

namespace wavetank {

/// A wall in 2-D: points in the plane y = 0 joined in order. A mesh's outline has the mesh's inside on the same hand all along.
struct Polyline {
  std::vector<Vector3d> points;  ///< m; y = 0
  bool closed = false;           ///< the last point is joined to the first
};
using Outline = std::vector<Polyline>;

/// The outline of a box: four edges, or three without the top.
Outline box_outline(const Box& box, bool open_top, const Top& top = {});

/// Where the mesh cuts the plane y = 0. Throws Error if it does not.
Outline cut_mesh(const TriangleMesh& mesh);

/// Whether a point of the plane lies inside closed outlines.
bool inside(const Outline& outline, const Vector3d& point);

/// Bounding box, y = 0.
Box bounding_box(const Outline& outline);

/// Ribbons across the plane, of y from −width/2 to width/2, that stop every way in the plane through the outline.
std::vector<WallTriangle> ribbons(const Outline& outline, double width, int owner);

}  // namespace wavetank

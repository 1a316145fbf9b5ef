#pragma once

#include <optional>
#include <vector>

#include "wavetank/geometry/layout.h"

namespace wavetank {

/// A wall with fluid on both sides.
struct ThinWall {
  int owner = 0;                      ///< 0 the tank, 1 + i body i
  double thickness = 0;               ///< m
  Vector3d place = Vector3d::Zero();  ///< a point of it, m
};

/// A free edge of a thin plate: beyond it water goes on, and no wall stands on it.
struct Brim {
  Vector3d from, to;      ///< m; the same point in 2-D
  Vector3d face_normal;   ///< of the face that ends there, out of the fluid
  Vector3d inwards;       ///< unit, in the face's plane from the edge onto the face
  Vector3d other_normal;  ///< of the face beyond the edge
  bool has_other = false;
  int owner = 0;  ///< 0 the tank, 1 + i body i
};

/// Which walls of a layout are thin: another one, facing the other way (within 37° of opposite), lies less than a given thickness behind
/// them.
struct ThinParts {
  std::vector<bool> facets, triangles, walls;  ///< as the layout's lists; a facet is thin if it is so anywhere
  std::vector<Brim> brims;                     ///< an edge twice, once for each of its faces
  std::optional<ThinWall> thinnest;            ///< none: no wall is thin
};

/// `thickness` in m. Facets that lie within a spacing of a thin one's plane and edge on, the rims of a plate of some thickness, are thin as
/// well when they are narrower than `thickness`.
ThinParts find_thin_parts(const Layout& layout, int dimensions, double thickness);

}  // namespace wavetank

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

/// An edge of a thin part around which water goes from one of its sides to the other: a fin's tip, a plate's rim, the sharp edge of a
/// wedge. Where a thin part meets another wall, or turns a corner as a box's skin does, it has no free edge.
struct FreeEdge {
  Vector3d from, to;  ///< m; the same point in 2-D
  int owner = 0;      ///< 0 the tank, 1 + i body i
};

/// How thin a piece of wall is: another one, facing the other way (within 37° of opposite), lies less than a given thickness behind it.
enum class Thin {
  no,
  yes,
  rim  ///< narrower than the thickness, between the two sides of a thin part
};

struct ThinParts {
  std::vector<Thin> facets, triangles, walls;  ///< as the layout's lists; a facet is thin if it is so anywhere
  std::vector<FreeEdge> free_edges;
  std::optional<ThinWall> thinnest;  ///< none: no wall is thin
};

/// `thickness` in m. Facets that lie within a spacing of a thin one's plane and edge on, the rims of a plate of some thickness, are thin as
/// well when they are narrower than `thickness`.
ThinParts find_thin_parts(const Layout& layout, int dimensions, double thickness);

}  // namespace wavetank

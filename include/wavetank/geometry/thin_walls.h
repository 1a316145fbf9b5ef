#pragma once

#include <optional>

#include "wavetank/geometry/layout.h"

namespace wavetank {

/// A wall with fluid on both sides.
struct ThinWall {
  int owner = 0;                      ///< 0 the tank, 1 + i body i
  double thickness = 0;               ///< m
  Vector3d place = Vector3d::Zero();  ///< of an element there, m
};

/// The thinnest place where wall elements face away from each other (within 37° of opposite) with less than `thickness` (m) of wall between
/// them, measured along the normal of one between centres that lie no more than a spacing beside each other; none if there is no such
/// place.
std::optional<ThinWall> thinnest_wall(const Layout& layout, double thickness);

}  // namespace wavetank

#pragma once

#include "wavetank/scene/case.h"

namespace wavetank {

/// The side of the tank's bounding box that is its top: the one that looks most nearly against gravity. Where two do alike, z comes before
/// y and y before x; without gravity it is that of greatest z.
struct Top {
  int axis = 2;
  int way = 1;  ///< 1: the box's greatest coordinate along the axis is the top; -1: its least

  Vector3d normal() const { return way * Vector3d::Unit(axis); }
  /// Of the tank's bounding box, m.
  double of(const Box& box) const { return way > 0 ? box.max[axis] : box.min[axis]; }
  double bottom_of(const Box& box) const { return way > 0 ? box.min[axis] : box.max[axis]; }
};

/// Gravity that the water can rest in, m/s²: without the parts along which a periodic tank repeats itself, which drive a channel.
Vector3d still_gravity(const Case& read);

/// Unit vector against that; +z without it.
Vector3d upward(const Case& read);

Top top_of(const Case& read);

/// Where the waves of a piston go, a unit vector.
Vector3d piston_way(const WaveCase& wave, const PrescribedCase& prescribed);

/// The height of the box's lowest corner over the origin, along `up`, m.
double lowest_of(const Box& box, const Vector3d& up);
/// Likewise of its highest.
double highest_of(const Box& box, const Vector3d& up);

}  // namespace wavetank

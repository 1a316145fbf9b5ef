#include "wavetank/scene/upward.h"

#include <cmath>

namespace wavetank {

Vector3d still_gravity(const Case& read) {
  Vector3d gravity = read.gravity;
  for (int axis = 0; axis < 3; ++axis)
    if (read.tank.periodic[axis] || (axis == 1 && read.dimensions == 2)) gravity[axis] = 0;
  return gravity;
}

Vector3d upward(const Case& read) {
  const Vector3d gravity = still_gravity(read);
  if (gravity.isZero(0)) return Vector3d::UnitZ();
  Vector3d up = Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis)
    if (gravity[axis] != 0) up[axis] = -gravity[axis] / gravity.norm();
  return up;
}

Top top_of(const Case& read) {
  const Vector3d up = upward(read);
  Top top;
  for (const int axis : {1, 0})
    if (std::abs(up[axis]) > std::abs(up[top.axis])) top.axis = axis;
  top.way = up[top.axis] < 0 ? -1 : 1;
  return top;
}

Vector3d piston_way(const WaveCase& wave, const PrescribedCase& prescribed) {
  const Vector3d way = wave.direction == Direction::sway     ? Vector3d(Vector3d::UnitY())
                       : wave.direction == Direction::stroke ? Vector3d(prescribed.axis.normalized())
                                                             : Vector3d(Vector3d::UnitX());
  return wave.reversed ? Vector3d(-way) : way;
}

double lowest_of(const Box& box, const Vector3d& up) { return (up.cwiseProduct(box.min)).cwiseMin(up.cwiseProduct(box.max)).sum(); }

double highest_of(const Box& box, const Vector3d& up) { return (up.cwiseProduct(box.min)).cwiseMax(up.cwiseProduct(box.max)).sum(); }

}  // namespace wavetank

#pragma once

#include <LinearMath/btTransform.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace wavetank {

static_assert(sizeof(btScalar) == sizeof(double), "Bullet must be built in double precision (pkg-config bullet-float64)");

inline btVector3 to_bullet(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
inline Eigen::Vector3d from_bullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
inline btTransform to_bullet(const Eigen::Quaterniond& turn, const Eigen::Vector3d& place) {
  return btTransform(btQuaternion(turn.x(), turn.y(), turn.z(), turn.w()), to_bullet(place));
}

}  // namespace wavetank

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace wavetank {

using Eigen::Quaterniond;
using Eigen::Vector3d;

/// Where a rigid body is and how it moves. `position` is that of its reference point, the centre of mass, or for a tank that is not free
/// the case's origin; `orientation` turns the body from where the case's geometry has it, so it is the identity at first. Accelerations are
/// those of the last step. In the world's axes, or relative to the tank and in the tank's axes where that is said.
struct RigidState {
  Vector3d position = Vector3d::Zero();
  Quaterniond orientation = Quaterniond::Identity();
  Vector3d velocity = Vector3d::Zero();              ///< m/s, of the reference point
  Vector3d angular_velocity = Vector3d::Zero();      ///< rad/s
  Vector3d acceleration = Vector3d::Zero();          ///< m/s²
  Vector3d angular_acceleration = Vector3d::Zero();  ///< rad/s²

  /// Where a point of the geometry as the case gives it has moved to; `reference` is the reference point's place there.
  Vector3d moved(const Vector3d& given, const Vector3d& reference) const { return position + orientation * (given - reference); }
  Vector3d velocity_at(const Vector3d& place) const { return velocity + angular_velocity.cross(place - position); }
};

/// A body as it is seen from a frame that moves with `frame`, in the frame's axes, where the geometry of the case lies as given;
/// `reference`: the frame's reference point there. All in the world on input.
RigidState seen_from(const RigidState& frame, const Vector3d& reference, const RigidState& body);

}  // namespace wavetank

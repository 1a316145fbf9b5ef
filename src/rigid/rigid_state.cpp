#include "wavetank/rigid/rigid_state.h"

namespace wavetank {

RigidState seen_from(const RigidState& frame, const Vector3d& reference, const RigidState& body) {
  const Quaterniond back = frame.orientation.conjugate();
  const Vector3d arm = body.position - frame.position, spin = frame.angular_velocity;
  const Vector3d velocity = body.velocity - frame.velocity - spin.cross(arm);
  const Vector3d turn = body.angular_velocity - spin;
  RigidState seen;
  seen.position = back * arm + reference;
  seen.orientation = (back * body.orientation).normalized();
  seen.velocity = back * velocity;
  seen.angular_velocity = back * turn;
  seen.acceleration = back * (body.acceleration - frame.acceleration - frame.angular_acceleration.cross(arm) - spin.cross(spin.cross(arm)) -
                              2.0 * spin.cross(velocity));
  seen.angular_acceleration = back * (body.angular_acceleration - frame.angular_acceleration - spin.cross(turn));
  return seen;
}

}  // namespace wavetank

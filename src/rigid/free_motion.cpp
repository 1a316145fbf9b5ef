#include "free_motion.h"

#include <cmath>

namespace wavetank {

Quaterniond turned_by(const Vector3d& rotation) {
  const double half = 0.5 * rotation.norm();
  const double ratio = half < 1e-4 ? 0.5 * (1 - half * half / 6) : 0.5 * std::sin(half) / half;
  return Quaterniond(std::cos(half), ratio * rotation.x(), ratio * rotation.y(), ratio * rotation.z());
}

RigidState moved_on(const RigidState& state, double time) {
  RigidState result = state;
  result.position += time * state.velocity;
  result.orientation = (turned_by(time * state.angular_velocity) * state.orientation).normalized();
  return result;
}

Inertia::Inertia(const MassProperties& properties, int dimensions) : mass(properties.mass), own(properties.inertia) {
  if (dimensions == 2) {
    const double about_y = own(1, 1);
    own = Matrix3d::Zero();
    own(1, 1) = about_y;
    own_inverse(1, 1) = 1 / about_y;
  } else {
    own_inverse = own.inverse();
    own_inverse = (0.5 * (own_inverse + own_inverse.transpose())).eval();
  }
}

Matrix3d Inertia::in_world(const Quaterniond& orientation) const {
  if (own(0, 0) == 0) return own;  // 2-D: turns about y leave it as it is, to the last bit
  const Matrix3d turn = orientation.toRotationMatrix();
  return turn * own * turn.transpose();
}

Matrix3d Inertia::inverse_in_world(const Quaterniond& orientation) const {
  if (own(0, 0) == 0) return own_inverse;
  const Matrix3d turn = orientation.toRotationMatrix();
  return turn * own_inverse * turn.transpose();
}

FreeMotion free_motion(const RigidState& state, const Inertia& inertia, const RigidLoad& load, double time_step) {
  FreeMotion motion;
  motion.velocity = state.velocity + time_step / inertia.mass * load.force;
  motion.mean_velocity = 0.5 * (state.velocity + motion.velocity);
  const Vector3d momentum = inertia.in_world(state.orientation) * state.angular_velocity;
  const Quaterniond middle = turned_by(0.5 * time_step * state.angular_velocity) * state.orientation;
  motion.mean_angular_velocity = inertia.inverse_in_world(middle) * (momentum + 0.5 * time_step * load.torque);
  const Quaterniond end = turned_by(time_step * motion.mean_angular_velocity) * state.orientation;
  motion.angular_velocity = inertia.inverse_in_world(end) * (momentum + time_step * load.torque);
  return motion;
}

RigidState after_step(const RigidState& state, const FreeMotion& motion, const BodyChange& change, double time_step) {
  RigidState end = state;
  end.velocity = motion.velocity + change.velocity;
  end.angular_velocity = motion.angular_velocity + change.angular_velocity;
  const Vector3d moves = change.touched ? end.velocity : Vector3d(motion.mean_velocity + 0.5 * change.velocity);
  const Vector3d turns = change.touched ? end.angular_velocity : Vector3d(motion.mean_angular_velocity + 0.5 * change.angular_velocity);
  end.position = state.position + time_step * (moves + change.push);
  end.orientation = (turned_by(time_step * (turns + change.turn)) * state.orientation).normalized();
  end.acceleration = (end.velocity - state.velocity) / time_step;
  end.angular_acceleration = (end.angular_velocity - state.angular_velocity) / time_step;
  return end;
}

}  // namespace wavetank

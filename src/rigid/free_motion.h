#pragma once

#include "impulse_solver.h"
#include "wavetank/rigid/mass_properties.h"
#include "wavetank/rigid/rigid_state.h"
#include "wavetank/rigid/rigid_world.h"

namespace wavetank {

using Eigen::Matrix3d;

/// The quaternion of a turn by a rotation vector, rad.
Quaterniond turned_by(const Vector3d& rotation);

/// Where a body is after a time at constant velocities.
RigidState moved_on(const RigidState& state, double time);

/// Mass and inertia as the equations of motion use them.
struct Inertia {
  Inertia() = default;
  Inertia(const MassProperties& properties, int dimensions);
  Matrix3d in_world(const Quaterniond& orientation) const;
  Matrix3d inverse_in_world(const Quaterniond& orientation) const;

  double mass = 0;                                                  ///< 0: its motion is given
  Matrix3d own = Matrix3d::Zero(), own_inverse = Matrix3d::Zero();  ///< in the body's axes; in 2-D only yy
};

/// What a step makes of a free body without contacts and joints: second order in the step, and its angular momentum to rounding.
struct FreeMotion {
  Vector3d velocity = Vector3d::Zero(), angular_velocity = Vector3d::Zero();            ///< at the end
  Vector3d mean_velocity = Vector3d::Zero(), mean_angular_velocity = Vector3d::Zero();  ///< that place and orientation change by
};
FreeMotion free_motion(const RigidState& state, const Inertia& inertia, const RigidLoad& load, double time_step);

/// The state at the end of the step. A body that contacts hold moves with its velocity at the end, which they have made such that nothing
/// overlaps; others with the mean of both, which is second order.
RigidState after_step(const RigidState& state, const FreeMotion& motion, const BodyChange& change, double time_step);

}  // namespace wavetank

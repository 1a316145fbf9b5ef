#pragma once

#include <cstddef>
#include <vector>

#include "wavetank/rigid/rigid_state.h"
#include "wavetank/scene/case.h"

namespace wavetank {

/// Follows commanded velocities within limits. The commands are in the body's axes (as geometry_msgs/Twist for a vehicle is), and so are
/// the limited accelerations: a vehicle that turns at a steady speed is not slowed by its limit.
class CommandedMotion {
 public:
  CommandedMotion(const CommandCase& limits, const Vector3d& reference, int dimensions);

  /// From `time` on, until the next command or the timeout. Components that do not exist in 2-D are ignored. Finite values only.
  void command(double time, const Vector3d& velocity, const Vector3d& angular_velocity);
  /// From `time` to time + time_step; returns the state at its end. After the timeout it brakes from the first step that starts then.
  const RigidState& advance(double time, double time_step);
  const RigidState& state() const { return state_; }

  /// Everything that the next steps depend on, as numbers.
  std::vector<double> save() const;
  /// Throws Error if there are not saved_size() of them.
  void restore(const std::vector<double>& values);
  std::size_t saved_size() const;

 private:
  CommandCase limits_;
  int dimensions_;
  RigidState state_;
  Vector3d wanted_velocity_ = Vector3d::Zero(), wanted_angular_velocity_ = Vector3d::Zero();  ///< in the body's axes
  double commanded_at_ = 0;
  bool commanded_ = false;
};

}  // namespace wavetank

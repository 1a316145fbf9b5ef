#pragma once

#include <array>
#include <string>
#include <vector>

#include "free_motion.h"
#include "impulse_solver.h"
#include "wavetank/rigid/rigid_world.h"
#include "wavetank/scene/case.h"

namespace wavetank {

/// An end of a joint: what it moves with, and the reference point of that as the case's geometry has it.
struct JointEnd {
  int owner = 0;  ///< the tank, a body, or the world, which comes after the last
  int frame = 0;  ///< that it moves with: itself, or the tank where it is fixed
  Vector3d reference = Vector3d::Zero();
};

/// The bodies at the start, the middle and the end of a step, as far as known before it: free ones moved on at their present velocities.
struct StepStates {
  std::vector<RigidState> start, middle, end;  ///< by frame
};

/// What was last commanded of a joint.
struct JointCommand {
  double value = 0;  ///< N or N·m, m/s or rad/s
  double at = 0;     ///< s
  bool given = false;
};

/// A joint as rows for the solver and, for its spring and damper, as loads; a velocity that is commanded is a row, an effort a load.
/// Its rows hold at the end of the step and act along where they are at its middle, which keeps a mechanism's energy to second order.
class Joint {
 public:
  /// Throws Error where the joint's numbers do not fit each other.
  Joint(const JointCase& joint, const JointEnd& child, const JointEnd& parent, int dimensions);

  const JointEnd& child() const { return child_; }
  const JointEnd& parent() const { return parent_; }
  /// Whether its ends stay at one place of each other, or on one line, so that the bodies have to pass through each other about it.
  bool holds_together() const;
  /// `time`: of the step's beginning, as commands end by it.
  void add_rows(const StepStates& states, const std::vector<Inertia>& inertias, double time, double time_step, double correction,
                std::vector<JointRow>& rows) const;
  /// Adds the forces of its spring and damper, implicit in the joint's own motion, so that no stiffness or damping is unstable by itself,
  /// and an effort that is commanded.
  void add_loads(const StepStates& states, const std::vector<Inertia>& inertias, double time, double time_step,
                 std::vector<RigidLoad>& loads) const;
  bool is_commanded() const { return joint_.command.has_value(); }
  const std::string& name() const { return joint_.name; }
  const JointCase& given() const { return joint_; }

  JointState state(const std::vector<RigidState>& states) const;
  /// Counts turns; to be called after every step.
  void follow(const std::vector<RigidState>& states);

  double angle = 0;      ///< rad, of a hinge, or of six_dof in 2-D, at the last step: all that a joint remembers ...
  JointCommand command;  ///< ... but for this, of one that is commanded

 private:
  /// A coordinate of the child relative to the parent and how it answers to velocities.
  struct Coordinate {
    double value = 0;
    Vector3d linear = Vector3d::Zero(), angular_child = Vector3d::Zero(), angular_parent = Vector3d::Zero();
    double rate(const RigidState& child, const RigidState& parent) const;
  };
  /// What is asked of a coordinate: locked where the limits are equal.
  struct Bounds {
    double least = 0, greatest = 0;
    bool locked() const { return least == greatest; }
  };

  Coordinate along(const Vector3d& direction, const std::vector<RigidState>& states) const;  ///< fixed to the parent
  Coordinate tilt(const Vector3d& direction, const std::vector<RigidState>& states) const;   ///< of a hinge's axis
  std::array<Coordinate, 3> rotations(const std::vector<RigidState>& states) const;          ///< roll, pitch, yaw, in 3-D
  std::array<Coordinate, 3> turns(const std::vector<RigidState>& states) const;              ///< small, about the axes
  Coordinate stretched(const std::vector<RigidState>& states) const;                         ///< a spring's length
  Coordinate free_one(const std::vector<RigidState>& states) const;                          ///< of hinge and slider, and pitch in 2-D
  /// What is commanded at a time, within the limits: 0 without a command.
  double wanted(double time) const;
  void add_spring(const StepStates& states, const std::vector<Inertia>& inertias, double time_step, std::vector<RigidLoad>& loads) const;
  void add_drive(const StepStates& states, double time, double time_step, std::vector<JointRow>& rows) const;
  std::vector<Coordinate> bounded(const std::vector<RigidState>& states, const Eigen::Matrix3d& axes) const;
  Eigen::Matrix3d settled_axes(const std::vector<RigidState>& states, const std::vector<Inertia>& inertias) const;
  double answer(const Coordinate& a, const Coordinate& b, const std::vector<RigidState>& states,
                const std::vector<Inertia>& inertias) const;
  double free_mobility(const Coordinate& coordinate, const std::vector<RigidState>& states, const std::vector<Inertia>& inertias) const;

  JointCase joint_;
  JointEnd child_, parent_;
  int dimensions_;
  Vector3d axis_ = Vector3d::UnitY();
  double length_ = 0;           ///< m, of a spring unstretched
  std::vector<Bounds> bounds_;  ///< of bounded()
};

}  // namespace wavetank

#pragma once

#include <utility>
#include <vector>

#include "wavetank/common/stopwatch.h"
#include "wavetank/rigid/rigid_world.h"
#include "wavetank/sph/solver.h"

namespace wavetank {

/// Carries the fluid's wrenches to the bodies and the bodies' motions to the fluid, in the course of each step.
///
/// A body's own momentum takes the fluid's force as it is, so that action is reaction. What the fluid is told of a free body's
/// acceleration, for the pressure on its walls, follows that acceleration with a relaxation: the force answers to it at once, as an added
/// mass M would, and where M is more than the body's own mass m the two would drive each other apart. With a' ← a' + θ (a − a'), θ = 1/(1 +
/// M/m), each step cancels just that answer.
class Coupling final : public WallMover {
 public:
  Coupling(RigidWorld& world, const Case& settled_case, const Layout& layout, const Discretisation& discretisation);

  std::vector<int> coupled() const override { return coupled_; }
  WallMotions at(double time_step, double fraction) override;
  WallMotions to_end(double time_step, const std::vector<WallWrench>& wrenches) override;

  /// The walls as the world has them now.
  WallMotions now() const;
  void set_time(double time) { time_ = time; }
  /// What presses on the owners in the next step besides the particles: one load an owner, in the tank's axes, or none.
  void set_film(std::vector<RigidLoad> loads) { film_ = std::move(loads); }
  /// The rigid world's steps so far.
  const Stopwatch& world_time() const { return world_time_; }
  /// The longest step in which the sound between the fluid and a free body does not grow, s; infinite without such bodies.
  double longest_time_step() const { return longest_time_step_; }
  /// The longest part of the step from the present time in which no point of a body moves farther in the tank than walls may. Velocities
  /// that are prescribed or commanded count as they will be, jumps too.
  double allowed_step(double time_step) const;

  std::vector<double> save() const;
  void restore(const std::vector<double>& values);

 private:
  struct Felt {  ///< accelerations as the fluid is told them, in the world's axes
    Vector3d linear = Vector3d::Zero(), angular = Vector3d::Zero();
  };
  WallMotions motions_of(const std::vector<RigidState>& states) const;
  std::vector<RigidState> present() const;

  /// The farthest that a point of a body moves in the tank from `from` to `to`, m.
  double farthest(const WallMotions& from, const std::vector<RigidState>& to) const;

  RigidWorld& world_;
  std::vector<double> reaches_;  ///< of each owner's bounding box from its reference point, m
  double farthest_allowed_;      ///< m
  Vector3d gravity_;
  bool tank_moves_;
  std::vector<int> coupled_;
  std::vector<Vector3d> belts_;
  std::vector<double> relaxation_;  ///< θ of each owner
  std::vector<Felt> felt_;
  std::vector<RigidLoad> film_;
  double longest_time_step_;
  double time_ = 0;
  Stopwatch world_time_;
};

}  // namespace wavetank

#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

namespace wavetank {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A body as contacts and joints see it, with the velocities that it would have after the step without them.
struct SolverBody {
  double inverse_mass = 0;                      ///< 1/kg; 0: its motion is given
  Matrix3d inverse_inertia = Matrix3d::Zero();  ///< 1/(kg·m²), in the world's axes
  Vector3d centre = Vector3d::Zero();           ///< m, where the velocity counts
  Vector3d velocity = Vector3d::Zero(), angular_velocity = Vector3d::Zero();
};

/// One point of contact between bodies a and b.
struct Contact {
  int a = 0, b = 0;
  int owner_a = 0, owner_b = 0;        ///< whose shapes touch, each fixed to its body
  Vector3d point = Vector3d::Zero();   ///< m
  Vector3d normal = Vector3d::Zero();  ///< unit, from b to a
  double gap = 0;                      ///< m; negative: they overlap
  double friction = 0, restitution = 0;
};

/// linear · (v_a − v_b) + angular_a · ω_a − angular_b · ω_b shall be `target` after the step, by an impulse within bounds. What leads it
/// back to a limit that it has passed is `push`, of which no velocity stays.
struct JointRow {
  int a = 0, b = 0;
  Vector3d linear = Vector3d::Zero(), angular_a = Vector3d::Zero(), angular_b = Vector3d::Zero();
  double target = 0, push = 0;
  double least_impulse = -1e300, greatest_impulse = 1e300;
  bool one_sided() const { return least_impulse == 0 || greatest_impulse == 0; }
};

struct BodyChange {
  Vector3d velocity = Vector3d::Zero(), angular_velocity = Vector3d::Zero();
  Vector3d push = Vector3d::Zero(),
           turn = Vector3d::Zero();  ///< m/s, rad/s: move it during this step only, out of overlaps and back to limits
  bool touched = false;              ///< by a contact or at a joint's limit
};

/// How one step is to be solved.
struct SolverSettings {
  double time_step = 0;      ///< s
  double correction = 0;     ///< of overlaps, taken away in the step
  double slop = 0;           ///< m, of overlap that stays, so that a contact at rest is one in every step
  double least_rebound = 0;  ///< m/s: slower ones do not rebound
  double resolution = 0;     ///< m/s: changes below it end the iterations
  int iterations = 0;        ///< at most
  bool planar = false;       ///< no friction along y
};

/// Bullet's sequential impulses, on rows that are set up here. Bullet's own set-up would let a body that comes near bounce off with less
/// than its restitution, and it takes warm starts from the step before, so that a run could not be continued bit for bit.
class ImpulseSolver {
 public:
  ImpulseSolver();
  ~ImpulseSolver();
  std::vector<BodyChange> solve(const std::vector<SolverBody>& bodies, const std::vector<Contact>& contacts,
                                const std::vector<JointRow>& rows, const SolverSettings& settings);

 private:
  class Rows;
  std::unique_ptr<Rows> rows_;
};

}  // namespace wavetank

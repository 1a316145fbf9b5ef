#pragma once

#include <string>
#include <vector>

#include "free_motion.h"
#include "wavetank/scene/case.h"

namespace wavetank {

/// What acts on one free body besides its weight, the fluid, contacts and joints: the case's forces and moorings, and the wrench that came
/// from outside. All are taken at the middle of the step, so that the steps are second order and a spring neither gains nor loses energy.
class OutsideForces {
 public:
  /// `what` opens the messages. `anchored`: moorings hang on the tank, else on the world. Throws Error for a mooring of no length without
  /// `length`.
  OutsideForces(const RigidCase& rigid, const Vector3d& reference, const Vector3d& tank_reference, bool anchored, const std::string& what);

  /// In the world's axes; `middle` and `tank` are states at the time, which is the middle of the step. What moorings pull on the tank is
  /// added to `on_tank`, about its reference point.
  RigidLoad at(double time, double time_step, const RigidState& middle, const Inertia& inertia, const RigidState& tank,
               const Inertia& tank_inertia, RigidLoad& on_tank) const;

  OutsideWrench wrench;

 private:
  RigidLoad pull(const MooringCase& mooring, double length, double time_step, const RigidState& middle, const Inertia& inertia,
                 const RigidState& tank, const Inertia& tank_inertia, RigidLoad& on_tank) const;

  std::vector<ForceCase> forces_;
  std::vector<MooringCase> moorings_;
  std::vector<double> lengths_;  ///< m, unstretched
  Vector3d reference_, tank_reference_;
  bool anchored_;
};

/// How fast the point `arm` away from a body's centre answers to a force along `direction`: 1/kg.
double mobility(const Inertia& inertia, const Quaterniond& orientation, const Vector3d& arm, const Vector3d& direction);

/// The mean force over a step of a spring and a damper in parallel, which draw two points together; `stretch` at its middle by the velocity
/// `rate` at its start. Implicit in its own motion (the midpoint rule for one spring), so that no stiffness or damping is unstable by
/// itself.
double spring_force(double stiffness, double damping, double stretch, double rate, double mobility, double time_step);

}  // namespace wavetank

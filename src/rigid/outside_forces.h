#pragma once

#include <optional>
#include <string>
#include <vector>

#include "catenary.h"
#include "free_motion.h"
#include "wavetank/scene/case.h"
#include "wind.h"

namespace wavetank {

/// What acts on one free body besides its weight, the fluid, contacts and joints: the case's forces, wind and moorings, and the wrench that
/// came from outside. All are taken at the middle of the step, so that the steps are second order and a spring neither gains nor loses
/// energy.
class OutsideForces {
 public:
  /// `what` opens the messages. `anchored`: moorings hang on the tank, else on the world. Throws Error for a mooring of no length without
  /// `length`, and for a catenary without gravity.
  OutsideForces(const RigidCase& rigid, const Vector3d& gravity, const Vector3d& reference, const Vector3d& tank_reference, bool anchored,
                const std::string& what);

  /// In the world's axes; `middle` and `tank` are states at the time, which is the middle of the step. What moorings pull on the tank is
  /// added to `on_tank`, about its reference point.
  RigidLoad at(double time, double time_step, const RigidState& middle, const Inertia& inertia, const RigidState& tank,
               const Inertia& tank_inertia, RigidLoad& on_tank) const;

  /// The case's moorings where body and tank are.
  std::vector<MooringState> moorings(const RigidState& body, const RigidState& tank) const;

  OutsideWrench wrench;

 private:
  /// The two ends of a mooring, in the world.
  struct Ends {
    Vector3d anchor, end;                    ///< m
    Vector3d anchor_velocity, end_velocity;  ///< m/s
  };
  Ends ends_of(const MooringCase& mooring, const RigidState& body, const RigidState& tank) const;
  Catenary catenary(std::size_t mooring) const;
  /// How a catenary pulls from its anchor to its top. Throws Error for one that does not stretch and is taut.
  CatenaryPull catenary_pull_of(std::size_t mooring, const Vector3d& way) const;
  /// On its top, N, in the world's axes.
  Vector3d force_on_top(const CatenaryPull& pull, const Vector3d& way) const;
  /// Unit, from the anchor to under the top; zero where the line is upright.
  Vector3d beside(const Vector3d& way) const;
  RigidLoad pull_catenary(std::size_t mooring, double time_step, const RigidState& middle, const Inertia& inertia, const RigidState& tank,
                          const Inertia& tank_inertia, RigidLoad& on_tank) const;
  RigidLoad pull(const MooringCase& mooring, double length, double time_step, const RigidState& middle, const Inertia& inertia,
                 const RigidState& tank, const Inertia& tank_inertia, RigidLoad& on_tank) const;

  std::vector<ForceCase> forces_;
  std::vector<MooringCase> moorings_;
  std::vector<double> lengths_;  ///< m, unstretched
  std::optional<Wind> wind_;
  Vector3d wind_centre_;  ///< m, as the case's geometry has it
  Vector3d up_;           ///< unit, against gravity; zero without
  Vector3d reference_, tank_reference_;
  bool anchored_;
  std::string what_;
};

/// How fast the point `arm` away from a body's centre answers to a force along `direction`: 1/kg.
double mobility(const Inertia& inertia, const Quaterniond& orientation, const Vector3d& arm, const Vector3d& direction);

/// The mean force over a step of a spring and a damper in parallel, which draw two points together; `stretch` at its middle by the velocity
/// `rate` at its start. Implicit in its own motion (the midpoint rule for one spring), so that no stiffness or damping is unstable by
/// itself.
double spring_force(double stiffness, double damping, double stretch, double rate, double mobility, double time_step);

}  // namespace wavetank

#pragma once

#include <memory>
#include <string>
#include <vector>

#include "wavetank/geometry/layout.h"
#include "wavetank/rigid/mass_properties.h"
#include "wavetank/rigid/rigid_state.h"
#include "wavetank/scene/case.h"

namespace wavetank {

/// A force and a torque about a body's centre of mass, N and N·m (2-D: N/m and N), in the world's axes.
struct RigidLoad {
  Vector3d force = Vector3d::Zero();
  Vector3d torque = Vector3d::Zero();
};

/// A wrench from outside (a thruster, a mooring): held until replaced, or until `until`.
struct OutsideWrench {
  Vector3d force = Vector3d::Zero();   ///< N (2-D: N/m)
  Vector3d torque = Vector3d::Zero();  ///< N·m, about the centre of mass
  bool turns_with_body = true;         ///< in the body's axes; else in the world's
  double until = 1e300;                ///< s of simulated time
};

struct JointState {
  double position = 0;  ///< m or rad from the start, of hinge (turns are counted), slider and spring (its length); 0 for the others
  double velocity = 0;  ///< m/s or rad/s
  double effort = 0;    ///< N or N·m, of its spring and damper on the child along the position; of a spring negative where it pulls
};

/// A mooring as it is.
struct MooringState {
  double tension = 0;          ///< N (2-D: N/m), at its attachment; of a spring that pushes negative
  double anchor_tension = 0;   ///< likewise, at its anchor
  double lying = 0;            ///< m of a catenary that lie on its bed
  std::vector<Vector3d> line;  ///< m, places on it from the anchor on, in the tank's coordinates; as many in every state
};

/// The tank (0) and the bodies (1 + i) as rigid bodies, in the world's inertial axes, which are the case's coordinates at t = 0. Bullet
/// finds contacts between bodies and solves for the impulses of contacts and joints. A step depends on nothing but what save() returns:
/// contacts are found anew in every step, and solved without a warm start, so that a restored run goes on bit for bit. A fixed body is part
/// of the tank: it moves with it, and where the tank is free the fluid's load on it acts on the tank; its mass is not added. Prescribed and
/// commanded motions are in the world, whatever the tank does. Moorings of the tank itself hang on the world. In contacts, free bodies are
/// convex parts. The tank, and bodies that are not free, are their own facets where their shape is `automatic`, hollows and all, from the
/// fluid's side, and convex parts else. A body that has gone over the rim passes through the tank's walls from outside, and nothing stops
/// it at the ends of a periodic tank. Two bodies, or a body and the tank, that a joint holds together pass through each other; a spring
/// does not hold, nor does a joint of six degrees of freedom that leaves one of x, y and z free. Bodies that are not free do not feel
/// contacts.
class RigidWorld {
 public:
  /// Of what a wrench from outside alone may make of a free body, m/s²: a hundred times gravity. Angular accelerations count at the body's
  /// radius of gyration.
  static constexpr double greatest_acceleration = 1000;
  /// Of what a joint's effort alone may make of all that hangs on either end, if the case does not limit the effort, m/s²: motors turn
  /// light rotors much faster than bodies can move in water. About a hinge at the radius of gyration about its axis.
  static constexpr double greatest_joint_acceleration = 1e5;

  /// Makes nothing of Bullet's where no body is free. Throws Error for mass properties that cannot be, prescribed motions that cannot be
  /// read, joints and moorings that do not fit, and free bodies that start wholly outside of the tank. Says once, through the log, where a
  /// collision shape is an approximation and by how much, how deep bodies overlap at the start, and which of them have no floor under them.
  RigidWorld(const Case& settled_case, const Layout& layout, const ResourceResolver& resolve = {});
  ~RigidWorld();

  std::size_t count() const;            ///< of owners: 1 + bodies
  bool moves(std::size_t owner) const;  ///< its motion is not fixed
  bool anything_moves() const;
  bool is_free(std::size_t owner) const;
  const MassProperties& properties(std::size_t owner) const;  ///< of bodies that are not free: mass 0 unless given, centre all the same
  const Vector3d& reference(std::size_t owner) const;         ///< the reference point as the case's geometry has it
  RigidState state(std::size_t owner) const;                  ///< in the world
  /// The same relative to the tank, in the tank's axes: as the fluid, which is solved there, sees it.
  RigidState state_in_tank(std::size_t owner) const;

  /// States after half of the step from `time`, with the present velocities; leaves the world as it is. Accelerations of commanded owners
  /// are the change of velocity over the whole step.
  std::vector<RigidState> at_middle(double time, double time_step) const;
  /// States at the end of the step from `time`, free owners with their present velocities; leaves the world as it is.
  std::vector<RigidState> at_end(double time, double time_step) const;
  /// One step; `fluid`: one load an owner, in the world's axes; those of bodies that are not free are not used.
  /// Throws Error, naming body and time, for a load that is not finite.
  void advance(double time, double time_step, const std::vector<RigidLoad>& fluid);

  /// Throws Error for a body that is not free, a value that is not finite, and one beyond greatest_acceleration.
  void set_outside_wrench(std::size_t owner, const OutsideWrench& wrench);
  /// Throws Error for a body that is not commanded, or a value that is not finite. In the body's axes.
  void command(std::size_t owner, double time, const Vector3d& velocity, const Vector3d& angular_velocity);

  /// Of an effort (N or N·m) or a velocity (m/s or rad/s) of a joint that is commanded. Throws Error for one that is not, a value that
  /// is not finite, and, where the case does not limit its effort, one beyond greatest_joint_acceleration.
  void command_joint(std::size_t joint, double time, double value);
  /// At present, of the tank and then of the bodies, in the case's order.
  std::vector<MooringState> moorings() const;
  /// Whether it is a paddle that takes away the waves which come back to it.
  bool absorbs(std::size_t owner) const;
  /// What the gauge of such a paddle shows at the beginning of a step, m. Throws Error for another body, or a level that is not finite.
  void see_waves(std::size_t owner, double time, double level);
  /// How much of the way that it may take for that it has taken, 0 to 1.
  double absorption_taken(std::size_t owner) const;
  /// What decides how such a paddle absorbs, beside its state: numbers to compare, of no use beside. Empty for another body.
  std::vector<double> absorption_settings(std::size_t owner) const;
  /// Where a prescribed motion has an owner at a time, whatever it has absorbed. Throws Error for one that is not prescribed.
  RigidState planned(std::size_t owner, double time) const;

  std::size_t joint_count() const;
  JointState joint_state(std::size_t joint) const;

  /// Kinetic energy, and potential about the case's origin, of the free bodies, J (2-D: J/m).
  double kinetic_energy() const;
  double potential_energy() const;

  std::vector<char> save() const;
  /// Throws Error, and stays as it was, if the bytes are not those of this world, or what they hold is not finite.
  void restore(const std::vector<char>& bytes);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace wavetank

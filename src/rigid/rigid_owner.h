#pragma once

#include <optional>
#include <string>
#include <vector>

#include "free_motion.h"
#include "outside_forces.h"
#include "wave_absorption.h"
#include "wavetank/geometry/layout.h"
#include "wavetank/rigid/commanded_motion.h"
#include "wavetank/rigid/prescribed_motion.h"
#include "wavetank/rigid/rigid_world.h"
#include "wavetank/scene/case.h"

namespace wavetank {

/// The tank or a body with all that its motion depends on.
struct RigidOwner {
  std::string what;  ///< for messages: "the tank", "body 'hull'"
  Motion motion = Motion::fixed;
  MassProperties properties;
  Inertia inertia;                        ///< of mass 0 unless it is free
  Vector3d reference = Vector3d::Zero();  ///< m, as the case's geometry has it
  RigidState state;                       ///< in the world; of a body that is fixed to the tank see riding()
  std::optional<PrescribedMotion> prescribed;
  std::optional<WaveAbsorption> absorption;  ///< of a piston, beside what is prescribed ...
  Vector3d wave_way = Vector3d::Zero();      ///< ... along this, unit
  std::optional<CommandedMotion> commanded;
  std::optional<OutsideForces> forces;  ///< of free ones

  bool is_free() const { return motion == Motion::free; }
  /// Of a prescribed one.
  RigidState prescribed_at(double time) const;
};

/// The tank and the bodies of a case at the start.
std::vector<RigidOwner> make_owners(const Case& settled_case, const Layout& layout, const ResourceResolver& resolve);

/// How a point that is fixed to a moving frame moves; `place` as the case's geometry has it.
RigidState riding(const RigidState& frame, const Vector3d& frame_reference, const Vector3d& place);

/// The numbers of a state, one after the other, and back.
void append(std::vector<double>& values, const RigidState& state);
RigidState take_state(const double*& values);

}  // namespace wavetank

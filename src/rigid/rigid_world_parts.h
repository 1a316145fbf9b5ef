#pragma once

#include <memory>
#include <string>
#include <vector>

#include "contacts.h"
#include "joints.h"
#include "number_text.h"
#include "rigid_owner.h"
#include "wavetank/rigid/rigid_world.h"

namespace wavetank {

/// All that a RigidWorld is made of, and what happens within a step. Frames are owners, and after the last the world.
struct RigidWorld::Parts {
  Parts(const Case& scene, const Layout& layout, const ResourceResolver& resolve);

  void make_joints(const Case& scene);
  void make_contacts(const Case& scene, const Layout& layout, const ResourceResolver& resolve);

  int frame_of(std::size_t owner) const { return owner > 0 && owners[owner].motion == Motion::fixed ? 0 : static_cast<int>(owner); }
  RigidState state(std::size_t owner) const {
    return frame_of(owner) == static_cast<int>(owner) ? owners[owner].state
                                                      : riding(owners[0].state, owners[0].reference, owners[owner].reference);
  }
  std::vector<RigidState> present() const;
  std::vector<RigidState> ahead(double time, double step) const;
  /// Gives what is fixed to the tank the tank's motion.
  void ride(std::vector<RigidState>& states) const;
  std::vector<RigidState> at_middle(double time, double time_step) const;
  std::vector<RigidLoad> loads(double time, double time_step, const std::vector<RigidLoad>& fluid, const StepStates& states) const;
  std::vector<BodyChange> changes(double time, double time_step, const StepStates& states, const std::vector<RigidState>& given,
                                  const std::vector<FreeMotion>& motions) const;
  std::string at_time(double time) const { return " at " + number_text(time) + " s"; }
  /// The free owners that hang on an end of a joint, itself among them, by other joints.
  std::vector<std::size_t> hanging_on(std::size_t joint, const JointEnd& end) const;
  /// What an effort of a hinge (N·m) or a slider (N) alone would make of them, m/s²: about a hinge at their radius of gyration about it.
  double acceleration_by(std::size_t joint, const JointEnd& end, double effort) const;
  RigidOwner& checked(std::size_t owner, Motion motion, const char* word);
  /// The values that RigidWorld::save wrote.
  void take(const std::vector<double>& values);
  /// Whether each owner's orientation is of length 1.
  bool turns_are_turns() const;

  int dimensions;
  Vector3d gravity;
  double spacing;
  std::vector<RigidOwner> owners;
  std::vector<Inertia> inertias;  ///< by frame, the world's last
  std::vector<Joint> joints;
  std::unique_ptr<ContactFinder> contacts;  ///< none where nothing is free
  mutable ImpulseSolver solver;             ///< keeps nothing but memory
};

}  // namespace wavetank

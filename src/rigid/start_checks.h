#pragma once

#include <vector>

#include "impulse_solver.h"
#include "joints.h"
#include "rigid_owner.h"
#include "wavetank/geometry/layout.h"
#include "wavetank/scene/case.h"

namespace wavetank {

/// Throws Error for a free body that starts wholly outside of the tank, where nothing holds it: neither a joint, nor the tank if it is to
/// fall in through an open top. Warns, through the log, of one under which there is no floor that contacts know.
void check_places(const Case& scene, const Layout& layout, const std::vector<RigidOwner>& owners, const std::vector<Joint>& joints);

/// Warns, through the log, of the deepest overlap among the contacts at the start.
void tell_of_overlaps(const std::vector<Contact>& contacts, const std::vector<RigidOwner>& owners, double spacing);

}  // namespace wavetank

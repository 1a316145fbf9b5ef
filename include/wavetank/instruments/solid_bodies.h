#pragma once

#include <vector>

#include "wavetank/geometry/layout.h"
#include "wavetank/rigid/rigid_world.h"
#include "wavetank/scene/case.h"

namespace wavetank {

/// A body, for the question what lies inside it: as the case's geometry has it.
struct SolidBody {
  std::size_t owner = 0;
  TriangleMesh mesh;
  bool is_box = false;
  Box box;  ///< about it, and in 2-D without ends along y

  bool contains(const Vector3d& point) const;
};

/// All bodies of the case.
std::vector<SolidBody> solid_bodies(const Case& scene, const Layout& layout);

/// Leaves those marks of `open`, one a place in the tank (m), that do not lie inside one of the bodies where it is now.
std::vector<char> without_bodies(std::vector<char> open, const std::vector<Vector3d>& places, const std::vector<SolidBody>& bodies,
                                 const RigidWorld& world);

}  // namespace wavetank

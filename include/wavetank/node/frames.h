#pragma once

#include <string>
#include <vector>

#include "wavetank/rigid/rigid_world.h"
#include "wavetank/scene/case.h"

namespace wavetank {

/// The tf frame of the tank or of a body. Its axes are those of the case's coordinates at the start, and turn with the body.
struct BodyFrame {
  std::string name;
  std::string parent;                     ///< of a body the tank's; of the tank the inertial one
  bool moves = false;                     ///< relative to its parent
  Vector3d origin = Vector3d::Zero();     ///< m, as the case's geometry has it: a body's reference point; for the tank the case's origin
  Vector3d reference = Vector3d::Zero();  ///< m, likewise: the reference point that samples are about (RigidState)
};

/// 0 the tank, 1 + i body i. `references`: of each, m, as the case's geometry has it.
std::vector<BodyFrame> body_frames(const Case& checked, const std::vector<Vector3d>& references);

/// Of the body that a probe is fixed to, by its name, as body_frames counts them; 0 for the tank.
std::size_t owner_of(const Case& checked, const std::string& body);

/// Reference points of the tank and the bodies, for body_frames.
std::vector<Vector3d> reference_points(const RigidWorld& bodies);

}  // namespace wavetank

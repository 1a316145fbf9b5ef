#pragma once

#include <string>
#include <vector>

#include "wavetank/scene/case.h"

namespace wavetank::scene {

struct RobotParts {
  std::vector<BodyCase> bodies;
  std::vector<JointCase> joints;
};

/// The bodies and joints of a robot described by URDF text, with all of its joints at zero, at the placement's position and rotation.
/// A link with a shape becomes a body; one without is merged into the link that it is fixed to. Meshes' relative names are relative to
/// `directory`, which is empty where the text is of no file. Throws Error beginning with `source`.
RobotParts robot_parts(const std::string& urdf, const std::string& source, const std::string& directory, const RobotCase& placement);

}  // namespace wavetank::scene

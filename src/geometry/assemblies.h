#pragma once

#include <vector>

#include "wavetank/scene/case.h"

namespace wavetank {

/// What moves as one, whatever happens: of each owner (0 the tank, 1 + i body i) the least one that it is held to by joints without a free
/// direction. Fixed bodies are held to the tank, and where the tank is fixed so is what is held to the world.
std::vector<int> rigid_assemblies(const Case& checked);

/// Whether the joint leaves its two ends no way to move against each other.
bool is_rigid(const JointCase& joint, int dimensions);

}  // namespace wavetank

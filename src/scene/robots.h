#pragma once

#include "setting.h"
#include "wavetank/scene/case_reader.h"

namespace wavetank::scene {

/// Makes bodies and joints of the case's robots, after those that it has, and leaves it no robots. Throws Error for a description that is
/// not found or not read, and for what this tank has no equal of, naming the file or parameter and the link or joint.
void build_robots(Case& read, const Setting& root, const Surroundings& surroundings);

/// The names under robots/N/parameter in a tree that nothing else has been checked of.
std::vector<std::string> robot_parameters(const Setting& root);

}  // namespace wavetank::scene

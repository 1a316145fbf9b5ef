#pragma once

#include "values.h"
#include "wavetank/scene/case.h"

namespace wavetank::scene {

/// The list of robots, of which nothing is written: what they consist of is written as bodies and joints.
Codec<std::vector<RobotCase>> robot_list();

}  // namespace wavetank::scene

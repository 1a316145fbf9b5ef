#pragma once

#include "setting.h"
#include "wavetank/scene/case.h"

namespace wavetank::scene {

/// Throws Error, with place and key, for a mesh or a motion record that is not there or is no file. An address that ROS resolves, and a
/// relative path of a case that has no file of its own, are left to whoever opens them.
void check_files(const Case& read, const Setting& root);

}  // namespace wavetank::scene

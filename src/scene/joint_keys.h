#pragma once

#include "section.h"
#include "wavetank/scene/case.h"

namespace wavetank::scene {

Section<JointCase> joint_section();

/// Checks that every joint has a name of its own and ends that exist, differ and can move against each other.
void check_joints(const Case& read, const Setting& root);

}  // namespace wavetank::scene

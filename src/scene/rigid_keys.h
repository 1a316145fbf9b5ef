#pragma once

#include "section.h"
#include "wavetank/scene/case.h"

namespace wavetank::scene {

/// Adds the keys of the section's RigidCase, which stand directly beside its other keys, and the rules that tie them to its motion.
void add_rigid_keys(Section<TankCase>& section);
void add_rigid_keys(Section<BodyCase>& section);

}  // namespace wavetank::scene

#pragma once

#include "section.h"
#include "wavetank/scene/case.h"

namespace wavetank::scene {

Section<PrescribedCase> prescribed_section();
Section<CommandCase> command_section();

}  // namespace wavetank::scene

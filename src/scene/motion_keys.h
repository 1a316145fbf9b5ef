#pragma once

#include <set>

#include "section.h"
#include "wavetank/scene/case.h"

namespace wavetank::scene {

Section<PrescribedCase> prescribed_section();
/// Those that the case itself names: a record without a column has whichever its file names.
std::set<Direction> directions_of(const PrescribedCase& prescribed);
Section<CommandCase> command_section();

}  // namespace wavetank::scene

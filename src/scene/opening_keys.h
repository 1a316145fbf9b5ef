#pragma once

#include "section.h"
#include "wavetank/scene/case.h"

namespace wavetank::scene {

/// The keys of one entry of `openings`.
Section<OpeningCase> opening_section();

/// The keys of one entry of `instruments/sections`.
Section<FlowSectionCase> flow_section();

/// That openings fit the rest of the case: names, bodies, walls.
void check_openings(const Case& read, const Setting& root);

}  // namespace wavetank::scene

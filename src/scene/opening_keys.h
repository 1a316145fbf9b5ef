#pragma once

#include "section.h"
#include "wavetank/scene/case.h"

namespace wavetank::scene {

/// The keys of one entry of `openings`.
Section<OpeningCase> opening_section();

/// That openings fit the rest of the case: names, bodies, walls.
void check_openings(const Case& read, const Setting& root);

}  // namespace wavetank::scene

#pragma once

#include "section.h"
#include "wavetank/scene/case.h"

namespace wavetank::scene {

/// The keys of waves that a prescribed body makes.
Section<WaveCase> wave_section();

/// Waves that are there at the start.
Section<InitialWaveCase> initial_wave_section();

}  // namespace wavetank::scene

#pragma once

#include "section.h"
#include "wavetank/scene/case.h"

namespace wavetank::scene {

/// The registry: every key of a case, each declared once.
const Section<Case>& case_section();

/// The same as one section without a name, for checks of structure and for the page of keys.
const KeyDescription& case_keys();

/// Where gauges stand depends on gravity: along its axis they have no place.
void place_gauges(Case& read, const Setting& root);

/// α₂ of a case file that does not give it, with δ-SPH and the symplectic integrator: the most that
/// costs no time step with the usual `courant` and `artificial_viscosity`.
inline constexpr double usual_acoustic_damping = 2;

/// α of a case file that does not give it, with moving least squares: with 0.02, the usual one of SPH, water does not rest.
inline constexpr double usual_least_squares_viscosity = 0.1;

/// δ-SPH's diffusion, artificial viscosity and acoustic damper are the defaults of that scheme only.
void choose_dissipation(Case& read, const Setting& root);

/// Checks that concern several keys of a case that has been read from `root`: names given twice, gravity out of a 2-D case's plane, ...
void check_case(const Case& read, const Setting& root);

}  // namespace wavetank::scene

#pragma once

#include <string>
#include <vector>

#include "wavetank/geometry/layout.h"
#include "wavetank/rigid/wave_theory.h"

namespace wavetank {

/// What the paddles of a case are to make, by theory. Throws Error as PrescribedMotion.
std::vector<ExpectedWaves> expected_waves(const Case& checked, const Layout& layout, const ResourceResolver& resolve);

/// Warns through the log of waves that would break, that the spacing or the theory is too coarse for, and of paddles that leave the tank.
void tell_of_waves(const Case& checked, const Layout& layout, const ResourceResolver& resolve);

}  // namespace wavetank

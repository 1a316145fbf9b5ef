#pragma once

#include "fluid_filling.h"

namespace wavetank {

/// Throws Error naming a pressure probe that lies inside a body (deeper than a quarter of the spacing) or where the fluid cannot come, and
/// a wave gauge outside the tank. A probe on a wall is fine.
void check_instruments(const InstrumentsCase& instruments, const Basin& basin, const OpenSpace& open, double spacing);

}  // namespace wavetank

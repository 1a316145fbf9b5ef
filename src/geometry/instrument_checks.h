#pragma once

#include "fluid_filling.h"

namespace wavetank {

/// Throws Error naming a pressure or velocity probe that lies inside a body (deeper than a quarter of the spacing) or where the fluid
/// cannot come, and a wave gauge outside the tank. A probe on a wall is fine.
void check_instruments(const InstrumentsCase& instruments, const Basin& basin, const OpenSpace& open, double spacing);

/// Unit normals of the walls that the discs of the case's pressure probes lie on, zero for a probe without one. Throws Error naming a probe
/// whose disc lies on no wall, reaches beyond an edge of it, is bent by more than a twentieth of its diameter, or reaches over an opening.
std::vector<Vector3d> disc_normals(const InstrumentsCase& instruments, const Basin& basin, const std::vector<Opening>& openings,
                                   double spacing);

}  // namespace wavetank

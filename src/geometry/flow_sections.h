#pragma once

#include "fluid_filling.h"
#include "open_space.h"

namespace wavetank {

/// The case's sections with their cells, less those in walls and bodies that stand. Throws Error for one that no water can come to.
std::vector<FlowSection> place_sections(const std::vector<FlowSectionCase>& sections, const Basin& basin, const OpenSpace& open,
                                        double spacing);

}  // namespace wavetank

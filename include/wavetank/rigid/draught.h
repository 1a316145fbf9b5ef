#pragma once

#include <optional>

#include "wavetank/geometry/mesh.h"

namespace wavetank {

/// How deep a closed, outwards-wound body floats in still water if it stays upright: m from its lowest point up to the water's surface,
/// where it displaces `volume` (m³; 2-D: m², of the section with y = 0). What it keeps dry, as an open boat's cockpit, is displaced too.
/// Within 2 % of the body's height. None = it displaces less than that even where it is wholly under water: it sinks.
std::optional<double> draught(const TriangleMesh& closed, double volume, int dimensions);

}  // namespace wavetank

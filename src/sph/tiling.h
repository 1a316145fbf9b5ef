#pragma once

#include <string>

#include "wavetank/compute/device.h"
#include "wavetank/scene/case.h"

namespace wavetank {

/// What the neighbour loop takes at a time, as tile.cl has tiles: so many particles (or points), each with so many candidates.
struct Tile {
  int own = 1;
  int near = 1;

  std::string build_options() const;
};

/// How a solver goes over neighbours, by the class of its device.
struct Tiling {
  Tile particles;
  Tile points;                ///< of points and wall elements, which need not lie together
  int rows_per_support = 1;   ///< of the particles' grid, across
  int slots_per_support = 1;  ///< and along x
};

/// `scalar`: every neighbour needs a look by itself (ghosts).
Tiling tiling_for(const compute::DeviceInfo& device, Precision precision, bool scalar);

}  // namespace wavetank

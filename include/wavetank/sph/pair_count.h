#pragma once

#include <cstdint>

namespace wavetank {

/// Of one sweep over all particles, counted on the device.
struct PairCount {
  std::uint64_t pairs = 0;       ///< (i, j) with |x_j − x_i| < R, each seen from i and from j; a particle is no pair with itself
  std::uint64_t candidates = 0;  ///< that the neighbour loop goes through to find these, each particle itself included
};

}  // namespace wavetank

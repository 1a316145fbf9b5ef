#pragma once

#include <cstddef>

namespace wavetank {

/// What the water in so many parts would need, as it is laid out.
struct PartsNeed {
  int parts = 1;
  std::size_t own = 0;         ///< particles of the part that goes over the most
  std::size_t others = 0;      ///< of which it has copies
  std::size_t all_others = 0;  ///< copies that all parts have together
  double memory = 0;           ///< bytes on a device, of the part that needs the most, after a step
};

}  // namespace wavetank

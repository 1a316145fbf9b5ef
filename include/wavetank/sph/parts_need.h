#pragma once

#include <cstddef>

namespace wavetank {

/// What the water in so many parts would need, as it is laid out.
struct PartsNeed {
  int parts = 1;
  std::size_t own = 0;         ///< particles of the largest part
  std::size_t others = 0;      ///< of which it has copies
  std::size_t all_others = 0;  ///< copies that all parts have together
  double memory = 0;           ///< bytes on its device
};

}  // namespace wavetank

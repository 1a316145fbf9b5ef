#pragma once

#include <random>

namespace wavetank {

/// In [0, 1), of the generator's own bits: what distributions make of them is each library's choice.
inline double uniform(std::mt19937_64& generator) { return static_cast<double>(generator() >> 11) * 0x1p-53; }

}  // namespace wavetank

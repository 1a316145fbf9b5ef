#pragma once

#include <boost/math/tools/roots.hpp>
#include <cstdint>

namespace wavetank {

/// The zero of a function that increases between two places, to so many bits of it (Alefeld, Potra and Shi's algorithm 748); the nearer end
/// where it has none there.
template <class Function>
double zero_of(const Function& function, double low, double high, int bits = 48) {
  const double at_low = function(low), at_high = function(high);
  if (!(at_low < 0)) return low;
  if (!(at_high > 0)) return high;
  std::uintmax_t iterations = 200;
  const auto bracket =
      boost::math::tools::toms748_solve(function, low, high, at_low, at_high, boost::math::tools::eps_tolerance<double>(bits), iterations);
  return 0.5 * (bracket.first + bracket.second);
}

}  // namespace wavetank

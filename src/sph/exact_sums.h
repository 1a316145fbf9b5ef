#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "tables/device_sizes.h"

namespace wavetank {

/// Sums as whole numbers (exact_sums.cl): a value is so many quanta, and rests, 2⁻³⁸ of a quantum each. A row of `values` sums has so many
/// places. A value that is not finite, or beyond 10¹⁵ quanta, some 10⁹ typical ones, makes the whole row NaN.
constexpr int exact_places(int values) { return 2 * values + 1; }

/// Quanta of one unit, where values measure about `typical` units: a power of two, so that no bit is lost. A millionth of that is one; of
/// its rests 2⁻⁵⁸ of that.
inline double quanta_per_unit(double typical) { return std::ldexp(1.0, 20 - std::ilogb(std::max(typical, 1e-30))); }

/// Of forces or impulses of a particle, and of their moments over a spacing.
struct ExactScale {
  ExactScale(double typical, double spacing) : quanta{quanta_per_unit(typical), quanta_per_unit(typical * spacing)} {}

  double quanta[2];  ///< per N, say, and per N·m
};

/// Of a row of sums, the k-th in units. NaN where a value was lost.
inline double exact_value(const std::int64_t* row, int k, int values, double quanta) {
  if (row[exact_places(values) - 1] != 0) return std::numeric_limits<double>::quiet_NaN();
  const std::int64_t carried = row[values + k] >> field::rest_bits,
                     rest = row[values + k] - carried * (std::int64_t{1} << field::rest_bits);
  return (static_cast<double>(row[k] + carried) + std::ldexp(static_cast<double>(rest), -field::rest_bits)) / quanta;
}

}  // namespace wavetank

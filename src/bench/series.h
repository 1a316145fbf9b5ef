#pragma once

#include <vector>

namespace wavetank::bench {

/// One quantity measured several times; both functions are NaN if it was never measured.
struct Series {
  std::vector<double> values;

  double median() const;          ///< the mean of the two in the middle, if there are two
  double spread_percent() const;  ///< (greatest − least)/median; 0 of a median of 0
};

}  // namespace wavetank::bench

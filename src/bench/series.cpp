#include "series.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wavetank::bench {

double Series::median() const {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  const std::size_t middle = sorted.size() / 2;
  return sorted.size() % 2 == 1 ? sorted[middle] : 0.5 * (sorted[middle - 1] + sorted[middle]);
}

double Series::spread_percent() const {
  const double middle = median();
  if (std::isnan(middle)) return middle;
  if (middle == 0) return 0;
  const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
  return 100.0 * (*greatest - *least) / std::abs(middle);
}

}  // namespace wavetank::bench

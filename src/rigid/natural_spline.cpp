#include "natural_spline.h"

#include <algorithm>
#include <utility>

namespace wavetank {

NaturalSpline::NaturalSpline(std::vector<double> times, std::vector<double> values)
    : times_(std::move(times)), values_(std::move(values)), accelerations_(times_.size(), 0.0) {
  // That the rates agree where two pieces meet is one equation for the accelerations at three neighbouring points. Forwards each is left
  // with its own and the next one; backwards these are put in.
  std::vector<double> coupling(times_.size(), 0.0);
  for (std::size_t k = 1; k + 1 < times_.size(); ++k) {
    const double before = times_[k] - times_[k - 1], after = times_[k + 1] - times_[k];
    const double change_of_slope = (values_[k + 1] - values_[k]) / after - (values_[k] - values_[k - 1]) / before;
    const double pivot = 2.0 * (before + after) - before * coupling[k - 1];
    coupling[k] = after / pivot;
    accelerations_[k] = (6.0 * change_of_slope - before * accelerations_[k - 1]) / pivot;
  }
  for (std::size_t k = times_.size() - 1; k-- > 1;) accelerations_[k] -= coupling[k] * accelerations_[k + 1];
}

Change NaturalSpline::at(double time) const {
  if (time < times_.front()) return {values_.front(), 0.0, 0.0};
  if (time > times_.back()) return {values_.back(), 0.0, 0.0};
  const auto next = std::upper_bound(times_.begin() + 1, times_.end() - 1, time);
  const std::size_t right = static_cast<std::size_t>(next - times_.begin()), left = right - 1;
  const double length = times_[right] - times_[left], b = (time - times_[left]) / length, a = 1.0 - b;
  const double from = accelerations_[left], to = accelerations_[right];
  Change change;
  change.value = a * values_[left] + b * values_[right] + length * length / 6.0 * ((a * a * a - a) * from + (b * b * b - b) * to);
  change.rate = (values_[right] - values_[left]) / length + length / 6.0 * ((3.0 * b * b - 1.0) * to - (3.0 * a * a - 1.0) * from);
  change.acceleration = a * from + b * to;
  return change;
}

}  // namespace wavetank

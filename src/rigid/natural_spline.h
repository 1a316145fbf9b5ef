#pragma once

#include <cstddef>
#include <vector>

namespace wavetank {

/// A value that changes with time, and its first two derivatives.
struct Change {
  double value = 0;
  double rate = 0;
  double acceleration = 0;
};

/// The natural cubic spline through points: value, rate and acceleration are continuous from the first point to the last, and the
/// acceleration is 0 at both. Outside them the value is held and does not change.
class NaturalSpline {
 public:
  /// At least two points, times increasing.
  NaturalSpline(std::vector<double> times, std::vector<double> values);
  Change at(double time) const;
  std::size_t size() const { return times_.size(); }

 private:
  std::vector<double> times_, values_, accelerations_;
};

}  // namespace wavetank

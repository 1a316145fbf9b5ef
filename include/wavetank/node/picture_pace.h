#pragma once

#include <algorithm>
#include <chrono>

namespace wavetank {

/// When the next picture of the water is due: at most at a rate of wall time, and so seldom that pictures take no more than 3 % of the
/// time, since what makes them has the processor in common with the solver.
class PicturePace {
 public:
  /// `rate`: Hz, greater than 0.
  explicit PicturePace(double rate) : shortest_(1.0 / rate) {}

  /// `seconds`: of wall time that the last picture took, 0 before there was one. The one before it counts too: a single long one, the first
  /// for which something had to be made, does not hold up the next.
  bool is_due(double seconds) const {
    const double pause = std::max(shortest_, std::min(seconds, seconds_before_) / most_of_the_time);
    return !has_begun_ || Clock::now() - last_ >= std::chrono::duration<double>(pause);
  }
  /// Another picture, when the last one has taken `seconds`.
  void begin(double seconds) {
    seconds_before_ = seconds;
    last_ = Clock::now();
    has_begun_ = true;
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr double most_of_the_time = 0.03;

  double shortest_;  ///< s between two pictures
  double seconds_before_ = 0;
  bool has_begun_ = false;
  Clock::time_point last_;
};

}  // namespace wavetank

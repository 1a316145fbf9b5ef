#include "wavetank/node/stamps.h"

#include <cmath>

namespace wavetank {

ros::Time StampClock::at(double time) const {
  const double whole = std::floor(time);
  const auto nanoseconds = static_cast<std::uint64_t>(std::llround((time - whole) * 1e9));
  const auto seconds = static_cast<std::uint64_t>(whole + offset_);
  ros::Time stamp;
  stamp.fromNSec(seconds * 1000000000ULL + nanoseconds);
  return stamp;
}

void StampClock::restart_after(double last) { offset_ = std::floor(offset_ + last) + 1.0; }

ros::Time nonzero(const ros::Time& stamp) { return stamp.isZero() ? ros::TIME_MIN : stamp; }

}  // namespace wavetank

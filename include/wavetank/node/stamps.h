#pragma once

#include <ros/time.h>

#include <atomic>

namespace wavetank {

/// Turns simulated time into ROS time. The two are the same until the simulation goes back to its start: ROS time then goes on from the
/// next whole second, because a clock that runs backwards empties tf buffers and silences others' timers.
class StampClock {
 public:
  /// time: s of simulated time, ≥ 0. Rounded to the nearest nanosecond.
  ros::Time at(double time) const;
  /// The simulation went back to time 0 when its time was `last`.
  void restart_after(double last);

 private:
  std::atomic<double> offset_{0.0};  ///< s, whole
};

/// The same, but never zero, which roscpp and rosbag take as "no time": for /clock and for the times of records in a bag.
ros::Time nonzero(const ros::Time& stamp);

}  // namespace wavetank

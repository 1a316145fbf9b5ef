#pragma once

#include <ros/ros.h>
#include <tf2_msgs/TFMessage.h>

#include <chrono>
#include <mutex>

namespace wavetank {

/// Publishes moving transforms on /tf, and gives the last ones to whoever begins to listen while the simulation stands: an rviz that is
/// opened on a paused or finished run would otherwise not know where the bodies are. All members may be called from any thread.
class TransformPublisher {
 public:
  explicit TransformPublisher(ros::NodeHandle& handle);
  void publish(const tf2_msgs::TFMessage& transforms);
  /// The same for something of their stamp that is no sample; only if that stamp has not been reached yet.
  void publish_between_samples(const tf2_msgs::TFMessage& transforms);

 private:
  using Clock = std::chrono::steady_clock;
  void greet(const ros::SingleSubscriberPublisher& listener);

  std::mutex mutex_;
  tf2_msgs::TFMessage last_;
  Clock::time_point published_at_;
  bool is_flowing_ = false;  ///< there was no standstill before the last ones
  ros::Publisher publisher_;
};

}  // namespace wavetank

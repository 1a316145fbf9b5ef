#pragma once

#include <nav_msgs/Odometry.h>
#include <sensor_msgs/JointState.h>
#include <tf2_msgs/TFMessage.h>

#include <string>
#include <vector>

#include "wavetank/instruments/samples.h"
#include "wavetank/node/frames.h"
#include "wavetank/node/stamps.h"

namespace wavetank {

/// Whether a joint has a position to tell of; a fixed one, a ball and a six_dof have none.
bool has_position(const JointCase& joint);

/// Where everything is at present, whether or not a sample is due.
PoseSample present_poses(const RigidWorld& bodies, double time);

/// Turns samples of the poses of whatever moves into messages. Free of the ROS graph.
class PoseMessages {
 public:
  PoseMessages(const Case& checked, std::vector<BodyFrame> frames);

  /// Pose of a frame in its parent; its velocity relative to the parent, in its own axes. `owner`: 0 the tank, 1 + i body i.
  nav_msgs::Odometry odometry(std::size_t owner, const PoseSample& sample, const StampClock& clock) const;
  /// Every moving frame in its parent.
  tf2_msgs::TFMessage transforms(const PoseSample& sample, const StampClock& clock) const;
  /// Of the joints that have a position, in the case's order.
  sensor_msgs::JointState joint_states(const PoseSample& sample, const StampClock& clock) const;

  /// Calls sink(topic, stamp, message) for every message of the sample.
  template <class Sink>
  void emit(const PoseSample& sample, const StampClock& clock, Sink&& sink) const {
    const ros::Time stamp = clock.at(sample.time);
    // Transforms first, so that they are there when something in a moving frame comes.
    if (!moving_.empty()) sink(transforms_topic, stamp, transforms(sample, clock));
    for (std::size_t i = 0; i < moving_.size(); ++i) sink(topics_[i], stamp, odometry(moving_[i], sample, clock));
    if (!joints_.empty()) sink(joint_states_topic, stamp, joint_states(sample, clock));
  }

  static inline const std::string transforms_topic = "/tf";
  static inline const std::string joint_states_topic = "joint_states";

 private:
  geometry_msgs::Pose pose(std::size_t owner, const PoseSample& sample) const;

  std::vector<BodyFrame> frames_;
  std::vector<std::size_t> moving_;  ///< owners
  std::vector<std::string> topics_;  ///< of their odometry
  std::vector<std::size_t> joints_;  ///< those that have a position
  std::vector<std::string> joint_names_;
};

}  // namespace wavetank

#include "wavetank/node/transform_publisher.h"

#include "wavetank/node/pose_messages.h"

namespace wavetank {

namespace {

constexpr std::uint32_t queue = 100;                        ///< as tf2_ros::TransformBroadcaster has
constexpr auto standstill = std::chrono::milliseconds(50);  ///< without any; a listener warns of transforms that it gets twice

}  // namespace

TransformPublisher::TransformPublisher(ros::NodeHandle& handle)
    : publisher_(handle.advertise<tf2_msgs::TFMessage>(PoseMessages::transforms_topic, queue,
                                                       [this](const ros::SingleSubscriberPublisher& listener) { greet(listener); })) {}

void TransformPublisher::publish(const tf2_msgs::TFMessage& transforms) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const Clock::time_point now = Clock::now();
    is_flowing_ = now < published_at_ + standstill;
    published_at_ = now;
    last_ = transforms;
  }
  publisher_.publish(transforms);
}

void TransformPublisher::publish_between_samples(const tf2_msgs::TFMessage& transforms) {
  const auto stamp = [](const tf2_msgs::TFMessage& message) { return message.transforms.at(0).header.stamp; };
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!last_.transforms.empty() && stamp(transforms) <= stamp(last_)) return;
  }
  publish(transforms);
}

void TransformPublisher::greet(const ros::SingleSubscriberPublisher& listener) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const bool others_follow = is_flowing_ && Clock::now() <= published_at_ + standstill;
  if (!last_.transforms.empty() && !others_follow) listener.publish(last_);
}

}  // namespace wavetank

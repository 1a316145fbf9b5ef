#include "wavetank/node/transform_publisher.h"

#include "wavetank/node/pose_messages.h"

namespace wavetank {

namespace {

constexpr std::uint32_t queue = 100;                        ///< as tf2_ros::TransformBroadcaster has
constexpr auto standstill = std::chrono::milliseconds(50);  ///< a listener warns of transforms that it gets twice

}  // namespace

TransformPublisher::TransformPublisher(ros::NodeHandle& handle)
    : publisher_(handle.advertise<tf2_msgs::TFMessage>(PoseMessages::transforms_topic, queue,
                                                       [this](const ros::SingleSubscriberPublisher& listener) { greet(listener); })) {}

void TransformPublisher::publish(const tf2_msgs::TFMessage& transforms) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    last_ = transforms;
    published_at_ = Clock::now();
  }
  publisher_.publish(transforms);
}

void TransformPublisher::greet(const ros::SingleSubscriberPublisher& listener) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!last_.transforms.empty() && Clock::now() > published_at_ + standstill) listener.publish(last_);
}

}  // namespace wavetank

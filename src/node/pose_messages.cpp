#include "wavetank/node/pose_messages.h"

#include "wavetank/node/geometry_messages.h"
#include "wavetank/scene/names.h"

namespace wavetank {

bool has_position(const JointCase& joint) {
  return joint.type == JointType::hinge || joint.type == JointType::slider || joint.type == JointType::spring;
}

PoseSample present_poses(const RigidWorld& bodies, double time) {
  PoseSample sample;
  sample.time = time;
  sample.states.push_back(bodies.state(0));
  for (std::size_t owner = 1; owner < bodies.count(); ++owner) sample.states.push_back(bodies.state_in_tank(owner));
  for (std::size_t joint = 0; joint < bodies.joint_count(); ++joint) sample.joints.push_back(bodies.joint_state(joint));
  return sample;
}

PoseMessages::PoseMessages(const Case& checked, std::vector<BodyFrame> frames) : frames_(std::move(frames)) {
  for (std::size_t owner = 0; owner < frames_.size(); ++owner) {
    if (!frames_[owner].moves) continue;
    moving_.push_back(owner);
    topics_.push_back(odometry_topic(owner == 0 ? tank_name : checked.bodies[owner - 1].name));
  }
  for (std::size_t joint = 0; joint < checked.joints.size(); ++joint) {
    if (!has_position(checked.joints[joint])) continue;
    joints_.push_back(joint);
    joint_names_.push_back(checked.joints[joint].name);
  }
}

geometry_msgs::Pose PoseMessages::pose(std::size_t owner, const PoseSample& sample) const {
  const BodyFrame& frame = frames_[owner];
  const RigidState& state = sample.states[owner];
  geometry_msgs::Pose message;
  message.position = point_message(state.moved(frame.origin, frame.reference));
  message.orientation = quaternion_message(state.orientation);
  return message;
}

nav_msgs::Odometry PoseMessages::odometry(std::size_t owner, const PoseSample& sample, const StampClock& clock) const {
  const BodyFrame& frame = frames_[owner];
  const RigidState& state = sample.states[owner];
  const Quaterniond into_body = state.orientation.conjugate();
  const Vector3d velocity = state.velocity_at(state.moved(frame.origin, frame.reference));
  nav_msgs::Odometry message;
  message.header.stamp = clock.at(sample.time);
  message.header.frame_id = frame.parent;
  message.child_frame_id = frame.name;
  message.pose.pose = pose(owner, sample);
  message.twist.twist.linear = vector_message(into_body * velocity);
  message.twist.twist.angular = vector_message(into_body * state.angular_velocity);
  return message;
}

tf2_msgs::TFMessage PoseMessages::transforms(const PoseSample& sample, const StampClock& clock) const {
  tf2_msgs::TFMessage message;
  for (const std::size_t owner : moving_) {
    const geometry_msgs::Pose at = pose(owner, sample);
    geometry_msgs::TransformStamped transform;
    transform.header.stamp = clock.at(sample.time);
    transform.header.frame_id = frames_[owner].parent;
    transform.child_frame_id = frames_[owner].name;
    transform.transform.translation.x = at.position.x;
    transform.transform.translation.y = at.position.y;
    transform.transform.translation.z = at.position.z;
    transform.transform.rotation = at.orientation;
    message.transforms.push_back(transform);
  }
  return message;
}

sensor_msgs::JointState PoseMessages::joint_states(const PoseSample& sample, const StampClock& clock) const {
  sensor_msgs::JointState message;
  message.header.stamp = clock.at(sample.time);
  message.name = joint_names_;
  for (const std::size_t joint : joints_) {
    const JointState& state = sample.joints[joint];
    message.position.push_back(state.position);
    message.velocity.push_back(state.velocity);
    message.effort.push_back(state.effort);
  }
  return message;
}

}  // namespace wavetank

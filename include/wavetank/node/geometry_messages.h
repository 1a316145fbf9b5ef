#pragma once

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Quaternion.h>
#include <geometry_msgs/Vector3.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

/// Eigen's vectors as those of ROS, and back.
namespace wavetank {

inline geometry_msgs::Point point_message(const Eigen::Vector3d& position) {
  geometry_msgs::Point message;
  message.x = position.x();
  message.y = position.y();
  message.z = position.z();
  return message;
}

inline geometry_msgs::Vector3 vector_message(const Eigen::Vector3d& vector) {
  geometry_msgs::Vector3 message;
  message.x = vector.x();
  message.y = vector.y();
  message.z = vector.z();
  return message;
}

inline geometry_msgs::Quaternion quaternion_message(const Eigen::Quaterniond& orientation) {
  geometry_msgs::Quaternion message;
  message.x = orientation.x();
  message.y = orientation.y();
  message.z = orientation.z();
  message.w = orientation.w();
  return message;
}

inline Eigen::Vector3d vector_of(const geometry_msgs::Vector3& message) { return {message.x, message.y, message.z}; }

}  // namespace wavetank

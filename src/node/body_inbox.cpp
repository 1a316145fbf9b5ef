#include "wavetank/node/body_inbox.h"

#include <cmath>

#include "wavetank/common/error.h"
#include "wavetank/common/visible_text.h"
#include "wavetank/node/geometry_messages.h"

namespace wavetank {

namespace {

AskedWrench::Axes axes_of(const std::string& frame, std::size_t owner, const std::vector<BodyFrame>& frames) {
  const BodyFrame& tank = frames[0];
  if (frame.empty() || frame == frames[owner].name) return AskedWrench::Axes::body;
  if (frame == tank.name) return AskedWrench::Axes::tank;
  if (frame == tank.parent) return AskedWrench::Axes::world;
  const std::string own = owner == 0 ? "" : "'" + frames[owner].name + "', ";
  throw Error("a wrench in frame '" + visible_text(frame, 60) + "' is ignored: its frame_id must be " + own + "'" + tank.name + "', '" +
              tank.parent + "' or empty, which means the body's own");
}

}  // namespace

AskedWrench read_wrench(const geometry_msgs::WrenchStamped& message, std::size_t owner, const std::vector<BodyFrame>& frames) {
  AskedWrench wrench;
  wrench.axes = axes_of(message.header.frame_id, owner, frames);
  wrench.force = vector_of(message.wrench.force);
  wrench.torque = vector_of(message.wrench.torque);
  if (!wrench.force.allFinite() || !wrench.torque.allFinite())
    throw Error("a wrench with a NaN or an infinite value is ignored: the one before stays");
  return wrench;
}

AskedVelocity read_velocity(const geometry_msgs::Twist& message) {
  const AskedVelocity asked{vector_of(message.linear), vector_of(message.angular)};
  if (!asked.velocity.allFinite() || !asked.angular_velocity.allFinite())
    throw Error("a velocity with a NaN or an infinite value is ignored: the one before stays");
  return asked;
}

double read_discharge(const std_msgs::Float64& message) {
  if (!std::isfinite(message.data) || message.data < 0)
    throw Error("a discharge that is negative, NaN or infinite is ignored: the one before stays");
  return message.data;
}

double read_joint_command(const std_msgs::Float64& message) {
  if (!std::isfinite(message.data)) throw Error("a command that is NaN or infinite is ignored: the one before stays");
  return message.data;
}

OutsideWrench outside_wrench(const AskedWrench& asked, const Quaterniond& tank, double time, double timeout) {
  OutsideWrench wrench;
  wrench.turns_with_body = asked.axes == AskedWrench::Axes::body;
  const bool turns = asked.axes == AskedWrench::Axes::tank;
  wrench.force = turns ? tank * asked.force : asked.force;
  wrench.torque = turns ? tank * asked.torque : asked.torque;
  if (timeout > 0) wrench.until = time + timeout;
  return wrench;
}

void BodyInbox::put(std::size_t owner, const AskedWrench& wrench) {
  const std::lock_guard<std::mutex> lock(mutex_);
  contents_.wrenches[owner] = wrench;
}

void BodyInbox::put(std::size_t owner, const AskedVelocity& velocity) {
  const std::lock_guard<std::mutex> lock(mutex_);
  contents_.velocities[owner] = velocity;
}

void BodyInbox::put_discharge(std::size_t opening, double discharge) {
  const std::lock_guard<std::mutex> lock(mutex_);
  contents_.discharges[opening] = discharge;
}

void BodyInbox::put_joint(std::size_t joint, double command) {
  const std::lock_guard<std::mutex> lock(mutex_);
  contents_.joints[joint] = command;
}

BodyInbox::Contents BodyInbox::take() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(contents_, {});
}

}  // namespace wavetank

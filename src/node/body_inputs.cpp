#include "wavetank/node/body_inputs.h"

#include <chrono>
#include <memory>

#include "wavetank/common/log.h"
#include "wavetank/scene/names.h"

namespace wavetank {

namespace {

constexpr std::uint32_t input_queue = 100;
constexpr auto warning_period = std::chrono::seconds(1);

}  // namespace

void BodyInputs::Warnings::warn(const std::string& topic, const std::string& what) {
  const auto now = std::chrono::steady_clock::now();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    auto& due = due_[topic];
    if (now < due) return;
    due = now + warning_period;
  }
  log(LogLevel::warning, topic + ": " + what);
}

BodyInputs::BodyInputs(ros::NodeHandle& private_handle, const Case& checked, double wrench_timeout) : wrench_timeout_(wrench_timeout) {
  // Only the frames' names are used, so that the places of their origins, which the simulation finds, do not matter.
  const std::vector<BodyFrame> frames = body_frames(checked, std::vector<Vector3d>(1 + checked.bodies.size(), Vector3d::Zero()));
  for (std::size_t owner = 0; owner < frames.size(); ++owner) {
    const std::string& name = owner == 0 ? tank_name : checked.bodies[owner - 1].name;
    const Motion motion = owner == 0 ? checked.tank.motion : checked.bodies[owner - 1].motion;
    const bool is_commanded = motion == Motion::commanded;
    topics_.owners.push_back(private_handle.resolveName(is_commanded ? command_topic(name) : outside_wrench_topic(name)));
    if (motion == Motion::free)
      listen<geometry_msgs::WrenchStamped>(
          private_handle, outside_wrench_topic(name),
          [this, owner, frames](const geometry_msgs::WrenchStamped& message) { inbox_.put(owner, read_wrench(message, owner, frames)); });
    if (is_commanded)
      listen<geometry_msgs::Twist>(private_handle, command_topic(name),
                                   [this, owner](const geometry_msgs::Twist& message) { inbox_.put(owner, read_velocity(message)); });
  }
  for (const OpeningCase& opening : checked.openings)
    topics_.discharges.push_back(private_handle.resolveName(discharge_topic(opening.name)));
  for (const JointCase& joint : checked.joints) topics_.joints.push_back(private_handle.resolveName(joint_command_topic(joint.name)));
  for (std::size_t o = 0; o < checked.openings.size(); ++o)
    if (checked.openings[o].command)
      listen<std_msgs::Float64>(private_handle, discharge_topic(checked.openings[o].name),
                                [this, o](const std_msgs::Float64& message) { inbox_.put_discharge(o, read_discharge(message)); });
  for (std::size_t j = 0; j < checked.joints.size(); ++j)
    if (checked.joints[j].command)
      listen<std_msgs::Float64>(private_handle, joint_command_topic(checked.joints[j].name),
                                [this, j](const std_msgs::Float64& message) { inbox_.put_joint(j, read_joint_command(message)); });
}

template <class Message, class Take>
void BodyInputs::listen(ros::NodeHandle& private_handle, const std::string& topic, Take take) {
  const std::string full_name = private_handle.resolveName(topic);
  const boost::function<void(const boost::shared_ptr<const Message>&)> hear = [this, take,
                                                                               full_name](const boost::shared_ptr<const Message>& message) {
    try {
      take(*message);
    } catch (const Error& error) {
      warnings_.warn(full_name, error.what());
    }
  };
  // Small messages that a controller sends one by one are not to wait for each other.
  subscribers_.push_back(
      private_handle.subscribe<Message>(topic, input_queue, hear, ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay()));
}

void BodyInputs::apply(Simulation& simulation) {
  const BodyInbox::Contents contents = inbox_.take();
  // What is beyond reason, or overflows as it is turned, is no reason to end the run: the one before stays.
  const auto hand_over = [this](const std::string& topic, const auto& action) {
    try {
      action();
    } catch (const Error& error) {
      warnings_.warn(topic, error.what());
    }
  };
  for (const auto& [opening, discharge] : contents.discharges)
    hand_over(topics_.discharges.at(opening), [&, o = opening, q = discharge] { simulation.command_discharge(o, q); });
  for (const auto& [joint, command] : contents.joints)
    hand_over(topics_.joints.at(joint), [&, j = joint, value = command] { simulation.command_joint(j, value); });
  if (contents.wrenches.empty() && contents.velocities.empty()) return;
  const double time = simulation.state().time;
  const Quaterniond tank = simulation.bodies().state(0).orientation;
  for (const auto& [owner, asked] : contents.wrenches)
    hand_over(topics_.owners.at(owner),
              [&, o = owner, &wrench = asked] { simulation.set_outside_wrench(o, outside_wrench(wrench, tank, time, wrench_timeout_)); });
  for (const auto& [owner, asked] : contents.velocities)
    hand_over(topics_.owners.at(owner),
              [&, o = owner, &wanted = asked] { simulation.command(o, wanted.velocity, wanted.angular_velocity); });
}

}  // namespace wavetank

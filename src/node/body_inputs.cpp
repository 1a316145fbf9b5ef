#include "wavetank/node/body_inputs.h"

#include <chrono>
#include <memory>

#include "wavetank/common/log.h"
#include "wavetank/node/names.h"

namespace wavetank {

namespace {

constexpr std::uint32_t input_queue = 100;
constexpr auto warning_period = std::chrono::seconds(1);

/// Warns about one topic at most every second of wall time: the simulated may stand still, and a faulty sender sends often.
class Warnings {
 public:
  explicit Warnings(std::string topic) : topic_(std::move(topic)) {}
  void warn(const std::string& what) {
    const auto now = std::chrono::steady_clock::now();
    if (now < due_) return;
    due_ = now + warning_period;
    log(LogLevel::warning, topic_ + ": " + what);
  }

 private:
  std::string topic_;
  std::chrono::steady_clock::time_point due_;
};

}  // namespace

BodyInputs::BodyInputs(ros::NodeHandle& private_handle, const Case& checked, double wrench_timeout) : wrench_timeout_(wrench_timeout) {
  // Only the frames' names are used, so that the places of their origins, which the simulation finds, do not matter.
  const std::vector<BodyFrame> frames = body_frames(checked, std::vector<Vector3d>(1 + checked.bodies.size(), Vector3d::Zero()));
  for (std::size_t owner = 0; owner < frames.size(); ++owner) {
    const std::string& name = owner == 0 ? tank_name : checked.bodies[owner - 1].name;
    const Motion motion = owner == 0 ? checked.tank.motion : checked.bodies[owner - 1].motion;
    if (motion == Motion::free)
      listen<geometry_msgs::WrenchStamped>(
          private_handle, outside_wrench_topic(name),
          [this, owner, frames](const geometry_msgs::WrenchStamped& message) { inbox_.put(owner, read_wrench(message, owner, frames)); });
    if (motion == Motion::commanded)
      listen<geometry_msgs::Twist>(private_handle, command_topic(name),
                                   [this, owner](const geometry_msgs::Twist& message) { inbox_.put(owner, read_velocity(message)); });
  }
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
  const auto warnings = std::make_shared<Warnings>(private_handle.resolveName(topic));
  const boost::function<void(const boost::shared_ptr<const Message>&)> hear = [take,
                                                                               warnings](const boost::shared_ptr<const Message>& message) {
    try {
      take(*message);
    } catch (const Error& error) {
      warnings->warn(error.what());
    }
  };
  // Small messages that a controller sends one by one are not to wait for each other.
  subscribers_.push_back(
      private_handle.subscribe<Message>(topic, input_queue, hear, ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay()));
}

void BodyInputs::apply(Simulation& simulation) {
  const BodyInbox::Contents contents = inbox_.take();
  for (const auto& [opening, discharge] : contents.discharges) {
    try {
      simulation.command_discharge(opening, discharge);
    } catch (const Error& error) {  // too fast for the speed of sound: the one before stays
      log(LogLevel::warning, error.what());
    }
  }
  for (const auto& [joint, command] : contents.joints) simulation.command_joint(joint, command);
  if (contents.wrenches.empty() && contents.velocities.empty()) return;
  const double time = simulation.state().time;
  const Quaterniond tank = simulation.bodies().state(0).orientation;
  try {
    for (const auto& [owner, asked] : contents.wrenches)
      simulation.set_outside_wrench(owner, outside_wrench(asked, tank, time, wrench_timeout_));
    for (const auto& [owner, asked] : contents.velocities) simulation.command(owner, asked.velocity, asked.angular_velocity);
  } catch (const Error& error) {  // numbers that overflow as they are turned: no reason to end the run
    log(LogLevel::warning, error.what());
  }
}

}  // namespace wavetank

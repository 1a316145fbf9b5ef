#pragma once

#include <geometry_msgs/Twist.h>
#include <geometry_msgs/WrenchStamped.h>
#include <std_msgs/Float64.h>

#include <map>
#include <mutex>

#include "wavetank/node/frames.h"
#include "wavetank/rigid/rigid_world.h"

namespace wavetank {

/// A wrench that was asked for, N and N·m about the centre of mass (2-D: N/m and N).
struct AskedWrench {
  enum class Axes { body, tank, world };
  Vector3d force = Vector3d::Zero();
  Vector3d torque = Vector3d::Zero();
  Axes axes = Axes::body;
};

/// A velocity that was asked for, m/s and rad/s, in the body's axes.
struct AskedVelocity {
  Vector3d velocity = Vector3d::Zero();
  Vector3d angular_velocity = Vector3d::Zero();
};

/// Throws Error for a value that is not finite and for a frame that is none of: no frame or the body's own (its axes), the tank's, the
/// inertial one. `frames`: as body_frames gives them.
AskedWrench read_wrench(const geometry_msgs::WrenchStamped& message, std::size_t owner, const std::vector<BodyFrame>& frames);
/// m³/s. Throws Error for a value that is not finite or negative.
double read_discharge(const std_msgs::Float64& message);
/// Of a joint's effort or velocity. Throws Error for a value that is not finite.
double read_joint_command(const std_msgs::Float64& message);
/// Throws Error for a value that is not finite.
AskedVelocity read_velocity(const geometry_msgs::Twist& message);

/// tank: how the tank is turned in the world now. time, timeout: s of simulated time; a timeout of 0 = until it is replaced.
OutsideWrench outside_wrench(const AskedWrench& asked, const Quaterniond& tank, double time, double timeout);

/// Where wrenches, velocities, discharges and commands of joints wait for the solver: of each only the newest. All members may be called
/// from any thread, and none waits for a step.
class BodyInbox {
 public:
  struct Contents {
    std::map<std::size_t, AskedWrench> wrenches;  ///< by owner: 0 the tank, 1 + i body i
    std::map<std::size_t, AskedVelocity> velocities;
    std::map<std::size_t, double> discharges;  ///< m³/s, by opening
    std::map<std::size_t, double> joints;      ///< N, N·m, m/s or rad/s, by joint
  };

  void put(std::size_t owner, const AskedWrench& wrench);
  void put(std::size_t owner, const AskedVelocity& velocity);
  void put_discharge(std::size_t opening, double discharge);
  void put_joint(std::size_t joint, double command);
  /// Empties it.
  Contents take();

 private:
  std::mutex mutex_;
  Contents contents_;
};

}  // namespace wavetank

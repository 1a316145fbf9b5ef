#pragma once

#include <ros/ros.h>

#include <vector>

#include "wavetank/node/body_inbox.h"
#include "wavetank/simulation/simulation.h"

namespace wavetank {

/// Listens for wrenches on free bodies, velocities of commanded ones, the tank included, discharges of commanded openings, and efforts or
/// velocities of commanded joints, and hands them to the simulation.
class BodyInputs {
 public:
  /// wrench_timeout: s of simulated time for which a wrench is held; 0 = until it is replaced.
  BodyInputs(ros::NodeHandle& private_handle, const Case& checked, double wrench_timeout);
  BodyInputs(const BodyInputs&) = delete;
  BodyInputs& operator=(const BodyInputs&) = delete;

  /// Before a step, in the solver's thread: what has come since the last one.
  void apply(Simulation& simulation);
  /// Forgets what has not been applied.
  void clear() { inbox_.take(); }

 private:
  /// `take` puts a message into the inbox, or throws Error.
  template <class Message, class Take>
  void listen(ros::NodeHandle& private_handle, const std::string& topic, Take take);

  double wrench_timeout_;
  BodyInbox inbox_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace wavetank

#pragma once

#include <ros/ros.h>

#include <chrono>
#include <map>
#include <mutex>
#include <string>
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

  /// Warns about one topic at most every second of wall time: the simulated may stand still, and a faulty sender sends often.
  class Warnings {
   public:
    void warn(const std::string& topic, const std::string& what);

   private:
    std::mutex mutex_;
    std::map<std::string, std::chrono::steady_clock::time_point> due_;
  };
  /// Full names, by owner, opening and joint.
  struct Topics {
    std::vector<std::string> owners, discharges, joints;
  };

  double wrench_timeout_;
  Warnings warnings_;
  Topics topics_;
  BodyInbox inbox_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace wavetank

#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

#include "wavetank/node/clouds.h"
#include "wavetank/node/picture_pace.h"

namespace wavetank {

/// Publishes ~free_surface and ~particles from a thread of its own, at most at the case's rate of wall time, so seldom that it takes no
/// more than 3 % of the time with those who read it, and only what someone listens to. Between it and the solver lies a slot for one cloud,
/// in which a newer one replaces an older: a slow subscriber costs the solver nothing.
class CloudPublisher {
 public:
  CloudPublisher(ros::NodeHandle& private_handle, const PublishingCase& publishing, const StampClock& clock);
  ~CloudPublisher();
  CloudPublisher(const CloudPublisher&) = delete;
  CloudPublisher& operator=(const CloudPublisher&) = delete;

  /// To be called often by the solver's thread: takes a cloud from the simulation when one is due, and says whether it did.
  bool offer(const Simulation& simulation);

 private:
  struct Clouds {
    std::optional<ParticleCloud> all, surface;
  };
  void run();

  PublishingCase publishing_;
  const StampClock& clock_;
  ros::Publisher all_, surface_;
  PicturePace pace_;
  double taking_seconds_ = 0;                   ///< that the last clouds took of the solver's thread
  std::atomic<double> publishing_seconds_ = 0;  ///< and of the own one

  std::mutex mutex_;
  std::condition_variable wake_;
  std::optional<Clouds> latest_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace wavetank

#pragma once

#include <ros/time.h>

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "wavetank/node/background_work.h"
#include "wavetank/surface/surface_finder.h"

namespace wavetank {

/// Finds surfaces of the water in a thread of its own. All members but the constructor and the destructor may be called by the simulation's
/// thread alone. The destructor waits for a surface that is in progress.
class SurfaceDrawer {
 public:
  /// `done`: called in the drawer's thread with each surface.
  explicit SurfaceDrawer(std::function<void(const WaterSurface&, const ros::Time& stamp)> done);

  /// Takes what the simulation's surface is found from at present; while it has another one in the making it waits for that. Never throws:
  /// of what fails here or in the drawer's thread failure() tells, and from then on nothing is drawn.
  /// `stamp`: handed on with the surface. It is of now: ROS time may start anew before the surface is found.
  void draw(const Simulation& simulation, const ros::Time& stamp);
  /// Nobody wants the surface in the making any more: `done` is not called with it, unless that has begun.
  void drop();
  /// Why nothing is drawn any more; empty while all is well.
  std::string failure() const;
  bool is_idle() { return work_.is_idle(); }
  /// Until it is idle.
  void wait() { work_.wait(); }
  /// s of wall time that the last surface took, of the simulation's thread and of the drawer's together.
  double seconds() const { return looking_seconds_ + finding_seconds_; }

 private:
  void look_at(const Simulation& simulation, const ros::Time& stamp);
  void find(const WaterField& field, const ros::Time& stamp);
  void give_up();

  std::function<void(const WaterSurface&, const ros::Time&)> done_;
  std::unique_ptr<SurfaceFinder> finder_;  ///< made when it is first wanted
  double looking_seconds_ = 0;
  std::atomic<double> finding_seconds_ = 0;
  std::atomic<bool> is_dropped_ = false;
  mutable std::mutex failure_mutex_;
  std::string failure_;
  BackgroundWork work_;  ///< the last member: its thread uses the others
};

}  // namespace wavetank

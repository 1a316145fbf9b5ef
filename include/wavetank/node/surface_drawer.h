#pragma once

#include <ros/time.h>

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "wavetank/surface/surface_finder.h"

namespace wavetank {

/// Finds surfaces of the water in a thread of its own. All members but the constructor and the destructor may be called by the simulation's
/// thread alone.
class SurfaceDrawer {
 public:
  /// `done`: called in the drawer's thread with each surface.
  explicit SurfaceDrawer(std::function<void(const WaterSurface&, const ros::Time& stamp)> done);
  /// After the surface in the making.
  ~SurfaceDrawer();
  SurfaceDrawer(const SurfaceDrawer&) = delete;
  SurfaceDrawer& operator=(const SurfaceDrawer&) = delete;

  /// Takes what the simulation's surface is found from at present; while it has another one in the making it waits for that. Never throws:
  /// of what fails here or in the drawer's thread failure() tells, and from then on nothing is drawn.
  /// `stamp`: handed on with the surface. It is of now: ROS time may start anew before the surface is found.
  void draw(const Simulation& simulation, const ros::Time& stamp);
  /// Nobody wants the surface in the making any more: `done` is not called with it, unless that has begun.
  void drop();
  /// Why nothing is drawn any more; empty while all is well.
  std::string failure() const;
  bool is_idle() const;
  /// Until it is idle.
  void wait();
  /// s of wall time that the last surface took, of the simulation's thread and of the drawer's together.
  double seconds() const;

 private:
  void look_at(const Simulation& simulation, const ros::Time& stamp);
  void find();
  void give_up();
  void run();

  std::function<void(const WaterSurface&, const ros::Time&)> done_;
  std::unique_ptr<SurfaceFinder> finder_;  ///< made when it is first wanted
  double looking_seconds_ = 0;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<WaterField> field_;
  ros::Time stamp_;  ///< of the field
  bool is_dropped_ = false;
  double finding_seconds_ = 0;
  std::string failure_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace wavetank

#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "wavetank/node/picture_pace.h"
#include "wavetank/node/stamps.h"
#include "wavetank/node/surface_drawer.h"
#include "wavetank/node/surface_messages.h"

namespace wavetank {

/// Publishes ~surface_mesh and ~height_map while someone listens: at most at the case's rate of wall time, and so seldom that drawing them
/// takes no more than 3 % of the time.
class SurfacePublisher {
 public:
  SurfacePublisher(ros::NodeHandle& private_handle, const PublishingCase& publishing, const StampClock& clock);

  /// To be called often by the solver's thread: has a surface drawn when one is due, and says whether it did. Where that fails it is told
  /// once, as a warning, and none is drawn any more.
  bool offer(const Simulation& simulation);
  /// The simulation is about to go back to time 0: a surface begun before that is not published.
  void restart() { drawer_.drop(); }

 private:
  void publish(const WaterSurface& surface, const ros::Time& stamp) const;

  PublishingCase publishing_;
  const StampClock& clock_;
  ros::Publisher mesh_, heights_;
  PicturePace pace_;
  bool has_failed_ = false;
  SurfaceDrawer drawer_;  ///< last: its thread uses all of the above
};

}  // namespace wavetank

#include "wavetank/node/surface_publisher.h"

#include <string>

#include "wavetank/common/log.h"

namespace wavetank {

SurfacePublisher::SurfacePublisher(ros::NodeHandle& private_handle, const PublishingCase& publishing, const StampClock& clock)
    : publishing_(publishing),
      clock_(clock),
      mesh_(private_handle.advertise<visualization_msgs::Marker>(SurfaceMessages::mesh_topic, 2)),
      heights_(private_handle.advertise<sensor_msgs::Image>(SurfaceMessages::height_topic, 1)),
      pace_(publishing.surface_rate),
      drawer_([this](const WaterSurface& surface, const ros::Time& stamp) { publish(surface, stamp); }) {}

bool SurfacePublisher::offer(const Simulation& simulation) {
  if (mesh_.getNumSubscribers() == 0 && heights_.getNumSubscribers() == 0) return false;
  if (has_failed_ || !drawer_.is_idle() || !pace_.is_due(drawer_.seconds())) return false;
  pace_.begin(drawer_.seconds());
  drawer_.draw(simulation, clock_.at(simulation.state().time));
  const std::string failure = drawer_.failure();
  if (!failure.empty()) {
    has_failed_ = true;
    log(LogLevel::warning, "the water's surface is not drawn any more: " + failure);
    return false;
  }
  return true;
}

void SurfacePublisher::publish(const WaterSurface& surface, const ros::Time& stamp) const {
  const SurfaceMessages messages = surface_messages(surface, publishing_.max_points, publishing_.world_frame, stamp);
  mesh_.publish(messages.surface);
  mesh_.publish(messages.spray);
  heights_.publish(messages.heights);
}

}  // namespace wavetank

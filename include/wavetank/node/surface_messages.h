#pragma once

#include <ros/time.h>
#include <sensor_msgs/Image.h>
#include <visualization_msgs/Marker.h>

#include <string>

#include "wavetank/surface/surface_finder.h"

namespace wavetank {

/// The surface of the water as messages, all of its time and in `frame`.
struct SurfaceMessages {
  static constexpr const char* mesh_topic = "surface_mesh";
  static constexpr const char* height_topic = "height_map";

  visualization_msgs::Marker surface;  ///< triangles, three points each, of the namespace `surface`; action DELETE where there are none
  visualization_msgs::Marker spray;    ///< points, of the namespace `spray`, likewise
  sensor_msgs::Image heights;          ///< 32FC1, m, as HeightMap has them
};

/// `stamp`: of the surface's time. `max_points`: of the spray; of more, every second, third … is left.
SurfaceMessages surface_messages(const WaterSurface& surface, int max_points, const std::string& frame, const ros::Time& stamp);

}  // namespace wavetank

#include "wavetank/node/surface_messages.h"

#include <sensor_msgs/image_encodings.h>

#include <cstring>

namespace wavetank {
namespace {

constexpr double spray_size = 0.5;  ///< spacings that a particle of the spray is drawn wide

visualization_msgs::Marker water_marker(const std::string& name, int type, double size, const std_msgs::Header& header) {
  visualization_msgs::Marker marker;
  marker.header = header;
  marker.ns = name;
  marker.type = type;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = marker.scale.y = marker.scale.z = size;
  marker.color.r = 0.25F;
  marker.color.g = 0.55F;
  marker.color.b = 0.85F;
  marker.color.a = 1.0F;
  return marker;
}

void add_point(visualization_msgs::Marker& marker, const Eigen::Vector3f& place) {
  geometry_msgs::Point point;
  point.x = place.x();
  point.y = place.y();
  point.z = place.z();
  marker.points.push_back(point);
}

/// rviz complains about a marker without points, and would go on showing the one before.
void delete_empty(visualization_msgs::Marker& marker) {
  if (marker.points.empty()) marker.action = visualization_msgs::Marker::DELETE;
}

sensor_msgs::Image height_image(const HeightMap& map, const std_msgs::Header& header) {
  sensor_msgs::Image image;
  image.header = header;
  image.height = static_cast<std::uint32_t>(map.rows);
  image.width = static_cast<std::uint32_t>(map.columns);
  image.encoding = sensor_msgs::image_encodings::TYPE_32FC1;
  const std::uint16_t one = 1;
  std::memcpy(&image.is_bigendian, &one, 1);
  image.is_bigendian = image.is_bigendian == 0 ? 1 : 0;
  image.step = image.width * static_cast<std::uint32_t>(sizeof(float));
  image.data.resize(map.heights.size() * sizeof(float));
  std::memcpy(image.data.data(), map.heights.data(), image.data.size());
  return image;
}

}  // namespace

SurfaceMessages surface_messages(const WaterSurface& surface, int max_points, const std::string& frame, const ros::Time& stamp) {
  std_msgs::Header header;
  header.stamp = stamp;
  header.frame_id = frame;
  SurfaceMessages messages;
  messages.surface = water_marker("surface", visualization_msgs::Marker::TRIANGLE_LIST, 1.0, header);
  messages.surface.points.reserve(3 * surface.triangles.size());
  for (const std::array<int, 3>& triangle : surface.triangles)
    for (const int corner : triangle) add_point(messages.surface, surface.vertices[corner]);
  delete_empty(messages.surface);
  messages.spray = water_marker("spray", visualization_msgs::Marker::POINTS, spray_size * surface.heights.resolution, header);
  const std::size_t stride = (surface.spray.size() + max_points - 1) / max_points;
  for (std::size_t i = 0; i < surface.spray.size(); i += stride) add_point(messages.spray, surface.spray[i]);
  delete_empty(messages.spray);
  messages.heights = height_image(surface.heights, header);
  return messages;
}

}  // namespace wavetank

#include "wavetank/node/clouds.h"

#include <array>
#include <cstring>
#include <numeric>

namespace wavetank {

namespace {

void append_field(sensor_msgs::PointCloud2& message, const std::string& name) {
  sensor_msgs::PointField field;
  field.name = name;
  field.offset = message.point_step;
  field.datatype = sensor_msgs::PointField::FLOAT32;
  field.count = 1;
  message.fields.push_back(field);
  message.point_step += sizeof(float);
}

bool is_big_endian() {
  const std::uint16_t one = 1;
  unsigned char first = 0;
  std::memcpy(&first, &one, 1);
  return first == 0;
}

/// Indices of at most max_points particles. Multiplied by the golden ratio of 2³², ids of any arithmetic progression (a row of the lattice,
/// say) spread evenly over the 32-bit range; those below a threshold are kept.
std::vector<std::size_t> thinned(const ParticleCloud& cloud, std::size_t max_points) {
  const std::size_t count = cloud.id.size();
  std::vector<std::size_t> kept(count);
  std::iota(kept.begin(), kept.end(), std::size_t{0});
  double fraction = 1.0;
  while (kept.size() > max_points) {
    fraction *= 0.999 * static_cast<double>(max_points) / static_cast<double>(kept.size());
    const auto threshold = static_cast<std::uint32_t>(fraction * 4294967295.0);
    std::vector<std::size_t> fewer;
    for (const std::size_t i : kept)
      if (cloud.id[i] * 2654435769U < threshold) fewer.push_back(i);
    kept = std::move(fewer);
  }
  return kept;
}

}  // namespace

sensor_msgs::PointCloud2 cloud_message(const ParticleCloud& cloud, CloudFields fields, int max_points, const std::string& frame,
                                       const StampClock& clock) {
  const std::vector<std::size_t> kept = thinned(cloud, static_cast<std::size_t>(max_points));
  sensor_msgs::PointCloud2 message;
  message.header.stamp = clock.at(cloud.time);
  message.header.frame_id = frame;
  for (const char* name : {"x", "y", "z", "vx", "vy", "vz", "pressure"}) append_field(message, name);
  if (fields == CloudFields::all)
    for (const char* name : {"density", "shepard", "surface", "eigenvalue"}) append_field(message, name);
  message.is_bigendian = is_big_endian();
  message.is_dense = true;
  message.height = 1;
  message.width = static_cast<std::uint32_t>(kept.size());
  message.row_step = message.point_step * message.width;
  message.data.resize(message.row_step);
  std::uint8_t* to = message.data.data();
  for (const std::size_t i : kept) {
    const Eigen::Vector3f &place = cloud.position[i], &velocity = cloud.velocity[i];
    const std::array<float, 11> point{
        place.x(),          place.y(),         place.z(),        velocity.x(),     velocity.y(),
        velocity.z(),       cloud.pressure[i], cloud.density[i], cloud.shepard[i], cloud.surface[i] != 0 ? 1.0F : 0.0F,
        cloud.eigenvalue[i]};
    std::memcpy(to, point.data(), message.point_step);
    to += message.point_step;
  }
  return message;
}

ParticleCloud surface_of(const ParticleCloud& cloud) {
  ParticleCloud surface;
  surface.time = cloud.time;
  for (std::size_t i = 0; i < cloud.id.size(); ++i) {
    if (cloud.surface[i] == 0) continue;
    surface.id.push_back(cloud.id[i]);
    surface.position.push_back(cloud.position[i]);
    surface.velocity.push_back(cloud.velocity[i]);
    surface.pressure.push_back(cloud.pressure[i]);
    surface.density.push_back(cloud.density[i]);
    surface.mass.push_back(cloud.mass[i]);
    surface.shepard.push_back(cloud.shepard[i]);
    surface.surface.push_back(cloud.surface[i]);
    surface.eigenvalue.push_back(cloud.eigenvalue[i]);
  }
  return surface;
}

}  // namespace wavetank

#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "kept_buffer.h"
#include "tables/device_sizes.h"
#include "wavetank/compute/arguments.h"
#include "wavetank/scene/case.h"

namespace wavetank {

/// Damping zones as damping.cl has them. Must stay where it is once it is bound.
template <class Real>
class DampingZones {
 public:
  /// `origin`: the grid's, m.
  void set(const compute::Device& device, const Case& scene, const Eigen::Vector3d& origin) {
    std::vector<Real> values;
    const auto add = [&values](double value) { values.push_back(static_cast<Real>(value)); };
    const auto add_vector = [&add](const Eigen::Vector3d& vector) {
      for (int axis = 0; axis < 3; ++axis) add(vector[axis]);
    };
    for (const DampingCase& zone : scene.fluid.damping) {
      Eigen::Vector3d lower = zone.box.min - origin, upper = zone.box.max - origin;
      if (scene.dimensions == 2) {
        lower.y() = std::numeric_limits<float>::lowest();
        upper.y() = std::numeric_limits<float>::max();
      }
      Eigen::Vector3d way = zone.direction;
      if (scene.dimensions == 2) way.y() = 0;
      way.normalize();
      double near = 0, far = 0;  // of the box along the way
      for (int axis = 0; axis < 3; ++axis) {
        if (way[axis] == 0) continue;
        near += way[axis] * (way[axis] > 0 ? lower[axis] : upper[axis]);
        far += way[axis] * (way[axis] > 0 ? upper[axis] : lower[axis]);
      }
      add_vector(lower);
      add_vector(upper);
      add_vector(way / (far - near));
      add(near / (far - near));
      add(zone.strength);
      add_vector(zone.velocity);
    }
    count_ = static_cast<int>(scene.fluid.damping.size());
    values_.set(device, values);
  }
  bool any() const { return count_ > 0; }
  void add_to(compute::Arguments& arguments) const { arguments.value("damping_count", count_).memory("dampings", values_.on_device()); }

 private:
  int count_ = 0;
  KeptBuffer<Real> values_;  ///< field::damping_count values a zone
};

}  // namespace wavetank

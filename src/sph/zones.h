#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "equation_of_state.h"
#include "kept_buffer.h"
#include "tables/device_sizes.h"
#include "wavetank/common/error.h"
#include "wavetank/compute/arguments.h"
#include "wavetank/sph/solver.h"

namespace wavetank {

/// Imposed zones as zones.cl has them. Must stay where it is once it is bound.
template <class Real>
class Zones {
 public:
  /// `origin`: the grid's, m; `scene`, settled, has the equation of state.
  void set(const compute::Device& device, const std::vector<ImposedZone>& zones, const Eigen::Vector3d& origin, const Case& scene) {
    std::vector<Real> values;
    const auto add = [&values](double value) { values.push_back(static_cast<Real>(value)); };
    const auto add_vector = [&add](const Eigen::Vector3d& vector) {
      for (int axis = 0; axis < 3; ++axis) add(vector[axis]);
    };
    std::size_t table = zones.size() * field::zone_count;
    for (const ImposedZone& zone : zones) {
      const std::size_t cells = static_cast<std::size_t>(zone.cells[0]) * zone.cells[1] * zone.layers;
      if (!zone.speed.empty() && (zone.speed.size() != cells || zone.pressure.size() != cells))
        throw Error("an imposed zone of " + std::to_string(cells) + " cells in all layers is given " + std::to_string(zone.speed.size()) +
                    " speeds and " + std::to_string(zone.pressure.size()) + " pressures");
      add_vector(zone.centre - origin);
      add_vector(zone.normal);
      const Eigen::Vector3d axes[2] = {zone.across, zone.up};
      for (int k = 0; k < 2; ++k) {
        const double size = zone.cell_size[k];
        add_vector(size > 0 ? Eigen::Vector3d(axes[k] / size) : Eigen::Vector3d(Eigen::Vector3d::Zero()));
        add(size > 0 ? zone.first_edge[k] / size : 0.0);
        add(zone.cells[k]);
      }
      add(zone.depth);
      add(zone.layers);
      add(zone.speed.empty() ? -1.0 : static_cast<double>(table));
      add_vector(zone.drift);
      for (int row = 0; row < 3; ++row) add_vector(zone.turning.row(row));
      add_vector(zone.heading);
      if (!zone.speed.empty()) table += cells * field::zone_cell_count;
    }
    const double stiffness = scene.fluid.density * *scene.fluid.sound_speed * *scene.fluid.sound_speed;
    for (const ImposedZone& zone : zones)
      for (std::size_t cell = 0; cell < zone.speed.size(); ++cell) {
        const double pressure =
            scene.numerics.negative_pressure == NegativePressure::clamped ? std::max(zone.pressure[cell], 0.0) : zone.pressure[cell];
        add(zone.speed[cell]);
        add(pressure);
        add(compression_at(pressure / stiffness, scene));
        const std::size_t in_front = cell % (static_cast<std::size_t>(zone.cells[0]) * zone.cells[1]);
        add(in_front < zone.is_free.size() && zone.is_free[in_front] != 0 ? 0.0 : 1.0);
      }
    count_ = static_cast<int>(zones.size());
    values_.set(device, values);
  }
  bool any() const { return count_ > 0; }
  void add_to(compute::Arguments& arguments) const { arguments.value("zone_count", count_).memory("zones", values_.on_device()); }

 private:
  int count_ = 0;
  KeptBuffer<Real> values_;  ///< field::zone_count values a zone, then field::zone_cell_count a cell of those that have a table
};

}  // namespace wavetank

#pragma once

#include "kept_buffer.h"
#include "tables/device_sizes.h"
#include "wavetank/compute/arguments.h"
#include "wavetank/sph/solver.h"

namespace wavetank {

/// Drains as the neighbour grid's kernels have them. Must stay where it is once it is bound.
template <class Real>
class Drains {
 public:
  /// `origin`: the grid's, m.
  void set(const compute::Device& device, const std::vector<Drain>& drains, const Eigen::Vector3d& origin) {
    std::vector<Real> values;
    for (const Drain& drain : drains) {
      const auto add = [&values](const Eigen::Vector3d& vector) {
        for (int axis = 0; axis < 3; ++axis) values.push_back(static_cast<Real>(vector[axis]));
      };
      add(drain.centre - origin);
      for (int k = 0; k < 3; ++k) add(drain.half_edges.col(k) / drain.half_edges.col(k).squaredNorm());
    }
    given_ = count_ = static_cast<int>(drains.size());
    values_.set(device, values);
  }
  /// None is there while they are closed.
  void close(bool closed) { count_ = closed ? 0 : given_; }
  void add_to(compute::Arguments& arguments) const { arguments.value("drain_count", count_).memory("drains", values_.on_device()); }

 private:
  int given_ = 0, count_ = 0;
  KeptBuffer<Real> values_;  ///< field::drain_count values each: centre, and for each pair of faces what gives −1 and 1 on them
};

}  // namespace wavetank

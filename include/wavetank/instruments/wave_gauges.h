#pragma once

#include <memory>
#include <vector>

#include "wavetank/geometry/layout.h"
#include "wavetank/sph/solver.h"

namespace wavetank {

/// Levels on vertical lines. A gauge reads the height of the floor plus the length of its line that is wet, as a resistance wire does: wet
/// is where the fluid fills more than half of the kernel, the walls' share apart. Resolution: linear between points a quarter of the
/// spacing apart.
class WaveGauges {
 public:
  WaveGauges(const Case& scene, const Layout& layout, const Solver& solver);
  /// m, one a gauge.
  std::vector<double> read(Solver& solver) const;

 private:
  struct Line {
    double floor = 0;                ///< z where the line begins, m
    std::size_t begin = 0, end = 0;  ///< its points
  };
  double interval_ = 0;  ///< m between points
  std::vector<Line> lines_;
  std::vector<bool> open_;  ///< of each point: not inside a body
  std::unique_ptr<PointSet> points_;
};

}  // namespace wavetank

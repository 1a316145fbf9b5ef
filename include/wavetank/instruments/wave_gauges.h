#pragma once

#include <memory>
#include <vector>

#include "wavetank/geometry/layout.h"
#include "wavetank/sph/solver.h"

namespace wavetank {

/// Levels on vertical lines. A gauge reads the height of the floor plus the water on its line, ∫ Σ W V / γ dz: the depth under a free
/// surface, the true thickness of a layer thinner than the spacing, and of spray no more than the water in it, as a resistance wire does.
/// A body on the line counts as water where water stands on it, and not where it is dry. The kernel smooths it over the support; the
/// integral is taken with points a quarter of the spacing apart.
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

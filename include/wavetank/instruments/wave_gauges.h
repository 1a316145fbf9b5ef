#pragma once

#include <memory>
#include <vector>

#include "wavetank/geometry/layout.h"
#include "wavetank/instruments/solid_bodies.h"
#include "wavetank/rigid/rigid_world.h"
#include "wavetank/sph/solver.h"

namespace wavetank {

/// Levels on upright lines, along the axis of the tank's top. A gauge reads the coordinate of the floor plus the water on its line from
/// there towards the top, ∫ Σ W V / γ dz where that is z: the depth under a free surface, the true thickness of a layer thinner than the
/// spacing, and of spray no more than the water in it, as a resistance wire does. The floor is the uppermost thing that water stands on: a
/// body, a shelf of the tank, or the tank's floor. So of several surfaces one over another the gauge reads the upper one. What is dry does
/// not count; bodies that move are looked for where they are. The kernel smooths it over the support; the integral is taken with points a
/// quarter of the spacing apart.
class WaveGauges {
 public:
  /// `world` is looked at in every reading.
  WaveGauges(const Case& scene, const Layout& layout, const Solver& solver, const RigidWorld& world);
  /// m, one a gauge.
  std::vector<double> read(Solver& solver) const;

 private:
  struct Line {
    double floor = 0;                ///< height where the line begins, towards the top, m
    std::vector<double> shelves;     ///< heights of the tank's floors above that, upwards, m
    std::size_t begin = 0, end = 0;  ///< its points
  };
  const RigidWorld& world_;
  double interval_ = 0;  ///< m between points
  Top top_;
  std::vector<Line> lines_;
  std::vector<Vector3d> places_;
  std::vector<char> open_;  ///< of each point: not inside a fixed body
  std::vector<SolidBody> moving_;
  std::unique_ptr<PointSet> points_;
};

}  // namespace wavetank

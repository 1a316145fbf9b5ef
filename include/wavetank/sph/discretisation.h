#pragma once

#include <Eigen/Core>

#include "wavetank/geometry/layout.h"
#include "wavetank/scene/case.h"
#include "wavetank/scene/upward.h"

namespace wavetank {

/// What the solver derives from a case and its layout once, in double precision.
struct Discretisation {
  /// Of the spacing, how far a wall may move in a step: the guard looks a quarter of the spacing far.
  static constexpr double wall_reach = 0.2;

  int dimensions = 3;
  double spacing = 0;                                ///< Δx, m
  double smoothing_length = 0;                       ///< h = R/2, m
  double support = 0;                                ///< R, m
  double sound_speed = 0;                            ///< c₀, m/s
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< of the device's coordinates, m: kernels never see large ones
  Eigen::Vector3d lower = Eigen::Vector3d::Zero();   ///< the watchdog's box, m
  Eigen::Vector3d upper = Eigen::Vector3d::Zero();
  Box tank;        ///< bounding box of the tank's walls, without the pockets behind openings, m
  Top top;         ///< of the tank
  double rim = 0;  ///< coordinate of the tank's highest point along the axis of its top, m
  double sound_period =
      0;  ///< s, 4 H/c₀ of the slowest sound, H the greatest depth of a particle under its level; 0 without gravity along Layout::up
  bool splash_guard = true;  ///< above the rim, particles are kept within the tank's walls, taken on over its top
  int cells[3] = {0, 0, 0};  ///< of side R, by which walls are found, border included (2-D: y 1)
  double acoustic_time = 0;  ///< bounds on Δt at rest, s
  double viscous_time = 0;
  double least_time_step = 0;  ///< a Δt below this has collapsed, s
};

/// The greatest speed that a case is expected to reach: of a free fall to the tank's floor from the fluid's highest level, or
/// from the highest place of an opening that has water behind it, m/s.
double expected_speed(const Case& checked, const Layout& layout);

/// The case with its automatic values settled: sound speed, spacing, support. `fastest_wall`: the greatest speed expected of any wall, m/s.
Case settled(const Case& checked, const Layout& layout, double fastest_wall = 0);

/// From a settled case. Throws Error if the grid of cells would be larger than a device can index.
Discretisation discretise(const Case& settled_case, const Layout& layout);

}  // namespace wavetank

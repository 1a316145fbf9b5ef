#pragma once

#include <cstdint>

#include "wavetank/sph/discretisation.h"
#include "wavetank/sph/solver.h"

namespace wavetank {

/// m³ (2-D: m²): 2⁻²⁸ of a particle's volume, so that those of 10⁹ particles can be added.
double volume_quantum(const Discretisation& discretisation);

/// Of some particles what Solver::lost_volume() tells of all, in whole numbers, whose sums have no order.
struct Crowding {
  std::int64_t lost = 0, whole = 0;  ///< volume_quantum()s
  double greatest = 0;               ///< Σ W V of the most crowded of them; of several as crowded that of the least id
  std::uint32_t id = 0;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< m, in the case's coordinates

  void add(const Crowding& others);
  LostVolume volume(const Discretisation& discretisation) const;
};

}  // namespace wavetank

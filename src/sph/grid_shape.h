#pragma once

#include "tiling.h"
#include "wavetank/geometry/layout.h"
#include "wavetank/scene/case.h"
#include "wavetank/sph/discretisation.h"

namespace wavetank {

/// The particles' grid: rows along x of square section, cut into slots. A border of one empty row or slot is included in each direction.
struct GridShape {
  double row_side = 0;     ///< m
  double slot_length = 0;  ///< m
  int rows_y = 1, rows_z = 1, slots_x = 1;

  int slots() const { return rows_y * rows_z * slots_x; }
};

/// Particles that there may be: where water comes in, as many as fill the tank.
std::size_t room_for(const Case& settled_case, const Layout& layout);

/// As fine as the tiling wants it, but no finer than memory allows: of a large tank with little water most slots are empty.
GridShape grid_shape(const Discretisation& discretisation, const Tiling& tiling, std::size_t particles);

}  // namespace wavetank

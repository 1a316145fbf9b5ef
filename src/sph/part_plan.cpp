#include "part_plan.h"

#include <algorithm>
#include <cmath>

#include "build_options.h"
#include "integrators/integrator.h"
#include "tiling.h"
#include "wavetank/parallel/slabs.h"

namespace wavetank {
namespace {

/// Across the longer level axis of the tank.
int axis_of_parts(const Discretisation& d) {
  int axis = -1;
  for (int k = 0; k < 3; ++k) {
    if (k == d.top.axis || (k == 1 && d.dimensions == 2)) continue;
    const double length = d.tank.max[k] - d.tank.min[k];
    if (axis < 0 || length > d.tank.max[axis] - d.tank.min[axis]) axis = k;
  }
  return axis;
}

/// Of blocks, the least that a part may have: halos are of the parts beside it, and none may be in that of the one beyond when it comes
/// into it.
int least_blocks(const Parting& parting, int parts, int halo_less) {
  const int way = parts > 2 ? parting.way : 0;
  return (parting.halo + halo_less + way + parting.block - 1) / parting.block;
}

}  // namespace

Parting parting_for(const Case& scene, const Layout& layout, const Discretisation& d, const compute::DeviceInfo& device,
                    const PartedSolverOptions& options) {
  Parting parting;
  parting.axis = axis_of_parts(d);
  parting.given = layout.particles.size();
  parting.room = room_for(scene, layout);
  const bool ghosts = scene.numerics.walls.method == WallMethod::ghost;
  const GridShape grid = grid_shape(d, tiling_for(device, scene.numerics.precision, ghosts), parting.room);
  const double place = parting.axis == 0 ? grid.slot_length : grid.row_side;
  parting.segment = slots_of_segment(d, grid);
  parting.block = parting.axis == 0 ? parting.segment : 1;  // no tile has particles of two rows
  parting.places = (parting.axis == 0 ? grid.slots_x : parting.axis == 1 ? grid.rows_y : grid.rows_z) - 2;
  parting.periodic = scene.tank.periodic[parting.axis];
  // through the pressure of a wall's element others act from twice the support; a particle drifts, and so do those that it looks for; and
  // there are places beyond the end of a periodic tank, where nobody is
  const double reach = (kind_of(scene.numerics.walls) == WallKind::facets ? 1 : 2) * d.support;
  const double drift = greatest_drift(schedule_of(scene, nullptr), scene, d);
  const double empty = parting.periodic ? parting.places * place - (d.tank.max[parting.axis] - d.tank.min[parting.axis]) : 0;
  parting.halo = static_cast<int>(std::floor((reach + 2 * drift + std::max(empty, 0.0)) * (1 + 1e-4) / place)) + 1 - options.halo_less;
  parting.way = static_cast<int>(std::ceil(2 * drift / place));
  parting.spoils = options.spoils;
  return parting;
}

std::vector<int> cuts_for(std::vector<std::int64_t> weights, const Parting& parting, int parts, bool is_open,
                          const PartedSolverOptions& options) {
  // where water comes in, there may be none yet: empty blocks count for something
  for (std::int64_t& weight : weights) weight = is_open ? 1000 * weight + 1 : weight;
  const int least = least_blocks(parting, parts, options.halo_less);
  std::vector<int> cuts = parallel::cut_into_slabs(weights, parts, least);
  if (options.uneven != 0 && cuts.size() > 2) cuts[1] = std::clamp(cuts[1] + options.uneven, least, cuts[2] - least);
  return cuts;
}

}  // namespace wavetank

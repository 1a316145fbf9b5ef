#include "grid_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wavetank {
namespace {

/// 8 bytes each.
constexpr double most_slots_per_particle = 8;

int refined(int cells, int parts) { return (cells - 2) * parts + 2; }

double slots_of(const Discretisation& d, int rows, int slots) {
  return static_cast<double>(refined(d.cells[0], slots)) * (d.dimensions == 2 ? 1 : refined(d.cells[1], rows)) * refined(d.cells[2], rows);
}

}  // namespace

std::size_t room_for(const Case& scene, const Layout& layout) {
  if (scene.openings.empty()) return layout.particles.size();
  double cells = 1;
  for (int axis = 0; axis < 3; ++axis)
    if (axis != 1 || scene.dimensions == 3) cells *= std::ceil((layout.domain.max[axis] - layout.domain.min[axis]) / layout.spacing);
  return std::max(layout.particles.size(), static_cast<std::size_t>(std::min(cells, 1e9)));
}

GridShape grid_shape(const Discretisation& d, const Tiling& tiling, std::size_t particles) {
  int rows = tiling.rows_per_support, slots = tiling.slots_per_support;
  const double most = std::min(most_slots_per_particle * static_cast<double>(particles), std::numeric_limits<int>::max() / 4.0);
  while (slots > 1 && slots_of(d, rows, slots) > most) --slots;
  while (rows > 1 && slots_of(d, rows, slots) > most) --rows;
  GridShape shape;
  shape.row_side = d.support / rows;
  shape.slot_length = d.support / slots;
  shape.slots_x = refined(d.cells[0], slots);
  shape.rows_y = d.dimensions == 2 ? 1 : refined(d.cells[1], rows);
  shape.rows_z = refined(d.cells[2], rows);
  return shape;
}

}  // namespace wavetank

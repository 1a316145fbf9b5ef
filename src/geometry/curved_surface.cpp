#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "fluid_filling.h"
#include "polygon.h"
#include "wavetank/common/error.h"

namespace wavetank {
namespace {

/// A column's cells that end at the level, and what they are to end at.
struct Column {
  int lowest = 0;     ///< of them
  int cells = 0;      ///< below the surface
  double height = 0;  ///< m, of the surface
  double bottom = 0;  ///< m, of the lowest cell
  double stretch = 1;
};

bool has_water(const FilledRegion& region, int i, int j) {
  for (int k = 0; k < region.count[2]; ++k)
    if (region.filled[region.index(i, j, k)]) return true;
  return false;
}

std::string at(const Vector3d& place) { return " m at x = " + describe(place.x()) + ", y = " + describe(place.y()) + " m"; }

/// None where water does not come up to the level.
std::optional<Column> find_column(const Basin& basin, const FilledRegion& region, int i, int j, double height) {
  int lowest = region.count[2];
  while (lowest > 0 && region.filled[region.index(i, j, lowest - 1)]) --lowest;
  if (lowest == region.count[2]) return std::nullopt;
  Column column;
  column.lowest = lowest;
  column.height = height;
  column.bottom = region.centre(i, j, lowest).z() - 0.5 * region.step.z();
  const Vector3d place = region.centre(i, j, lowest);
  if (height > basin.domain.max.z() + 1e-6 * region.step.z())
    throw Error(region.key + ": by fluid/initial the surface is at z = " + describe(height) + at(place) + ", above the tank's rim at " +
                describe(basin.domain.max.z()) + " m");
  if (height <= basin.domain.min.z())
    throw Error(region.key + ": by fluid/initial the surface is at z = " + describe(height) + at(place) + ", below the tank's floor at " +
                describe(basin.domain.min.z()) + " m");
  const double depth = std::max(height - column.bottom, 0.0);
  column.cells = static_cast<int>(std::lround(depth / region.step.z()));
  if (column.cells > 0) column.stretch = depth / (column.cells * region.step.z());
  return column;
}

/// The lattice with so many more rows above.
void add_rows(FilledRegion& region, int rows) {
  const std::size_t before = region.filled.size();
  const std::size_t cells = checked_cells(region, region.count[2] + rows, region.key);
  region.count[2] += rows;
  region.filled.resize(cells, 0);
  region.position.resize(region.filled.size());
  for (std::size_t c = before; c < region.filled.size(); ++c) {
    const std::size_t column = c % (static_cast<std::size_t>(region.count[0]) * region.count[1]);
    region.position[c] = region.centre(static_cast<int>(column % region.count[0]), static_cast<int>(column / region.count[0]),
                                       static_cast<int>(c / region.count[0] / region.count[1]));
  }
}

void fill_column(const Basin& basin, FilledRegion& region, int i, int j, const Column& column) {
  const int end = column.lowest + column.cells;
  int& top = region.curved.top[region.column(i, j)];
  for (int k = column.lowest; k < region.count[2]; ++k) {
    const std::size_t cell = region.index(i, j, k);
    const bool is_raised = !region.filled[cell];
    region.filled[cell] = 0;
    if (k >= end) continue;
    region.position[cell].z() = column.bottom + (k - column.lowest + 0.5) * column.stretch * region.step.z();
    // what is raised stops at a wall above it
    if (k > column.lowest &&
        (top != k - 1 || (is_raised && basin.grid->crosses(region.position[region.index(i, j, k - 1)], region.position[cell]))))
      continue;
    region.filled[cell] = 1;
    region.curved.stretch[cell] = static_cast<float>(column.stretch);
    region.curved.middle[cell] = region.position[cell].z();
    top = k;
  }
}

/// What leaves a periodic tank at one end comes in at the other, where the surface must be as high.
void check_seams(const Basin& basin, const InitialState& initial, const FilledRegion& region) {
  constexpr double tolerance = 0.05;  // of a cell's height
  for (int axis = 0; axis < 2; ++axis) {
    if (!basin.periodic[axis] || region.step[axis] == 0) continue;
    const int last = region.count[axis] - 1, lines = region.count[1 - axis];
    for (int line = 0; line < lines; ++line) {
      const auto column = [&](int n) { return axis == 0 ? std::pair(n, line) : std::pair(line, n); };
      const auto [i, j] = column(0);
      const auto [far_i, far_j] = column(last);
      Vector3d low = region.centre(i, j, 0), high = region.centre(far_i, far_j, 0);
      const double near_end = 0.75 * region.step[axis];  // the region's last cells end there
      if (low[axis] > basin.domain.min[axis] + near_end || high[axis] < basin.domain.max[axis] - near_end) continue;
      if (!has_water(region, i, j) || !has_water(region, far_i, far_j)) continue;
      low[axis] = basin.domain.min[axis];
      high[axis] = basin.domain.max[axis];
      const double first = initial.elevation(low), other = initial.elevation(high);
      if (std::abs(first - other) > tolerance * region.step.z())
        throw Error(region.key + ": by fluid/initial the surface is raised by " + describe(first) + " m at " + "xy"[axis] + " = " +
                    describe(low[axis]) + " m and by " + describe(other) + " m at " + "xy"[axis] + " = " + describe(high[axis]) +
                    " m, which are one place in a tank that is periodic along " + "xy"[axis] + "; make them the same");
    }
  }
}

}  // namespace

void raise_surface(const Basin& basin, const InitialState& initial, FilledRegion& region) {
  check_seams(basin, initial, region);
  const int rows = region.count[2];
  const double level = region.first.z() + (rows - 0.5) * region.step.z();
  std::vector<std::optional<Column>> columns(static_cast<std::size_t>(region.count[0]) * region.count[1]);
  CurvedSurface& curved = region.curved;
  curved.height.assign(columns.size(), level);
  curved.top.assign(columns.size(), -1);
  int highest = rows;
  for (int j = 0; j < region.count[1]; ++j)
    for (int i = 0; i < region.count[0]; ++i) {
      if (!has_water(region, i, j)) continue;
      const std::size_t c = region.column(i, j);
      Vector3d place = region.centre(i, j, rows - 1);
      place.z() = level;
      curved.height[c] = level + initial.elevation(place);
      columns[c] = find_column(basin, region, i, j, curved.height[c]);
      if (columns[c]) highest = std::max(highest, columns[c]->lowest + columns[c]->cells);
      region.surface.height = std::max(region.surface.height, curved.height[c]);
    }
  add_rows(region, highest - rows);
  curved.stretch.assign(region.filled.size(), 1.0f);
  curved.middle.resize(region.filled.size());
  for (std::size_t c = 0; c < region.filled.size(); ++c) curved.middle[c] = region.position[c].z();
  for (int j = 0; j < region.count[1]; ++j)
    for (int i = 0; i < region.count[0]; ++i)
      if (const auto& column = columns[region.column(i, j)]) fill_column(basin, region, i, j, *column);
}

}  // namespace wavetank

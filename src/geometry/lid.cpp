#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "fluid_filling.h"
#include "polygon.h"
#include "wavetank/common/error.h"

namespace wavetank {
namespace {

/// Which region's particle is near a place.
class ParticleFinder {
 public:
  ParticleFinder(const std::vector<FilledRegion>& regions, double cell) : regions_(regions), cell_(cell), origin_(regions.front().first) {
    for (std::size_t r = 0; r < regions.size(); ++r) {
      for (std::size_t c = 0; c < regions[r].filled.size(); ++c) {
        if (regions[r].filled[c]) cells_[key(at(regions[r].position[c]))].push_back({r, c});
      }
    }
  }

  /// A particle of another region than `region` within `radius` (at most a cell), or null.
  const Vector3d* other(std::size_t region, const Vector3d& place, double radius) const {
    const Vector3i home = at(place);
    for (int dz = -1; dz <= 1; ++dz) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const auto found = cells_.find(key(home + Vector3i(dx, dy, dz)));
          if (found == cells_.end()) continue;
          for (const Entry& entry : found->second) {
            const Vector3d& position = regions_[entry.region].position[entry.cell];
            if (entry.region != region && (position - place).norm() < radius) return &position;
          }
        }
      }
    }
    return nullptr;
  }

 private:
  struct Entry {
    std::size_t region, cell;
  };
  Vector3i at(const Vector3d& place) const { return ((place - origin_) / cell_).array().floor().matrix().cast<int>(); }
  static std::int64_t key(const Vector3i& c) { return (static_cast<std::int64_t>(c.x()) * 2097152 + c.y()) * 2097152 + c.z(); }

  const std::vector<FilledRegion>& regions_;
  double cell_;
  Vector3d origin_;
  std::unordered_map<std::int64_t, std::vector<Entry>> cells_;
};

/// Whether a cell is one of the region's and has the mark.
bool is_marked(const FilledRegion& region, const std::vector<char>& mark, const int cell[3]) {
  for (int axis = 0; axis < 3; ++axis) {
    if (cell[axis] < 0 || cell[axis] >= region.count[axis]) return false;
  }
  return mark[region.index(cell[0], cell[1], cell[2])];
}

/// A side of a cell whose particle is at `centre`, and whose height is `stretch` times that of the region's cells.
WallElement lid_element(const FilledRegion& region, const Vector3d& centre, int axis, int way, double stretch) {
  WallElement element;
  Vector3d side = region.step;
  side.z() *= stretch;
  element.normal = way * Vector3d::Unit(axis);
  element.tangent = axis == 0 ? Vector3d::UnitZ() : Vector3d::UnitX();
  element.centre = centre + 0.5 * side[axis] * element.normal;
  element.area = region.volume / region.step[axis] * (axis == 2 ? 1.0 : stretch);
  const int along = axis == 0 ? 2 : 0, across = 3 - axis - along;
  if (side[across] > 0) element.elongation = side[along] / side[across];  // there is no other side in 2-D
  return element;
}

/// How the surface rises along an axis at a column, from those beside it that have one.
double slope_at(const FilledRegion& region, int i, int j, int axis) {
  if (region.step[axis] == 0) return 0.0;
  int low[2] = {i, j}, high[2] = {i, j};
  const auto has_surface = [&](const int column[2]) {
    return column[axis] >= 0 && column[axis] < region.count[axis] && region.curved.top[region.column(column[0], column[1])] >= 0;
  };
  if (--low[axis]; !has_surface(low)) ++low[axis];
  if (++high[axis]; !has_surface(high)) --high[axis];
  if (high[axis] == low[axis]) return 0.0;
  return (region.curved.height[region.column(high[0], high[1])] - region.curved.height[region.column(low[0], low[1])]) /
         ((high[axis] - low[axis]) * region.step[axis]);
}

/// On the surface over a column, inclined as it is.
WallElement inclined_element(const FilledRegion& region, int i, int j, int k) {
  const double along_x = slope_at(region, i, j, 0), along_y = slope_at(region, i, j, 1);
  WallElement element = lid_element(region, region.centre(i, j, k), 2, 1, 1.0);
  element.centre.z() = region.curved.height[region.column(i, j)];
  element.normal = Vector3d(-along_x, -along_y, 1.0).normalized();
  element.tangent = Vector3d(1.0, 0.0, along_x).normalized();
  element.area *= std::sqrt(1.0 + along_x * along_x + along_y * along_y);
  // its side along the tangent is that of the cell, stretched by the slope along x alone; the area gives the other
  if (region.step.y() > 0) element.elongation = region.step.x() * region.step.x() * (1.0 + along_x * along_x) / element.area;
  return element;
}

/// Whether a cell's side looks at water that only stands lower, below a surface that is not level: the lid on that closes it.
bool looks_over_surface(const FilledRegion& region, const int neighbour[3], int axis) {
  if (region.curved.top.empty() || axis == 2 || neighbour[axis] < 0 || neighbour[axis] >= region.count[axis]) return false;
  const int top = region.curved.top[region.column(neighbour[0], neighbour[1])];
  return top >= 0 && neighbour[2] > top;
}

}  // namespace

void check_overlap(const std::vector<FilledRegion>& regions, double spacing) {
  if (regions.size() < 2) return;
  const ParticleFinder finder(regions, spacing);
  for (std::size_t r = 0; r < regions.size(); ++r) {
    for (std::size_t c = 0; c < regions[r].filled.size(); ++c) {
      if (!regions[r].filled[c]) continue;
      if (const Vector3d* other = finder.other(r, regions[r].position[c], 0.5 * spacing)) {
        throw Error(regions[r].key + " overlaps another region of fluid/fill near " + describe(*other) +
                    " m; each place may be filled once");
      }
    }
  }
}

std::vector<WallElement> make_lid(const Basin& basin, double spacing, const std::vector<FilledRegion>& regions) {
  std::vector<WallElement> lid;
  if (regions.empty()) return lid;
  const ParticleFinder finder(regions, spacing);
  for (std::size_t r = 0; r < regions.size(); ++r) {
    const FilledRegion& region = regions[r];
    for (int k = 0; k < region.count[2]; ++k) {
      for (int j = 0; j < region.count[1]; ++j) {
        for (int i = 0; i < region.count[0]; ++i) {
          const int cell[3] = {i, j, k};
          if (!is_marked(region, region.filled, cell)) continue;
          for (int side = 0; side < 6; ++side) {
            const int axis = side / 2, way = side % 2 ? 1 : -1;
            if (region.step[axis] == 0) continue;
            int neighbour[3] = {i, j, k};
            neighbour[axis] += way;
            if (is_marked(region, region.filled, neighbour) || is_marked(region, region.taken, neighbour)) continue;
            if (looks_over_surface(region, neighbour, axis)) continue;
            const bool on_surface = side == 5 && !region.curved.top.empty() && region.curved.top[region.column(i, j)] == k;
            const std::size_t own = region.index(i, j, k);
            Vector3d from = on_surface ? region.position[own] : region.centre(i, j, k);
            if (!region.curved.top.empty()) from.z() = region.position[own].z();
            const double stretch = region.curved.stretch.empty() ? 1.0 : region.curved.stretch[own];
            const Vector3d to = from + region.centre(neighbour[0], neighbour[1], neighbour[2]) - region.centre(i, j, k);
            // A little farther than the next centre: a cell that stays empty because it touches a wall needs no lid before that wall.
            if (basin.grid->crosses(from, from + 1.06 * (to - from)) || finder.other(r, to, 0.75 * spacing)) continue;
            if (is_filled_by_film(basin, region, to)) continue;
            lid.push_back(on_surface ? inclined_element(region, i, j, k) : lid_element(region, from, axis, way, stretch));
          }
        }
      }
    }
  }
  return lid;
}

}  // namespace wavetank

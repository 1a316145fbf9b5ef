#include "fluid_filling.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "polygon.h"
#include "wavetank/common/error.h"

namespace wavetank {
namespace {

constexpr double most_cells = 1e8;

using Cell = std::array<int, 3>;

Cell cell_at(const FilledRegion& region, std::size_t index) {
  return {static_cast<int>(index % region.count[0]), static_cast<int>(index / region.count[0] % region.count[1]),
          static_cast<int>(index / region.count[0] / region.count[1])};
}

Vector3d centre_of(const FilledRegion& region, const Cell& cell) { return region.centre(cell[0], cell[1], cell[2]); }

bool is_inside(const FilledRegion& region, const Cell& cell) {
  for (int axis = 0; axis < 3; ++axis) {
    if (cell[axis] < 0 || cell[axis] >= region.count[axis]) return false;
  }
  return true;
}

/// Calls visit(neighbour) for the four or six cells about a cell, in the lattice or not.
template <class Visit>
void visit_neighbours(const FilledRegion& region, const Cell& cell, Visit visit) {
  for (int axis = 0; axis < 3; ++axis) {
    if (region.step[axis] == 0) continue;  // y in 2-D
    for (const int way : {-1, 1}) {
      Cell other = cell;
      other[axis] += way;
      visit(other, axis, way);
    }
  }
}

void allocate(FilledRegion& region, const std::string& key) {
  region.filled.assign(checked_cells(region, region.count[2], key), 0);
  region.position.resize(region.filled.size());
  for (std::size_t c = 0; c < region.filled.size(); ++c) region.position[c] = centre_of(region, cell_at(region, c));
  region.volume = region.step.x() * region.step.z() * (region.step.y() > 0 ? region.step.y() : 1.0);
}

/// Empties the cells inside bodies. Cells joined by ways that cross no body are inside or outside together, so one winding number serves
/// them all.
void empty_bodies(const Basin& basin, FilledRegion& region) {
  for (const Solid& solid : basin.solids) {
    const Box bounds = solid.bounds();
    const auto near_body = [&](std::size_t c) {
      const Vector3d& p = region.position[c];
      return (p.array() >= bounds.min.array() - 1e-9).all() && (p.array() <= bounds.max.array() + 1e-9).all();
    };
    std::vector<char> seen(region.filled.size(), 0);
    std::vector<std::size_t> group;
    for (std::size_t c = 0; c < region.filled.size(); ++c) {
      if (seen[c] || !near_body(c)) continue;
      seen[c] = 1;
      group.assign(1, c);
      for (std::size_t next = 0; next < group.size(); ++next) {
        const Cell cell = cell_at(region, group[next]);
        visit_neighbours(region, cell, [&](const Cell& other, int, int) {
          if (!is_inside(region, other)) return;
          const std::size_t o = region.index(other[0], other[1], other[2]);
          if (seen[o] || !near_body(o) || basin.grid->crosses(region.position[group[next]], region.position[o], Walls::bodies)) return;
          seen[o] = 1;
          group.push_back(o);
        });
      }
      if (!solid.contains(region.position[c])) continue;
      for (const std::size_t member : group) region.filled[member] = 0;
    }
  }
}

std::string side_beyond(const Basin& basin, const Box& box, double tolerance) {
  for (int axis = 0; axis < 3; ++axis) {
    if (basin.dimensions == 2 && axis == 1) continue;
    const std::string name(1, "xyz"[axis]);
    if (box.min[axis] < basin.domain.min[axis] - tolerance) {
      return name + " = " + describe(box.min[axis]) + " m, and the tank begins at " + describe(basin.domain.min[axis]) + " m";
    }
    if (box.max[axis] > basin.domain.max[axis] + tolerance) {
      return name + " = " + describe(box.max[axis]) + " m, and the tank ends at " + describe(basin.domain.max[axis]) + " m";
    }
  }
  return "";
}

/// The middle cell of a lattice, or one beside it where a wall passes through the middle.
Cell free_middle(const Basin& basin, double spacing, const FilledRegion& region) {
  const Cell middle = {region.count[0] / 2, region.count[1] / 2, region.count[2] / 2};
  for (int offset = 0; offset < 27; ++offset) {
    const Cell cell = {middle[0] - (offset % 3 + 1) % 3 + 1, middle[1] - (offset / 3 % 3 + 1) % 3 + 1,
                       middle[2] - (offset / 9 + 1) % 3 + 1};
    if (is_inside(region, cell) && !basin.grid->nearest(centre_of(region, cell), 0.05 * spacing)) return cell;
  }
  return middle;
}

/// Marks the cells that can be come to from marked ones without crossing the tank's walls.
void join_within_tank(const Basin& basin, const FilledRegion& region, std::vector<char>& joined) {
  std::vector<std::size_t> queue;
  for (std::size_t c = 0; c < joined.size(); ++c) {
    if (joined[c]) queue.push_back(c);
  }
  while (!queue.empty()) {
    const std::size_t c = queue.back();
    queue.pop_back();
    visit_neighbours(region, cell_at(region, c), [&](const Cell& other, int, int) {
      if (!is_inside(region, other)) return;
      const std::size_t o = region.index(other[0], other[1], other[2]);
      if (joined[o] || basin.grid->crosses(region.position[c], region.position[o], Walls::tank)) return;
      joined[o] = 1;
      queue.push_back(o);
    });
  }
}

/// Every cell must be joined to the box's middle by open space inside the tank, around its baffles if need be. Bodies do not count.
void check_within_tank(const Basin& basin, double spacing, const FilledRegion& region) {
  const Cell middle = free_middle(basin, spacing, region);
  std::vector<char> joined(region.filled.size(), 0);
  joined[region.index(middle[0], middle[1], middle[2])] = 1;
  join_within_tank(basin, region, joined);
  if (std::find(joined.begin(), joined.end(), 0) == joined.end()) return;  // mostly, and the tank may be far larger than the box
  OpenSpace space(basin.domain, basin.dimensions, spacing, *basin.grid, Walls::tank);
  space.flood({centre_of(region, middle)});
  for (std::size_t c = 0; c < joined.size(); ++c) joined[c] = joined[c] || space.reached(region.position[c], region.position[c]);
  join_within_tank(basin, region, joined);  // gaps that are too narrow for the voxels of the open space
  for (std::size_t c = 0; c < joined.size(); ++c) {
    if (joined[c] || basin.grid->nearest(region.position[c], 0.05 * spacing)) continue;
    throw Error(region.key + ": the box sticks out of the tank: a wall of the tank parts " + describe(region.position[c]) +
                " from the box's middle; " + "keep each box on one side of the walls, or fill from a seed");
  }
}

/// Fits n cells of about the spacing between two bounds, and continues the lattice to the ends of the domain.
void fit_axis(FilledRegion& region, int axis, double low, double high, double domain_low, double domain_high, double spacing) {
  const double step = (high - low) / cells_in(high - low, spacing);
  const int before = std::max(0, static_cast<int>(std::ceil((low - domain_low) / step - 1e-6)));
  const int all = before + std::max(1, static_cast<int>(std::ceil((domain_high - low) / step - 1e-6)));
  region.step[axis] = step;
  region.first[axis] = low + (0.5 - before) * step;
  region.count[axis] = all;
}

/// The lattice ends at the bounds' top, and goes on beyond its other sides.
FilledRegion lattice_below(const Basin& basin, const Box& bounds, double spacing, const FreeSurface& surface, const std::string& key) {
  FilledRegion region;
  region.key = key;
  region.surface = surface;
  region.first = region.step = Vector3d::Zero();
  region.count = Vector3i::Ones();
  for (int axis = 0; axis < 3; ++axis) {
    if (basin.dimensions == 2 && axis == 1) continue;
    const bool ends = axis == basin.top.axis;
    const double low = ends && basin.top.way < 0 ? bounds.min[axis] : basin.domain.min[axis];
    const double high = ends && basin.top.way > 0 ? bounds.max[axis] : basin.domain.max[axis];
    fit_axis(region, axis, bounds.min[axis], bounds.max[axis], low, high, spacing);
  }
  allocate(region, key);
  return region;
}

[[noreturn]] void throw_leak(const std::string& key, const Vector3d& where) {
  throw Error(key + ": the fluid leaks out of the tank near " + describe(where) +
              " m; below the fluid's level the tank must have no opening");
}

bool start_flood(const Basin& basin, const FilledRegion& region, const Vector3d& seed, std::vector<std::size_t>& queue) {
  Cell base;
  for (int axis = 0; axis < 3; ++axis) {
    base[axis] = region.step[axis] == 0 ? 0 : static_cast<int>(std::floor((seed[axis] - region.first[axis]) / region.step[axis]));
  }
  for (int corner = 0; corner < 8; ++corner) {
    const Cell cell = {base[0] + (corner & 1), base[1] + (corner >> 1 & 1), base[2] + (corner >> 2 & 1)};
    if (!is_inside(region, cell) || basin.grid->crosses(seed, centre_of(region, cell))) continue;
    queue.push_back(region.index(cell[0], cell[1], cell[2]));
  }
  return !queue.empty();
}

/// Floods the lattice within `bounds`; returns the box that the walls about the reached cells span. The top keeps that of the bounds, and
/// sides without a wall the domain's.
Box flood_lattice(const Basin& basin, const Vector3d& seed, const Box& bounds, FilledRegion& region) {
  std::vector<std::size_t> queue;
  if (!start_flood(basin, region, seed, queue)) {
    throw Error(region.key + ": about the seed " + describe(seed) + " m there is no room for a particle; move it away from the walls");
  }
  for (const std::size_t c : queue) region.filled[c] = 1;
  Box reached = basin.domain;
  Box walls{basin.domain.max, basin.domain.min};
  const Top& top = basin.top;
  double& wall_on_top = top.way > 0 ? walls.max[top.axis] : walls.min[top.axis];
  wall_on_top = top.of(bounds);
  while (!queue.empty()) {
    const std::size_t c = queue.back();
    queue.pop_back();
    const Vector3d from = region.position[c];
    visit_neighbours(region, cell_at(region, c), [&](const Cell& other, int axis, int way) {
      if (!region.surface.wets(centre_of(region, other))) return;
      if (is_inside(region, other) && region.filled[region.index(other[0], other[1], other[2])]) return;
      Vector3d to = from;
      to[axis] += way * region.step[axis];
      if (const auto crossing = basin.grid->first_crossing(from, to)) {
        const double wall = from[axis] + crossing->fraction * (to[axis] - from[axis]);
        const bool on_top = axis == top.axis && way == top.way;
        if (way < 0 && !on_top) walls.min[axis] = std::min(walls.min[axis], wall);
        if (way > 0 && !on_top) walls.max[axis] = std::max(walls.max[axis], wall);
        return;
      }
      if (!is_inside(region, other) || to[axis] < basin.domain.min[axis] || to[axis] > basin.domain.max[axis]) {
        throw_leak(region.key, 0.5 * (from + to));
      }
      const std::size_t o = region.index(other[0], other[1], other[2]);
      region.filled[o] = 1;
      queue.push_back(o);
    });
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (walls.min[axis] < walls.max[axis]) reached.min[axis] = walls.min[axis], reached.max[axis] = walls.max[axis];
  }
  (top.way > 0 ? reached.max : reached.min)[top.axis] = top.of(bounds);
  return reached;
}

void check_seed(const Basin& basin, const FloodFill& flood, const std::string& key) {
  const std::string seed = key + ": the seed " + describe(flood.seed) + " m ";
  for (int axis = 0; axis < 3; ++axis) {
    if (basin.dimensions == 2 && axis == 1) continue;
    if (flood.seed[axis] <= basin.domain.min[axis] || flood.seed[axis] >= basin.domain.max[axis]) {
      throw Error(seed + "lies outside the tank, which spans " + describe(basin.domain.min) + " to " + describe(basin.domain.max) + " m");
    }
  }
  const Top& top = basin.top;
  if (top.way * flood.seed[top.axis] >= top.way * flood.level)
    throw Error(seed + "lies above the level " + "xyz"[top.axis] + " = " + describe(flood.level) + " m");
  for (const Solid& solid : basin.solids) {
    if (solid.contains(flood.seed)) throw Error(seed + "lies inside body '" + solid.name + "'");
  }
}

}  // namespace

std::size_t checked_cells(const FilledRegion& region, int rows, const std::string& key) {
  const double cells = static_cast<double>(region.count[0]) * region.count[1] * rows;
  if (cells > most_cells) throw Error(key + ": more than 1e8 cells; choose a larger fluid/spacing");
  return static_cast<std::size_t>(cells);
}

FilledRegion fill_box(const Basin& basin, const Box& box, double spacing, const std::string& key) {
  FilledRegion region;
  region.key = key;
  region.surface = {basin.top.normal(), basin.top.way * basin.top.of(box)};
  region.first = region.step = Vector3d::Zero();
  region.count = Vector3i::Ones();
  const std::string beyond = side_beyond(basin, box, 1e-3 * spacing);
  if (!beyond.empty()) throw Error(key + ": the box sticks out of the tank: it reaches " + beyond);
  for (int axis = 0; axis < 3; ++axis) {
    if (basin.dimensions == 2 && axis == 1) continue;
    const double length = box.max[axis] - box.min[axis];
    if (!(length > 0)) throw Error(key + ": the box has no extent along " + std::string(1, "xyz"[axis]));
    region.count[axis] = cells_in(length, spacing);
    region.step[axis] = length / region.count[axis];
    region.first[axis] = box.min[axis] + 0.5 * region.step[axis];
  }
  allocate(region, key);
  std::fill(region.filled.begin(), region.filled.end(), 1);
  check_within_tank(basin, spacing, region);
  empty_bodies(basin, region);
  return region;
}

FilledRegion fill_flood(const Basin& basin, const FloodFill& given, double spacing, const std::string& key) {
  FloodFill flood = given;
  if (basin.dimensions == 2) flood.seed.y() = 0;
  check_seed(basin, flood, key);
  const Top& top = basin.top;
  Vector3d over_seed = flood.seed;
  over_seed[top.axis] = flood.level;
  const bool along_axis = basin.up == top.normal();
  const FreeSurface surface{basin.up, along_axis ? top.way * flood.level : basin.up.dot(over_seed)};
  if (surface.height > highest_of(basin.domain, basin.up) + 1e-3 * spacing) {
    throw Error(key + ": the level " + "xyz"[top.axis] + " = " + describe(flood.level) + " m is above the tank's rim at " +
                describe(top.of(basin.domain)) + " m");
  }
  Box bounds = basin.domain;
  if (along_axis) (top.way > 0 ? bounds.max : bounds.min)[top.axis] = flood.level;
  FilledRegion coarse = lattice_below(basin, bounds, spacing, surface, key);
  bounds = flood_lattice(basin, flood.seed, bounds, coarse);
  FilledRegion region = lattice_below(basin, bounds, spacing, surface, key);
  flood_lattice(basin, flood.seed, bounds, region);
  return region;
}

void keep_off_walls(const Basin& basin, double spacing, FilledRegion& region) {
  const double too_near = 0.05 * spacing, room = 0.25 * spacing;
  region.taken.assign(region.filled.size(), 0);
  for (std::size_t c = 0; c < region.filled.size(); ++c) {
    if (!region.filled[c]) continue;
    const auto wall = basin.grid->nearest(region.position[c], too_near);
    if (!wall) continue;
    region.filled[c] = 0;
    region.taken[c] = 1;
    if (wall->distance < 0.2 * too_near) continue;  // on the wall: there is no saying on which side
    const Vector3d away = wall->point + room / wall->distance * (region.position[c] - wall->point);
    if (basin.grid->crosses(region.position[c], away) || basin.grid->nearest(away, too_near)) continue;
    region.position[c] = away;
    region.filled[c] = 1;
    region.taken[c] = 0;
  }
}

void check_watertight(const Basin& basin, double spacing, const FilledRegion& region) {
  std::vector<Vector3d> particles;
  for (std::size_t c = 0; c < region.filled.size(); ++c) {
    if (region.filled[c]) particles.push_back(region.position[c]);
  }
  OpenSpace space(basin.domain, basin.dimensions, spacing, *basin.grid, Walls::all, basin.top);
  space.flood(particles, region.surface);
  if (space.escape()) throw_leak(region.key, *space.escape());
}

}  // namespace wavetank

#include <algorithm>
#include <map>

#include "fluid_filling.h"
#include "polygon.h"
#include "wavetank/common/log.h"

namespace wavetank {
namespace {

/// Water of one fill that a body parts from the rest of it.
struct PartedWater {
  double volume = 0;  ///< m³ (2-D: m²)
  Vector3d moment = Vector3d::Zero();
};

/// Calls visit(neighbour's index) for the cells beside one that are filled.
template <class Visit>
void visit_filled_neighbours(const FilledRegion& region, std::size_t c, Visit visit) {
  const int count[3] = {region.count[0], region.count[1], region.count[2]};
  const int cell[3] = {static_cast<int>(c % count[0]), static_cast<int>(c / count[0] % count[1]),
                       static_cast<int>(c / count[0] / count[1])};
  const std::size_t stride[3] = {1, static_cast<std::size_t>(count[0]), static_cast<std::size_t>(count[0]) * count[1]};
  for (int axis = 0; axis < 3; ++axis) {
    if (cell[axis] > 0 && region.filled[c - stride[axis]]) visit(c - stride[axis]);
    if (cell[axis] + 1 < count[axis] && region.filled[c + stride[axis]]) visit(c + stride[axis]);
  }
}

/// Filled cells joined by steps that cross no wall, the most first.
std::vector<std::vector<std::size_t>> joined_cells(const Basin& basin, const FilledRegion& region) {
  std::vector<std::vector<std::size_t>> groups;
  std::vector<bool> seen(region.filled.size());
  for (std::size_t c = 0; c < seen.size(); ++c) {
    if (!region.filled[c] || seen[c]) continue;
    seen[c] = true;
    std::vector<std::size_t> group(1, c);
    for (std::size_t next = 0; next < group.size(); ++next) {
      const std::size_t from = group[next];
      visit_filled_neighbours(region, from, [&](std::size_t to) {
        if (seen[to] || basin.grid->crosses(region.position[from], region.position[to])) return;
        seen[to] = true;
        group.push_back(to);
      });
    }
    groups.push_back(std::move(group));
  }
  std::stable_sort(groups.begin(), groups.end(), [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return groups;
}

/// The owner of most walls that stand right beside the cells; −1 if there is none.
int owner_about(const Basin& basin, const FilledRegion& region, const std::vector<std::size_t>& cells) {
  std::map<int, int> met;
  for (const std::size_t c : cells) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const double way : {-1.5, 1.5}) {
        const Vector3d to = region.position[c] + way * region.step[axis] * Vector3d::Unit(axis);
        if (region.step[axis] == 0) continue;
        const auto crossing = basin.grid->first_crossing(region.position[c], to);
        const int owner = crossing ? basin.grid->triangles()[crossing->triangle].owner : 0;
        if (owner > 0) ++met[owner];  // the tank's own walls are looked at elsewhere
      }
    }
  }
  int most = -1;
  for (const auto& [owner, count] : met)
    if (most < 0 || count > met[most]) most = owner;
  return most;
}

std::map<int, PartedWater> find_parted_water(const Basin& basin, double spacing, const FilledRegion& region) {
  std::map<int, PartedWater> parted;
  const std::vector<std::vector<std::size_t>> groups = joined_cells(basin, region);
  if (groups.size() < 2) return parted;
  // There may be a way round through water of another fill, or between the lattice's places; but none over the top.
  OpenSpace rest(basin.domain, basin.dimensions, spacing, *basin.grid, Walls::all);
  std::vector<Vector3d> start;
  for (const std::size_t c : groups.front()) start.push_back(region.position[c]);
  rest.flood(start, region.surface);
  for (std::size_t g = 1; g < groups.size(); ++g) {
    const auto is_joined = [&](std::size_t c) { return rest.reached(region.position[c], region.position[c]); };
    if (std::any_of(groups[g].begin(), groups[g].end(), is_joined)) continue;
    const int owner = owner_about(basin, region, groups[g]);
    if (owner < 0) continue;
    PartedWater& water = parted[owner];
    for (const std::size_t c : groups[g]) {
      const double volume = region.share[c] * region.volume;
      water.volume += volume;
      water.moment += volume * region.position[c];
    }
  }
  return parted;
}

}  // namespace

void tell_of_parted_water(const Case& checked, const Basin& basin, double spacing, const std::vector<FilledRegion>& regions) {
  if (basin.solids.empty()) return;
  for (std::size_t f = 0; f < regions.size(); ++f) {
    if (!std::holds_alternative<Box>(checked.fluid.fill[f])) continue;  // from a seed the water stays where it can flow
    for (const auto& [owner, water] : find_parted_water(basin, spacing, regions[f])) {
      const bool flat = checked.dimensions == 2;
      log(LogLevel::warning, regions[f].key + ": body '" + basin.solids[owner - 1].name + "' parts " + describe(water.volume) +
                                 (flat ? " m³ a metre of width (" : " m³ (") + describe(checked.fluid.density * water.volume) +
                                 " kg) of the box's water from the rest, about " + describe(Vector3d(water.moment / water.volume)) +
                                 " m: it starts there, inside or behind the body; to leave that place dry, fill from a seed");
    }
  }
}

}  // namespace wavetank

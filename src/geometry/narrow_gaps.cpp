#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <unordered_map>

#include "fluid_filling.h"

namespace wavetank {
namespace {

constexpr double least_room = 0.9;   // of a cell: the width that a gap must have for a particle
constexpr double least_apart = 0.7;  // of a cell's shortest side: the distance that particles of one gap must have
constexpr double facing = 0.8;       // cosine: walls within 37° of facing each other make a gap

constexpr double placed = 2.0, shared = 3.0;  // cells: widths up to which particles are placed by their gap, and have its volume
constexpr double tolerance = 0.01;            // cells: so that all particles of one gap agree on its width
constexpr double whole_rows = 0.02;
constexpr float least_share = 0.5f, most_share = 2.0f;

/// A place between two walls that face each other.
struct Gap {
  Vector3d across;   ///< unit, from the nearer wall to the other
  double near = 0;   ///< m, distance from the nearer wall
  double width = 0;  ///< m
  double cell = 0;   ///< m, what a lattice cell has of that direction
  int owners[2] = {0, 0};

  bool holds_particles() const { return width >= least_room * cell; }
};

/// Particles by place, for those in gaps.
class Crowd {
 public:
  Crowd(const FilledRegion& region, double reach) : side_(reach * region.step.maxCoeff()) {}

  /// Calls `visit` for all that are nearer than the reach, and some more.
  template <class Visit>
  void visit_near(const Vector3d& place, const Visit& visit) const {
    const Vector3i home = at(place);
    for (int k = 0; k < 27; ++k) {
      const auto found = places_.find(key(home + Vector3i(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1)));
      if (found == places_.end()) continue;
      for (const Vector3d& other : found->second) visit(other);
    }
  }
  bool has_near(const Vector3d& place, double distance) const {
    bool found = false;
    visit_near(place, [&](const Vector3d& other) { found = found || (other - place).norm() < distance; });
    return found;
  }
  void add(const Vector3d& place) { places_[key(at(place))].push_back(place); }

 private:
  Vector3i at(const Vector3d& place) const { return (place / side_).array().floor().matrix().cast<int>(); }
  static std::int64_t key(const Vector3i& c) { return (static_cast<std::int64_t>(c.x()) * 2097152 + c.y()) * 2097152 + c.z(); }

  double side_;
  std::unordered_map<std::int64_t, std::vector<Vector3d>> places_;
};

/// The gap narrower than some cells that a place is in.
std::optional<Gap> gap_about(const TriangleGrid& grid, const Vector3d& place, const Vector3d& step, double cells) {
  const auto wall = grid.nearest(place, (0.5 * cells + tolerance) * step.maxCoeff());
  if (!wall || !(wall->distance > 0)) return std::nullopt;
  Gap gap;
  gap.across = (place - wall->point) / wall->distance;
  gap.near = wall->distance;
  gap.cell = gap.across.cwiseAbs2().dot(step);
  const double ahead = cells * gap.cell - gap.near;
  if (!(ahead > 0) || std::abs(grid.normal(wall->triangle).dot(gap.across)) < facing) return std::nullopt;
  const auto other = grid.first_crossing(place, place + ahead * gap.across);
  if (!other || std::abs(grid.normal(other->triangle).dot(gap.across)) < facing) return std::nullopt;
  gap.width = gap.near + other->fraction * ahead;
  gap.owners[0] = grid.triangles()[wall->triangle].owner;
  gap.owners[1] = grid.triangles()[other->triangle].owner;
  if (gap.width > (cells - tolerance) * gap.cell) return std::nullopt;
  return gap;
}

/// How many particles stand across the gap at a place: those beside the line across count by their distance from it, so that in a lattice
/// each column counts once.
double rows_across(const Crowd& crowd, const Gap& gap, const Vector3d& place, const Vector3d& step) {
  double rows = 0;
  crowd.visit_near(place, [&](const Vector3d& other) {
    const double along = (other - place).dot(gap.across);
    if (along < -gap.near || along > gap.width - gap.near) return;
    const Vector3d beside = other - place - along * gap.across;
    double weight = 1;
    for (int axis = 0; axis < 3; ++axis)
      if (step[axis] > 0) weight *= std::max(1.0 - std::abs(beside[axis]) / step[axis], 0.0);
    rows += weight;
  });
  return rows;
}

/// Whether the region's water may reach a place.
bool has_water(const FilledRegion& region, const Vector3d& place) {
  const Vector3d cell = (place - region.first).array() / region.step.array().max(1e-300);
  for (int axis = 0; axis < 3; ++axis)
    if (region.step[axis] > 0 && (cell[axis] < -0.6 || cell[axis] > region.count[axis] - 0.4)) return false;
  return region.surface.normal.dot(place) < region.surface.height + 0.1 * region.step.maxCoeff();
}

/// The particles of a gap have its volume among them, also where a row more or less would fill it.
void share_gaps(const Basin& basin, FilledRegion& region) {
  Crowd crowd(region, shared);
  std::vector<std::pair<std::size_t, Gap>> gaps;
  for (std::size_t c = 0; c < region.filled.size(); ++c) {
    if (!region.filled[c]) continue;
    const std::optional<Gap> gap = gap_about(*basin.grid, region.position[c], region.step, shared);
    if (!gap) continue;
    gaps.emplace_back(c, *gap);
    crowd.add(region.position[c]);
  }
  for (const auto& [c, gap] : gaps) {
    if (!has_water(region, region.position[c] + (gap.width - gap.near - 0.5 * gap.cell) * gap.across))
      continue;  // not filled to the wall across
    const double rows = rows_across(crowd, gap, region.position[c], region.step);
    const double of_gap = gap.width / (gap.cell * rows);
    if (std::abs(of_gap - 1) < whole_rows) continue;  // the lattice fills it, and other walls may cut its cells
    region.share[c] = std::clamp(static_cast<float>(of_gap), least_share, most_share);
  }
}

/// The same for all places of a gap, whichever of its walls is nearer.
bool points_up(const Vector3d& across) {
  int axis = 0;
  across.cwiseAbs().maxCoeff(&axis);
  return across[axis] > 0;
}

/// Every second cell of the lattice.
bool is_even(const FilledRegion& region, std::size_t cell) {
  const std::size_t i = cell % region.count[0], j = cell / region.count[0] % region.count[1], k = cell / region.count[0] / region.count[1];
  return (i + j + k) % 2 == 0;
}

}  // namespace

bool is_too_narrow_for_particles(const Basin& basin, const FilledRegion& region, const Vector3d& place) {
  const std::optional<Gap> gap = gap_about(*basin.grid, place, region.step, 1.0);
  return gap && !gap->holds_particles();
}

bool is_filled_by_film(const Basin& basin, const FilledRegion& region, const Vector3d& place) {
  const std::optional<Gap> gap = gap_about(*basin.grid, place, region.step, 1.0);
  if (!gap || gap->holds_particles() || gap->owners[0] == gap->owners[1]) return false;
  const auto is_free = [&](int owner) { return owner > 0 && basin.solids[owner - 1].is_free; };
  return basin.has_films && !is_free(gap->owners[0]) && !is_free(gap->owners[1]);
}

void keep_out_of_gaps(const Basin& basin, FilledRegion& region) {
  Crowd crowd(region, 1.0);
  const double shortest = basin.dimensions == 2 ? std::min(region.step.x(), region.step.z()) : region.step.minCoeff();
  for (std::size_t c = 0; c < region.filled.size(); ++c) {
    if (!region.filled[c]) continue;
    const std::optional<Gap> gap = gap_about(*basin.grid, region.position[c], region.step, placed);
    if (!gap) continue;
    const double off = std::min(0.5 * gap->cell, 0.5 * gap->width);
    // the one row of a gap goes to and fro between its walls: packing would bend it so, but slowly
    const bool one_row = gap->width - 2 * off < least_apart * shortest;
    const double from_wall =
        one_row ? (is_even(region, c) == points_up(gap->across) ? off : gap->width - off) : std::clamp(gap->near, off, gap->width - off);
    const Vector3d place = region.position[c] + (from_wall - gap->near) * gap->across;
    region.filled[c] = 0;
    if (!gap->holds_particles()) continue;
    region.taken[c] = crowd.has_near(place, least_apart * shortest);
    if (region.taken[c]) continue;
    region.filled[c] = 1;
    region.position[c] = place;
    crowd.add(place);
  }
  share_gaps(basin, region);
}

}  // namespace wavetank

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

/// A place between two walls that face each other.
struct Gap {
  Vector3d across;   ///< unit, from the nearer wall to the other
  double near = 0;   ///< m, distance from the nearer wall
  double width = 0;  ///< m
  double cell = 0;   ///< m, what a lattice cell has of that direction
};

/// Particles by place, for those in gaps.
class Crowd {
 public:
  explicit Crowd(const FilledRegion& region) : side_(region.step.maxCoeff()) {}

  bool has_near(const Vector3d& place, double distance) const {
    const Vector3i home = at(place);
    for (int k = 0; k < 27; ++k) {
      const auto found = places_.find(key(home + Vector3i(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1)));
      if (found == places_.end()) continue;
      for (const Vector3d& other : found->second)
        if ((other - place).norm() < distance) return true;
    }
    return false;
  }
  void add(const Vector3d& place) { places_[key(at(place))].push_back(place); }

 private:
  Vector3i at(const Vector3d& place) const { return (place / side_).array().floor().matrix().cast<int>(); }
  static std::int64_t key(const Vector3i& c) { return (static_cast<std::int64_t>(c.x()) * 2097152 + c.y()) * 2097152 + c.z(); }

  double side_;
  std::unordered_map<std::int64_t, std::vector<Vector3d>> places_;
};

/// The gap narrower than two cells that a place is in.
std::optional<Gap> gap_about(const TriangleGrid& grid, const Vector3d& place, const Vector3d& step) {
  const auto wall = grid.nearest(place, step.maxCoeff());
  if (!wall || !(wall->distance > 0)) return std::nullopt;
  Gap gap;
  gap.across = (place - wall->point) / wall->distance;
  gap.near = wall->distance;
  gap.cell = gap.across.cwiseAbs2().dot(step);
  const double ahead = 2 * gap.cell - gap.near;
  if (!(ahead > 0) || std::abs(grid.normal(wall->triangle).dot(gap.across)) < facing) return std::nullopt;
  const auto other = grid.first_crossing(place, place + ahead * gap.across);
  if (!other || std::abs(grid.normal(other->triangle).dot(gap.across)) < facing) return std::nullopt;
  gap.width = gap.near + other->fraction * ahead;
  return gap;
}

}  // namespace

void keep_out_of_gaps(const Basin& basin, FilledRegion& region) {
  region.taken.assign(region.filled.size(), 0);
  Crowd crowd(region);
  const double shortest = basin.dimensions == 2 ? std::min(region.step.x(), region.step.z()) : region.step.minCoeff();
  for (std::size_t c = 0; c < region.filled.size(); ++c) {
    if (!region.filled[c]) continue;
    const std::optional<Gap> gap = gap_about(*basin.grid, region.position[c], region.step);
    if (!gap) continue;
    const double off = std::min(0.5 * gap->cell, 0.5 * gap->width);
    const Vector3d place = region.position[c] + (std::clamp(gap->near, off, gap->width - off) - gap->near) * gap->across;
    region.filled[c] = 0;
    if (gap->width < least_room * gap->cell) continue;
    region.taken[c] = crowd.has_near(place, least_apart * shortest);
    if (region.taken[c]) continue;
    region.filled[c] = 1;
    region.position[c] = place;
    crowd.add(place);
  }
}

}  // namespace wavetank

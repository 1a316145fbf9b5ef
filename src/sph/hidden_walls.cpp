#include "hidden_walls.h"

#include <algorithm>

#include "wall_cells.h"

namespace wavetank {
namespace {

constexpr double look_off = 0.05;  // of the spacing

}  // namespace

HiddenWalls::HiddenWalls(const Layout& layout, int dimensions)
    : dimensions_(dimensions),
      look_off_(look_off * layout.spacing),
      by_(layout.meshes.size()),
      solids_(layout.meshes.size()),
      facets_(layout.facets),
      pieces_(layout.pieces) {
  for (const auto& [owner, other] : layout.intruding) {
    by_[owner].push_back(other);
    if (!solids_[other]) solids_[other].emplace(layout.meshes[other]);
  }
}

std::vector<int> HiddenWalls::facets_in_sight(const std::vector<WallPose>& poses) const {
  std::vector<int> seen;
  auto piece = pieces_.begin();
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    const int facet = static_cast<int>(f);
    const auto first = piece;
    while (piece != pieces_.end() && piece->facet == facet) ++piece;
    if (!concerns(facets_[f].owner)) continue;
    if (first == piece) {
      if (!hides(facets_[f], poses)) seen.push_back(facet);
      continue;
    }
    std::vector<int> parts;
    for (auto part = first; part != piece; ++part)
      if (!hides(part->shape, poses)) parts.push_back(static_cast<int>(facets_.size() + (part - pieces_.begin())));
    if (parts.size() == static_cast<std::size_t>(piece - first)) parts = {facet};
    seen.insert(seen.end(), parts.begin(), parts.end());
  }
  return seen;
}

bool HiddenWalls::hides(const Facet& wall, const std::vector<WallPose>& poses) const {
  if (!concerns(wall.owner)) return false;
  const WallPose& own = poses[wall.owner];
  const Vector3d centre = own.of(middle_of(wall, dimensions_)), off = look_off_ * (own.rotation * wall.normal);
  return std::any_of(by_[wall.owner].begin(), by_[wall.owner].end(), [&](int other) {
    const WallPose& pose = poses[other];
    const auto holds = [&](const Vector3d& place) {
      Vector3d at_rest = pose.rotation.transpose() * (place - pose.place) + pose.rest;
      if (dimensions_ == 2) at_rest.y() = 1e-3 * look_off_;  // what lies in the plane counts as above it, as in its section
      return solids_[other]->holds(at_rest);
    };
    // Before it, where the water would be; or behind it, where both bodies are: then the first one's wall is enough.
    return holds(centre - off) || (wall.owner > other && holds(centre + off));
  });
}

}  // namespace wavetank

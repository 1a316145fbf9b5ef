#include "hidden_walls.h"

#include <algorithm>

#include "wall_cells.h"

namespace wavetank {
namespace {

constexpr double look_off = 0.05;     // of the spacing
constexpr double largest_hidden = 2;  // spacings: larger facets rely on their neighbours in the plane

}  // namespace

HiddenWalls::HiddenWalls(const Layout& layout, int dimensions)
    : dimensions_(dimensions), look_off_(look_off * layout.spacing), by_(layout.meshes.size()), solids_(layout.meshes.size()) {
  for (const auto& [owner, other] : layout.intruding) {
    by_[owner].push_back(other);
    if (!solids_[other]) solids_[other].emplace(layout.meshes[other]);
  }
}

bool HiddenWalls::hides(const Facet& wall, const std::vector<WallPose>& poses) const {
  if (!concerns(wall.owner)) return false;
  for (int k = 0; k < 3; ++k)
    if ((wall.corners[(k + 1) % 3] - wall.corners[k]).norm() > largest_hidden / look_off * look_off_) return false;
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

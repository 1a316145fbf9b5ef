#include "owner_boxes.h"

#include <algorithm>

namespace wavetank {

std::vector<Box> owner_boxes(const Layout& layout, const std::vector<Vector3d>& centres) {
  std::vector<Box> boxes;
  for (const Vector3d& centre : centres) boxes.push_back({centre, centre});  // of one that has no walls
  std::vector<bool> found(centres.size(), false);
  for (const Facet& facet : layout.facets) {
    Box& box = boxes.at(facet.owner);
    for (const Vector3d& corner : facet.corners) {
      box.min = found[facet.owner] ? Vector3d(box.min.cwiseMin(corner)) : corner;
      box.max = found[facet.owner] ? Vector3d(box.max.cwiseMax(corner)) : corner;
      found[facet.owner] = true;
    }
  }
  return boxes;
}

double fastest_wall(const std::vector<Box>& boxes, const std::vector<Vector3d>& centres, const WallMotions& motions) {
  double fastest = 0;
  for (std::size_t o = 1; o < centres.size(); ++o) {
    const Vector3d reach = (boxes[o].max - centres[o]).cwiseAbs().cwiseMax((boxes[o].min - centres[o]).cwiseAbs());
    const WallMotion& motion = motions.owners[o];
    fastest = std::max(fastest, motion.velocity.norm() + motion.angular_velocity.norm() * reach.norm());
  }
  return fastest;
}

}  // namespace wavetank

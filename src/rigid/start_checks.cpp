#include "start_checks.h"

#include <algorithm>
#include <string>

#include "number_text.h"
#include "wavetank/common/error.h"
#include "wavetank/common/log.h"

namespace wavetank {
namespace {

constexpr double told_overlap = 0.1;  // of the spacing

std::string place_text(const Vector3d& place) {
  return "[" + number_text(place.x()) + ", " + number_text(place.y()) + ", " + number_text(place.z()) + "]";
}

std::string extent_text(const Box& box) { return place_text(box.min) + " to " + place_text(box.max) + " m"; }

bool hangs_on_joint(std::size_t owner, const std::vector<Joint>& joints) {
  return std::any_of(joints.begin(), joints.end(), [&](const Joint& joint) {
    return joint.holds_together() && (joint.child().owner == static_cast<int>(owner) || joint.parent().owner == static_cast<int>(owner));
  });
}

/// Whether the boxes have nothing in common; in 2-D those of the sections.
bool apart(const Box& box, const Box& domain, int dimensions, const Top& top, bool open_top) {
  for (int axis = 0; axis < 3; ++axis) {
    if (dimensions == 2 && axis == 1) continue;
    const int over_the_rim = axis == top.axis && open_top ? top.way : 0;
    if ((box.max[axis] < domain.min[axis] && over_the_rim >= 0) || (box.min[axis] > domain.max[axis] && over_the_rim <= 0)) return true;
  }
  return false;
}

/// Whether a place has a facet under it that holds what comes from above.
bool has_floor(const Vector3d& place, const Vector3d& down, const Layout& layout, const std::vector<RigidOwner>& owners) {
  return std::any_of(layout.facets.begin(), layout.facets.end(), [&](const Facet& facet) {
    const double slope = facet.normal.dot(down);
    const bool falls_too = facet.owner > 0 && owners[facet.owner].is_free();
    if (falls_too || !(slope > 0)) return false;
    const double way = facet.normal.dot(facet.plane_point - place) / slope;
    if (way < 0) return false;
    const Vector3d foot = place + way * down;
    const Vector3d nearest = nearest_on_triangle(foot, facet.corners[0], facet.corners[1], facet.corners[2]);
    return (nearest - foot).norm() < 1e-3 * layout.spacing;
  });
}

}  // namespace

void check_places(const Case& scene, const Layout& layout, const std::vector<RigidOwner>& owners, const std::vector<Joint>& joints) {
  const Top top = top_of(scene);
  for (std::size_t o = 1; o < owners.size(); ++o) {
    if (!owners[o].is_free() || hangs_on_joint(o, joints)) continue;
    const Box box = layout.meshes[o].bounding_box();
    if (apart(box, layout.domain, scene.dimensions, top, layout.open_top))
      throw Error(owners[o].what + " is free and starts wholly outside of the tank: it reaches from " + extent_text(box) +
                  ", the tank from " + extent_text(layout.domain) + "; put it inside, or over the tank if that is open");
    Vector3d middle = 0.5 * (box.min + box.max);
    if (scene.dimensions == 2) middle.y() = 0;
    const bool falls = scene.gravity.norm() > 0 && scene.tank.rigid.collision == CollisionShape::automatic &&
                       scene.bodies[o - 1].rigid.collision != CollisionShape::none && !scene.tank.periodic[top.axis];
    if (falls && !has_floor(middle, -upward(scene), layout, owners))
      log(LogLevel::warning, owners[o].what + " starts at " + place_text(middle) +
                                 " m over no wall that water can reach, and contacts know no other: should it sink there, the tank will "
                                 "not hold it.");
  }
}

void tell_of_overlaps(const std::vector<Contact>& contacts, const std::vector<RigidOwner>& owners, double spacing) {
  const auto deepest = std::min_element(contacts.begin(), contacts.end(), [](const Contact& a, const Contact& b) { return a.gap < b.gap; });
  if (deepest == contacts.end() || deepest->gap >= -told_overlap * spacing) return;
  log(LogLevel::warning, owners[deepest->owner_a].what + " and " + owners[deepest->owner_b].what + " overlap by " +
                             number_text(-deepest->gap) + " m at the start, and will be pushed apart at once.");
}

}  // namespace wavetank

#include "intruding_walls.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "wavetank/geometry/solid_surface.h"

namespace wavetank {
namespace {

constexpr double piece = 0.5;              // of the spacing: the longest side of what can be hidden
constexpr double look_off = 0.05;          // of the spacing
constexpr std::size_t most_pieces = 4000;  // of one body; beyond that its pieces are larger

Box grown(Box box, double by) {
  box.min.array() -= by;
  box.max.array() += by;
  return box;
}

bool meet(const Box& a, const Box& b, int dimensions) {
  for (int axis = 0; axis < 3; ++axis)
    if ((dimensions == 3 || axis != 1) && (a.min[axis] > b.max[axis] || b.min[axis] > a.max[axis])) return false;
  return true;
}

Box common(const Box& a, const Box& b) { return {a.min.cwiseMax(b.min), a.max.cwiseMin(b.max)}; }

Box box_of(const Facet& facet, int dimensions) {
  Box box{facet.corners[0], facet.corners[0]};
  for (int k = 1; k < dimensions; ++k) {
    box.min = box.min.cwiseMin(facet.corners[k]);
    box.max = box.max.cwiseMax(facet.corners[k]);
  }
  return box;
}

/// Whether a joint keeps its two bodies together; else contacts do not leave them alone.
bool holds_together(const JointCase& joint, int dimensions) {
  if (joint.type == JointType::spring) return false;
  if (joint.type != JointType::six_dof) return true;
  const auto locked = [&](int axis) {
    const auto& limits = joint.six_limits[axis];
    return (dimensions == 2 && axis == 1) || (limits && (*limits)[0] == (*limits)[1]);
  };
  return locked(0) && locked(1) && locked(2);
}

/// The joint that holds two bodies; none.
const JointCase* joint_between(const Case& checked, int a, int b) {
  const std::string &first = checked.bodies[a - 1].name, &second = checked.bodies[b - 1].name;
  const auto holds = [&](const JointCase& joint) {
    return holds_together(joint, checked.dimensions) &&
           ((joint.child == first && joint.parent == second) || (joint.child == second && joint.parent == first));
  };
  const auto found = std::find_if(checked.joints.begin(), checked.joints.end(), holds);
  return found == checked.joints.end() ? nullptr : &*found;
}

/// Whether contacts do not keep two bodies apart.
bool pass_through(const Case& checked, int a, int b) {
  const BodyCase &first = checked.bodies[a - 1], &second = checked.bodies[b - 1];
  return first.rigid.collision == CollisionShape::none || second.rigid.collision == CollisionShape::none ||
         (first.motion != Motion::free && second.motion != Motion::free);
}

/// Facets in halves, across their longest side, until those that meet one of the boxes are small enough.
void cut(const Facet& facet, const std::vector<Box>& where, double longest, int dimensions, std::vector<Facet>& pieces) {
  const Box own = box_of(facet, dimensions);
  int side = 0;
  double length = 0;
  for (int k = 0; k < (dimensions == 2 ? 1 : 3); ++k) {
    const double found = (facet.corners[(k + 1) % 3] - facet.corners[k]).norm();
    if (found > length) {
      length = found;
      side = k;
    }
  }
  const bool near = std::any_of(where.begin(), where.end(), [&](const Box& box) { return meet(own, box, dimensions); });
  if (!near || length <= longest) {
    pieces.push_back(facet);
    return;
  }
  Facet halves[2] = {facet, facet};
  const int next = (side + 1) % 3;
  const Vector3d middle = 0.5 * (facet.corners[side] + facet.corners[next]);
  halves[0].corners[next] = middle;
  halves[1].corners[side] = middle;
  if (dimensions == 2) halves[0].corners[2] = middle;
  for (const Facet& half : halves) cut(half, where, longest, dimensions, pieces);
}

Vector3d middle_of(const Facet& facet, int dimensions) {
  if (dimensions == 2) return 0.5 * (facet.corners[0] + facet.corners[1]);
  return (facet.corners[0] + facet.corners[1] + facet.corners[2]) / 3;
}

}  // namespace

void find_intruding(const Case& checked, const std::vector<TriangleMesh>& meshes, const std::vector<int>& assemblies, Layout& layout) {
  const int dimensions = checked.dimensions;
  const double off = look_off * layout.spacing;
  std::map<int, SolidTest> solids;
  std::vector<std::vector<Box>> where(meshes.size());
  // `ahead`: how far before a wall, out of its body, one looks
  const auto lies_in = [&](int owner, int other, const Box& region, double ahead) {
    const SolidTest& solid = solids.try_emplace(other, meshes[other]).first->second;
    for (const Facet& facet : layout.facets) {
      if (facet.owner != owner || !meet(box_of(facet, dimensions), region, dimensions)) continue;
      std::vector<Facet> pieces;
      cut(facet, {region}, piece * layout.spacing, dimensions, pieces);
      for (const Facet& part : pieces) {
        Vector3d middle = middle_of(part, dimensions) - ahead * part.normal;
        if (dimensions == 2) middle.y() = 1e-3 * off;
        if (solid.holds(middle)) return true;
      }
    }
    return false;
  };
  for (std::size_t a = 1; a < meshes.size(); ++a)
    for (std::size_t b = a + 1; b < meshes.size(); ++b) {
      const int first = static_cast<int>(a), second = static_cast<int>(b);
      if (assemblies[a] == assemblies[b] || (!layout.moving[a] && !layout.moving[b])) continue;
      const JointCase* const joint = joint_between(checked, first, second);
      if (joint == nullptr && !pass_through(checked, first, second)) continue;
      const Box one = grown(meshes[a].bounding_box(), off), other = grown(meshes[b].bounding_box(), off);
      if (!meet(one, other, dimensions)) continue;
      const Box region = common(one, other);
      const double ahead = joint != nullptr ? off : -2 * off;  // what only touches, like a gate on its sill, stays whole
      if (!lies_in(first, second, region, ahead) && !lies_in(second, first, region, ahead)) continue;
      layout.intruding.emplace_back(first, second);
      layout.intruding.emplace_back(second, first);
      // A hinge turns what overlaps about a point in or beside it; nothing says how far a slider or a given motion leads.
      const bool turns = joint != nullptr && (joint->type == JointType::hinge || joint->type == JointType::ball);
      const double reach = turns ? (region.max - region.min).norm() + layout.spacing : 1e300;
      for (const std::size_t o : {a, b}) where[o].push_back(grown(region, reach));
    }
  if (layout.intruding.empty()) return;
  std::vector<double> area(meshes.size(), 0.0);
  for (const Facet& facet : layout.facets) {
    const Vector3d u = facet.corners[1] - facet.corners[0], v = facet.corners[2] - facet.corners[0];
    area[facet.owner] += dimensions == 2 ? u.norm() : 0.5 * u.cross(v).norm();
  }
  for (std::size_t f = 0; f < layout.facets.size(); ++f) {
    const Facet& facet = layout.facets[f];
    if (where[facet.owner].empty()) continue;
    double longest = piece * layout.spacing;
    const double least = dimensions == 2 ? area[facet.owner] / most_pieces : 2 * std::sqrt(area[facet.owner] / most_pieces);
    longest = std::max(longest, least);
    std::vector<Facet> pieces;
    cut(facet, where[facet.owner], longest, dimensions, pieces);
    for (const Facet& part : pieces) layout.pieces.push_back({static_cast<int>(f), part});
  }
}

}  // namespace wavetank

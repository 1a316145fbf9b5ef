#include "wall_contacts.h"

#include <BulletCollision/BroadphaseCollision/btDbvt.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "bullet_types.h"

namespace wavetank {
namespace {

constexpr double flat = 1e-6;  // sine of the angle below which two facets lie in one plane

btDbvtVolume volume_of(const Box& box) { return btDbvtVolume::FromMM(to_bullet(box.min), to_bullet(box.max)); }

struct Collector : btDbvt::ICollide {
  using btDbvt::ICollide::Process;
  void Process(const btDbvtNode* leaf) override { found.push_back(static_cast<int>(reinterpret_cast<std::intptr_t>(leaf->data))); }
  std::vector<int> found;
};

Box box_of(const std::vector<Vector3d>& points, double margin) {
  Box box{points.front(), points.front()};
  for (const Vector3d& point : points) {
    box.min = box.min.cwiseMin(point);
    box.max = box.max.cwiseMax(point);
  }
  box.min.array() -= margin;
  box.max.array() += margin;
  return box;
}

/// The middle of the shortest line between two lines.
Vector3d between(const Vector3d& p, const Vector3d& d, const Vector3d& q, const Vector3d& e) {
  const double dd = d.dot(d), de = d.dot(e), ee = e.dot(e), common = dd * ee - de * de;
  const Vector3d w = p - q;
  const double s = (de * e.dot(w) - ee * d.dot(w)) / common, t = (dd * e.dot(w) - de * d.dot(w)) / common;
  return 0.5 * (p + s * d + q + t * e);
}

}  // namespace

struct WallSurface::Tree {
  btDbvt leaves;
};

/// In which direction a hull and a facet come apart soonest.
struct WallSurface::Axis {
  Vector3d direction;        ///< from the wall to the hull
  double gap;                ///< m, along it
  int face = -1;             ///< of the hull, or
  int side = -1, edge = -1;  ///< of the facet and of the hull
};

PlacedHull::PlacedHull(const ConvexHull& shape, const Quaterniond& turn, const Vector3d& place)
    : hull(&shape), centre(turn * shape.centre + place) {
  const Eigen::Matrix3d matrix = turn.toRotationMatrix();
  for (const Vector3d& vertex : shape.vertices) vertices.push_back(matrix * vertex + place);
  for (const ConvexHull::Face& face : shape.faces) normals.push_back(matrix * face.normal);
  box = box_of(vertices, 0);
}

std::vector<Vector3d> cut_off(const std::vector<Vector3d>& polygon, const Vector3d& outwards, double offset) {
  std::vector<Vector3d> kept;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vector3d &from = polygon[k], &to = polygon[(k + 1) % polygon.size()];
    const double before = outwards.dot(from) - offset, after = outwards.dot(to) - offset;
    if (before <= 0) kept.push_back(from);
    if ((before < 0 && after > 0) || (before > 0 && after < 0)) kept.push_back(from + before / (before - after) * (to - from));
  }
  return kept;
}

bool WallSurface::Side::faces(const Vector3d& direction) const {
  return salient && direction.dot(outwards) > -flat && (!joined || direction.dot(other_outwards) > -flat);
}

WallSurface::WallSurface(const Layout& layout, const std::vector<int>& owners, int dimensions, double half_width)
    : dimensions_(dimensions), shallow_(0.05 * layout.spacing), tree_(std::make_unique<Tree>()) {
  for (const Facet& facet : layout.facets)
    if (std::find(owners.begin(), owners.end(), facet.owner) != owners.end()) add(facet, dimensions, half_width);
  for (std::size_t f = 0; f < facets_.size(); ++f)
    tree_->leaves.insert(volume_of(box_of(facets_[f].corners, 0)), reinterpret_cast<void*>(static_cast<std::intptr_t>(f)));
  join_sides(1e-4 * layout.spacing);
}

WallSurface::~WallSurface() = default;
WallSurface::WallSurface(WallSurface&&) noexcept = default;

void WallSurface::add(const Facet& facet, int dimensions, double half_width) {
  WallFacet added;
  added.normal = -facet.normal;
  added.offset = added.normal.dot(facet.plane_point);
  added.owner = facet.owner;
  if (dimensions == 2) {
    const Vector3d half(0, half_width, 0);
    added.corners = {facet.corners[0] - half, facet.corners[1] - half, facet.corners[1] + half, facet.corners[0] + half};
  } else {
    added.corners.assign(facet.corners, facet.corners + 3);
  }
  const Vector3d winding = (added.corners[1] - added.corners[0]).cross(added.corners[2] - added.corners[0]);
  if (winding.dot(added.normal) < 0) std::reverse(added.corners.begin(), added.corners.end());
  const std::size_t count = added.corners.size();
  for (std::size_t k = 0; k < count; ++k) {
    Side side;
    side.outwards = (added.corners[(k + 1) % count] - added.corners[k]).cross(added.normal).normalized();
    added.sides.push_back(side);
  }
  facets_.push_back(added);
}

/// Finds for every side the facets that meet it at its middle.
void WallSurface::join_sides(double tolerance) {
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    WallFacet& facet = facets_[f];
    for (std::size_t k = 0; k < facet.sides.size(); ++k) {
      Side& side = facet.sides[k];
      const Vector3d along = (facet.corners[(k + 1) % facet.corners.size()] - facet.corners[k]).normalized();
      const Vector3d middle = 0.5 * (facet.corners[k] + facet.corners[(k + 1) % facet.corners.size()]);
      if (dimensions_ == 2 && std::abs(along.y()) < 0.5) side.salient = false;  // a strip's ends are far off
      for (const int o : overlapping(box_of({middle}, tolerance))) {
        const WallFacet& other = facets_[o];
        if (o == static_cast<int>(f) || std::abs(other.normal.dot(middle) - other.offset) > tolerance) continue;
        for (std::size_t j = 0; j < other.sides.size(); ++j) {
          const Vector3d &from = other.corners[j], &to = other.corners[(j + 1) % other.corners.size()];
          const Vector3d line = (to - from).normalized();
          const double place = line.dot(middle - from);
          if (place < -tolerance || place > (to - from).norm() + tolerance || (middle - from - place * line).norm() > tolerance) continue;
          if (std::abs(line.dot(along)) < 0.9) continue;
          const double rise = -facet.normal.dot(other.sides[j].outwards);  // of the other facet, as it leads away from the side
          if (rise > -flat && (rise > flat || other.normal.dot(facet.normal) > 0)) side.salient = false;
          side.joined = true;
          side.other_outwards = other.sides[j].outwards;
        }
      }
      facet.any_salient = facet.any_salient || side.salient;
    }
  }
}

std::vector<int> WallSurface::overlapping(const Box& box) const {
  Collector collector;
  tree_->leaves.collideTV(tree_->leaves.m_root, volume_of(box), collector);
  std::sort(collector.found.begin(), collector.found.end());
  return std::move(collector.found);
}

void WallSurface::find(const PlacedHull& hull, double reach, std::vector<WallContact>& contacts) const {
  Box box = hull.box;
  box.min.array() -= reach;
  box.max.array() += reach;
  for (const int f : overlapping(box)) find_at(facets_[f], hull, reach, contacts);
}

/// Against the hull's faces; false if one has the facet wholly before it.
bool WallSurface::search_faces(const WallFacet& facet, const PlacedHull& hull, double reach, Axis& best) const {
  for (std::size_t f = 0; f < hull.normals.size(); ++f) {
    const Vector3d& normal = hull.normals[f];
    if (dimensions_ == 2 && std::abs(normal.y()) > 0.5) continue;
    const double offset = normal.dot(hull.vertices[hull.hull->faces[f].loop[0]]);
    double gap = std::numeric_limits<double>::infinity();
    for (const Vector3d& corner : facet.corners) gap = std::min(gap, normal.dot(corner) - offset);
    if (gap > reach) return false;
    if (gap <= best.gap) continue;
    for (const Side& side : facet.sides) {
      if (!side.faces(-normal)) continue;
      best = {-normal, gap, static_cast<int>(f), -1, -1};
      break;
    }
  }
  return true;
}

/// Sides against the hull's edges, those pairs only that can be what touches first.
bool WallSurface::search_edges(const WallFacet& facet, const PlacedHull& hull, double reach, Axis& best) const {
  for (std::size_t s = 0; s < facet.sides.size(); ++s) {
    if (!facet.sides[s].salient) continue;
    const Vector3d& corner = facet.corners[s];
    const Vector3d along = (facet.corners[(s + 1) % facet.corners.size()] - corner).normalized();
    for (std::size_t e = 0; e < hull.hull->edges.size(); ++e) {
      const ConvexHull::Edge& edge = hull.hull->edges[e];
      const Vector3d line = hull.vertices[edge.to] - hull.vertices[edge.from];
      const Vector3d &left = hull.normals[edge.left], &right = hull.normals[edge.right];
      const Vector3d axis = along.cross(line);
      // Only few edges touch first along ±axis: those with it between their faces' normals. They are sorted out before all else.
      const double to_left = left.dot(axis), to_right = right.dot(axis), cosine = left.dot(right);
      for (const double sign : {1.0, -1.0}) {
        if (sign * (to_right - cosine * to_left) > 0 || sign * (to_left - cosine * to_right) > 0) continue;
        const double size = axis.norm();
        if (size < 1e-3 * line.norm()) continue;  // parallel: a face's normal does
        const Vector3d direction = sign / size * axis;
        if (!facet.sides[s].faces(direction)) continue;
        const double gap = direction.dot(hull.vertices[edge.from] - corner);
        if (gap > reach) return false;
        if (gap > best.gap + 1e-3 * shallow_) best = {direction, gap, -1, static_cast<int>(s), static_cast<int>(e)};
      }
    }
  }
  return true;
}

void WallSurface::find_at(const WallFacet& facet, const PlacedHull& hull, double reach, std::vector<WallContact>& contacts) const {
  if (facet.normal.dot(hull.centre) <= facet.offset) return;
  std::size_t lowest = 0;
  double gap = std::numeric_limits<double>::infinity();
  for (std::size_t v = 0; v < hull.vertices.size(); ++v) {
    const double height = facet.normal.dot(hull.vertices[v]) - facet.offset;
    if (height < gap) {
      gap = height;
      lowest = v;
    }
  }
  if (gap > reach) return;
  Axis axis{facet.normal, gap, -1, -1, -1};
  if (-gap > shallow_ && facet.any_salient && (!search_faces(facet, hull, reach, axis) || !search_edges(facet, hull, reach, axis))) return;

  const auto add = [&](const Vector3d& point, double at) { contacts.push_back({point, axis.direction, at, facet.owner}); };
  if (axis.edge >= 0) {
    const ConvexHull::Edge& edge = hull.hull->edges[axis.edge];
    const Vector3d& corner = facet.corners[axis.side];
    add(between(corner, facet.corners[(axis.side + 1) % facet.corners.size()] - corner, hull.vertices[edge.from],
                hull.vertices[edge.to] - hull.vertices[edge.from]),
        axis.gap);
  } else if (axis.face >= 0) {
    const std::vector<int>& loop = hull.hull->faces[axis.face].loop;
    std::vector<Vector3d> polygon = facet.corners;
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Vector3d &from = hull.vertices[loop[k]], &to = hull.vertices[loop[(k + 1) % loop.size()]];
      const Vector3d outwards = (to - from).cross(hull.normals[axis.face]);
      polygon = cut_off(polygon, outwards, outwards.dot(from));
    }
    const double offset = axis.direction.dot(hull.vertices[loop[0]]);
    for (const Vector3d& point : polygon)
      if (offset - axis.direction.dot(point) <= reach) add(point, offset - axis.direction.dot(point));
  } else {
    int face = hull.hull->faces_at[lowest].front();
    for (const int candidate : hull.hull->faces_at[lowest])
      if (hull.normals[candidate].dot(facet.normal) < hull.normals[face].dot(facet.normal)) face = candidate;
    std::vector<Vector3d> polygon;
    for (const int corner : hull.hull->faces[face].loop) polygon.push_back(hull.vertices[corner]);
    for (std::size_t k = 0; k < facet.sides.size(); ++k)
      polygon = cut_off(polygon, facet.sides[k].outwards, facet.sides[k].outwards.dot(facet.corners[k]));
    for (const Vector3d& point : polygon)
      if (facet.normal.dot(point) - facet.offset <= reach) add(point, facet.normal.dot(point) - facet.offset);
  }
}

}  // namespace wavetank

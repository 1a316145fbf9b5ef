#include "barriers.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>

#include "wall_cells.h"

namespace wavetank {

namespace {

/// A flat convex part of a thin wall: a facet, or two of one plane that make up a quadrangle.
struct Barrier {
  Facet facet;                    ///< the first; its corners turn left about its normal
  std::optional<Facet> other;     ///< the second
  std::vector<Vector3d> corners;  ///< all around; in 2-D both ends
};

/// The corners of both facets around, if they lie in one plane, side by side, and nothing turns inwards.
std::optional<std::vector<Vector3d>> quadrangle(const Facet& a, const Facet& b) {
  if (a.owner != b.owner || a.normal != b.normal || a.plane_point != b.plane_point) return {};
  for (int k = 0; k < 3; ++k)
    for (int l = 0; l < 3; ++l) {
      if (a.corners[k] != b.corners[(l + 1) % 3] || a.corners[(k + 1) % 3] != b.corners[l]) continue;
      std::vector<Vector3d> corners = {a.corners[k], b.corners[(l + 2) % 3], a.corners[(k + 1) % 3], a.corners[(k + 2) % 3]};
      for (int m = 0; m < 4; ++m) {
        const Vector3d edge = corners[(m + 1) % 4] - corners[m], next = corners[(m + 2) % 4] - corners[(m + 1) % 4];
        if (edge.cross(next).dot(a.normal) < 1e-6 * edge.norm() * next.norm()) return {};
      }
      return corners;
    }
  return {};
}

/// Every plane costs all ways near it: what meshes have as pairs of triangles, one after the other, is looked past as one.
std::vector<Barrier> barriers_of(const std::vector<Facet>& plates, int dimensions) {
  std::vector<Barrier> barriers;
  for (const Facet& given : plates) {
    const Facet facet = turned_left(given, dimensions);
    if (dimensions == 3 && !barriers.empty() && !barriers.back().other) {
      if (const auto corners = quadrangle(barriers.back().facet, facet)) {
        barriers.back().other = facet;
        barriers.back().corners = *corners;
        continue;
      }
    }
    barriers.push_back({facet, {}, {facet.corners, facet.corners + dimensions}});
  }
  return barriers;
}

CellOrder barriers_by_cell(const std::vector<Barrier>& barriers, const Discretisation& d) {
  CellPairs pairs;
  for (std::size_t k = 0; k < barriers.size(); ++k) {
    add_cells_of(barriers[k].facet, static_cast<int>(k), 0.0, d, pairs);
    if (barriers[k].other) add_cells_of(*barriers[k].other, static_cast<int>(k), 0.0, d, pairs);
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return lists_of(std::move(pairs), d);
}

/// As neighbours.cl has barriers: where there are fewer edges, the first ones again.
template <class Real>
std::vector<Real> plane_values(const std::vector<Barrier>& barriers, const Discretisation& d) {
  const double margin = 1e-4 * d.spacing;  // no gap between two that meet
  std::vector<Real> values;
  const auto add_plane = [&](const Vector3d& normal, const Vector3d& point, double offset) {
    for (int axis = 0; axis < 3; ++axis) values.push_back(static_cast<Real>(normal[axis]));
    values.push_back(static_cast<Real>(offset - normal.dot(point - d.origin)));
  };
  for (const Barrier& barrier : barriers) {
    const Facet& facet = barrier.facet;
    const int count = static_cast<int>(barrier.corners.size());
    add_plane(facet.normal, facet.plane_point, 0.0);
    for (int k = 0; k < field::barrier_edges; ++k) {
      const Vector3d& corner = barrier.corners[k % count];
      const Vector3d edge = barrier.corners[(k + 1) % count] - corner;
      add_plane(d.dimensions == 2 ? edge.normalized() : facet.normal.cross(edge).normalized(), corner, margin);
    }
    values.push_back(static_cast<Real>(facet.owner));
  }
  return values;
}

// of the spacing: water passes between a free edge and another owner's wall that is farther than the second from it, and not below the
// first
constexpr double closed_gap = 0.5, open_gap = 1.0;

// of the support: how far from a free edge the water on one side of a thin wall may feel that on the other (neighbours.cl)
constexpr double edge_reach = 1.5;

/// How far an edge is from other owners' walls, up to `reach`: the greatest of some places along it, since water passes where it is open.
double gap_at(const FreeEdge& edge, const std::vector<Facet>& walls, int dimensions, double reach) {
  Eigen::AlignedBox3d about(edge.from);
  about.extend(edge.to);
  about.min().array() -= reach;
  about.max().array() += reach;
  const double parts[] = {0.1, 0.5, 0.9};
  double gaps[] = {reach, reach, reach};
  for (const Facet& wall : walls) {
    if (wall.owner == edge.owner) continue;
    Eigen::AlignedBox3d box(wall.corners[0]);
    for (int k = 1; k < dimensions; ++k) box.extend(wall.corners[k]);
    if (!box.intersects(about)) continue;
    for (int k = 0; k < 3; ++k) {
      const Vector3d place = edge.from + parts[k] * (edge.to - edge.from);
      const Vector3d nearest = nearest_on_triangle(place, wall.corners[0], wall.corners[1], wall.corners[dimensions == 2 ? 1 : 2]);
      gaps[k] = std::min(gaps[k], (nearest - place).norm());
    }
  }
  return *std::max_element(gaps, gaps + 3);
}

/// As neighbours.cl has free edges.
template <class Real>
std::vector<Real> edge_values(const std::vector<FreeEdge>& edges, const std::vector<Facet>& walls, const Discretisation& d) {
  std::vector<Real> values;
  const auto add = [&](const Vector3d& vector) {
    for (int axis = 0; axis < 3; ++axis) values.push_back(static_cast<Real>(vector[axis]));
  };
  for (const FreeEdge& edge : edges) {
    const double length = (edge.to - edge.from).norm();
    const double gap = gap_at(edge, walls, d.dimensions, open_gap * d.spacing) / d.spacing;
    add(edge.from - d.origin);
    add(d.dimensions == 2 ? Vector3d::UnitY() : Vector3d((edge.to - edge.from) / length));
    values.push_back(static_cast<Real>(length));
    values.push_back(static_cast<Real>(std::clamp((gap - closed_gap) / (open_gap - closed_gap), 0.0, 1.0)));
  }
  return values;
}

/// The cells from which an edge is within reach.
CellOrder edges_by_cell(const std::vector<FreeEdge>& edges, const Discretisation& d) {
  CellPairs pairs;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    Facet along;
    along.corners[0] = edges[e].from;
    along.corners[1] = along.corners[2] = edges[e].to;
    add_cells_of(along, static_cast<int>(e), (edge_reach - 1) * d.support, d, pairs);
  }
  return lists_of(std::move(pairs), d);
}

}  // namespace

template <class Real>
void Barriers<Real>::place(const compute::Device& device, const std::vector<Facet>& plates, const std::vector<FreeEdge>& free_edges,
                           const std::vector<Facet>& walls, const Discretisation& d) {
  const std::vector<Barrier> barriers = barriers_of(plates, d.dimensions);
  const CellOrder cells = barriers_by_cell(barriers, d), edge_cells = edges_by_cell(free_edges, d);
  starts.set(device, cells.begin);
  list.set(device, cells.order);
  planes.set(device, plane_values<Real>(barriers, d));
  edge_starts.set(device, edge_cells.begin);
  edge_list.set(device, edge_cells.order);
  edges.set(device, edge_values<Real>(free_edges, walls, d));
}

std::vector<Facet> moved(std::vector<Facet> facets, const std::vector<WallPose>& poses) {
  for (Facet& facet : facets) {
    const WallPose& pose = poses[facet.owner];
    for (Vector3d& corner : facet.corners) corner = pose.of(corner);
    facet.normal = pose.rotation * facet.normal;
    facet.plane_point = pose.of(facet.plane_point);
  }
  return facets;
}

std::vector<FreeEdge> moved(std::vector<FreeEdge> edges, const std::vector<WallPose>& poses) {
  for (FreeEdge& edge : edges) {
    edge.from = poses[edge.owner].of(edge.from);
    edge.to = poses[edge.owner].of(edge.to);
  }
  return edges;
}

template struct Barriers<float>;
template struct Barriers<double>;

}  // namespace wavetank

#include "barriers.h"

#include <Eigen/Geometry>

#include "wall_cells.h"

namespace wavetank {

namespace {

/// As neighbours.cl has barriers.
template <class Real>
std::vector<Real> plane_values(const std::vector<Facet>& facets, const Discretisation& d) {
  const double margin = 1e-4 * d.spacing;  // no gap between two that meet
  std::vector<Real> values;
  const auto add_plane = [&](const Vector3d& normal, const Vector3d& point, double offset) {
    for (int axis = 0; axis < 3; ++axis) values.push_back(static_cast<Real>(normal[axis]));
    values.push_back(static_cast<Real>(offset - normal.dot(point - d.origin)));
  };
  for (const Facet& given : facets) {
    const Facet facet = turned_left(given, d.dimensions);
    add_plane(facet.normal, facet.plane_point, 0.0);
    for (int k = 0; k < 3; ++k) {
      if (d.dimensions == 2) {  // the two ends, the second of them twice
        const Vector3d way = (facet.corners[1] - facet.corners[0]).normalized();
        add_plane(k == 0 ? way : Vector3d(-way), facet.corners[k == 0 ? 0 : 1], margin);
        continue;
      }
      const Vector3d edge = facet.corners[(k + 1) % 3] - facet.corners[k];
      add_plane(facet.normal.cross(edge).normalized(), facet.corners[k], margin);
    }
  }
  return values;
}

/// As brim.cl has brims.
template <class Real>
std::vector<Real> brim_values(const std::vector<Brim>& brims, const Discretisation& d) {
  std::vector<Real> values;
  const auto add = [&](const Vector3d& vector) {
    for (int axis = 0; axis < 3; ++axis) values.push_back(static_cast<Real>(vector[axis]));
  };
  for (const Brim& brim : brims) {
    const double length = (brim.to - brim.from).norm();
    const std::size_t end = values.size() + field::brim_count;
    add(brim.from - d.origin);
    add(d.dimensions == 2 ? Vector3d::UnitY() : Vector3d((brim.to - brim.from) / length));
    values.push_back(static_cast<Real>(length));
    add(brim.face_normal);
    add(brim.inwards);
    add(brim.has_other ? brim.other_normal : Vector3d::Zero());
    values.push_back(brim.has_other ? Real(1) : Real(0));
    values.resize(end, Real(0));
  }
  return values;
}

/// Without an area, for their cells.
std::vector<Facet> facets_along(const std::vector<Brim>& brims) {
  std::vector<Facet> facets(brims.size());
  for (std::size_t b = 0; b < brims.size(); ++b) {
    facets[b].corners[0] = brims[b].from;
    facets[b].corners[1] = facets[b].corners[2] = brims[b].to;
  }
  return facets;
}

}  // namespace

template <class Real>
Barriers<Real>::Barriers(const compute::Device& device, const std::vector<Facet>& facets, const std::vector<Brim>& edges,
                         const Discretisation& d) {
  place(device, facets, edges, d);
}

template <class Real>
void Barriers<Real>::place(const compute::Device& device, const std::vector<Facet>& facets, const std::vector<Brim>& edges,
                           const Discretisation& d) {
  const CellOrder cells = facets_by_cell(facets, d), brim_cells = facets_by_cell(facets_along(edges), d);
  starts.set(device, cells.begin);
  list.set(device, cells.order);
  planes.set(device, plane_values<Real>(facets, d));
  brim_starts.set(device, brim_cells.begin);
  brim_list.set(device, brim_cells.order);
  brims.set(device, brim_values<Real>(edges, d));
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

std::vector<Brim> moved(std::vector<Brim> brims, const std::vector<WallPose>& poses) {
  for (Brim& brim : brims) {
    const WallPose& pose = poses[brim.owner];
    brim.from = pose.of(brim.from);
    brim.to = pose.of(brim.to);
    for (Vector3d* vector : {&brim.face_normal, &brim.inwards, &brim.other_normal}) *vector = pose.rotation * *vector;
  }
  return brims;
}

template struct Barriers<float>;
template struct Barriers<double>;

}  // namespace wavetank

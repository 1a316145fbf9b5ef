#include "planar_regions.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "mesh_topology.h"

namespace wavetank {
namespace {

constexpr double flat_distance = 2e-6;  // of the mesh's size: the resolution of float32 coordinates
constexpr double flat_cosine = 0.9995;  // slivers have poor normals, so their corners' distance decides
constexpr double curved_cosine = 0.94;  // facets that meet at less than 20° belong to a curved wall

/// The same direction whatever the sense in which an edge is given: the first component that is not small is positive.
Vector3d without_sense(const Vector3d& direction) {
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(direction[axis]) > 1e-6) return direction[axis] > 0 ? direction : Vector3d(-direction);
  }
  return direction;
}

bool comes_before(const Vector3d& a, const Vector3d& b) {
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(a[axis] - b[axis]) > 1e-6) return a[axis] > b[axis];
  }
  return false;
}

class Grouping {
 public:
  explicit Grouping(const TriangleMesh& mesh) : mesh_(mesh), across_(neighbours_of(mesh)), region_(mesh.triangles.size(), -1) {
    const Box box = mesh.bounding_box();
    tolerance_ = flat_distance * (box.max - box.min).norm();
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      vector_area_.push_back(0.5 * (mesh.corner(t, 1) - mesh.corner(t, 0)).cross(mesh.corner(t, 2) - mesh.corner(t, 0)));
    }
  }

  std::vector<PlanarRegion> regions() {
    // From the largest triangle on: its normal is the surest.
    std::vector<int> order(mesh_.triangles.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [this](int a, int b) { return vector_area_[a].squaredNorm() > vector_area_[b].squaredNorm(); });
    std::vector<std::vector<int>> members;
    for (const int seed : order) {
      if (region_[seed] < 0) members.push_back(grow(seed, static_cast<int>(members.size())));
    }
    std::vector<PlanarRegion> result;
    result.reserve(members.size());
    for (const std::vector<int>& triangles : members) result.push_back(make(triangles));
    return result;
  }

 private:
  std::vector<int> grow(int seed, int number) {
    const Vector3d normal = vector_area_[seed].normalized(), point = mesh_.corner(seed, 0);
    std::vector<int> members = {seed};
    region_[seed] = number;
    for (std::size_t next = 0; next < members.size(); ++next) {
      for (int k = 0; k < 3; ++k) {
        const int other = across_[members[next]][k];
        if (other < 0 || region_[other] >= 0 || std::abs(vector_area_[other].normalized().dot(normal)) < flat_cosine) continue;
        bool flat = true;
        for (int c = 0; c < 3; ++c) flat = flat && std::abs(normal.dot(mesh_.corner(other, c) - point)) <= tolerance_;
        if (!flat) continue;
        region_[other] = number;
        members.push_back(other);
      }
    }
    return members;
  }

  PlanarRegion make(const std::vector<int>& members) const {
    PlanarRegion region;
    const Vector3d first = vector_area_[members.front()].normalized();
    Vector3d sum = Vector3d::Zero();
    double longest = 0;
    for (const int t : members) {
      sum += vector_area_[t].dot(first) < 0 ? Vector3d(-vector_area_[t]) : vector_area_[t];
      for (int k = 0; k < 3; ++k) {
        const int other = across_[t][k];
        if (other >= 0 && region_[other] == region_[t]) continue;
        region.curved = region.curved || (other >= 0 && std::abs(vector_area_[other].normalized().dot(first)) > curved_cosine);
        const Vector3d edge = mesh_.corner(t, (k + 1) % 3) - mesh_.corner(t, k);
        const Vector3d direction = without_sense(edge.normalized());
        const bool longer = edge.norm() > longest * (1 + 1e-6);
        const bool as_long = edge.norm() > longest * (1 - 1e-6);
        if (longer || (as_long && comes_before(direction, region.along))) region.along = direction;
        longest = std::max(longest, edge.norm());
      }
    }
    const Vector3d normal = without_sense(sum.normalized());
    if (longest == 0) region.along = mesh_.corner(members.front(), 1) - mesh_.corner(members.front(), 0);  // has no outer edge
    region.along = (region.along - normal.dot(region.along) * normal).normalized();
    region.across = normal.cross(region.along);
    region.origin = mesh_.corner(members.front(), 0);
    region.area = sum.norm();
    flatten(members, region);
    return region;
  }

  void flatten(const std::vector<int>& members, PlanarRegion& region) const {
    region.min.setConstant(std::numeric_limits<double>::infinity());
    region.max = -region.min;
    for (const int t : members) {
      FlatTriangle flat;
      for (int k = 0; k < 3; ++k) {
        const Vector3d offset = mesh_.corner(t, k) - region.origin;
        flat[k] = {region.along.dot(offset), region.across.dot(offset)};
        region.min = region.min.cwiseMin(flat[k]);
        region.max = region.max.cwiseMax(flat[k]);
      }
      const Eigen::Vector2d p = flat[1] - flat[0], q = flat[2] - flat[0];
      if (p.x() * q.y() - p.y() * q.x() < 0) std::swap(flat[1], flat[2]);
      region.triangles.push_back(flat);
    }
  }

  const TriangleMesh& mesh_;
  Neighbours across_;
  std::vector<int> region_;
  std::vector<Vector3d> vector_area_;
  double tolerance_ = 0;
};

}  // namespace

bool PlanarRegion::is_rectangle() const {
  const Eigen::Vector2d size = max - min;
  return std::abs(size.x() * size.y() - area) <= 1e-5 * size.x() * size.y();
}

std::vector<PlanarRegion> planar_regions(const TriangleMesh& mesh) { return Grouping(mesh).regions(); }

}  // namespace wavetank

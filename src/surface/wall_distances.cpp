#include "wall_distances.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wavetank {
namespace {

constexpr double same_distance = 1e-6;  ///< of a cell: two facets are so near to a node that either is the nearest

}  // namespace

WallDistances::WallDistances(const std::vector<Facet>& facets, int owner, int dimensions, const NodeGrid& grid)
    : dimensions_(dimensions), grid_(grid), distances_(reach), steepness_(0) {
  box_.min.setConstant(std::numeric_limits<double>::infinity());
  box_.max = -box_.min;
  for (const Facet& facet : facets)
    if (facet.owner == owner) add(facet);
}

void WallDistances::add(const Facet& facet) {
  const Vector3d &a = facet.corners[0], &b = facet.corners[1], &c = dimensions_ == 2 ? b : facet.corners[2];
  const Vector3d margin = dimensions_ == 2 ? Vector3d(reach * grid_.cell, 0, reach * grid_.cell) : Vector3d::Constant(reach * grid_.cell);
  const Vector3d least = a.cwiseMin(b).cwiseMin(c) - margin, most = a.cwiseMax(b).cwiseMax(c) + margin;
  box_.min = box_.min.cwiseMin(least);
  box_.max = box_.max.cwiseMax(most);
  const Vector3d first = grid_.in_cells(least).array().ceil(), last = grid_.in_cells(most).array().floor();
  Node node;
  for (node[0] = static_cast<int>(first.x()); node[0] <= last.x(); ++node[0])
    for (node[1] = static_cast<int>(first.y()); node[1] <= last.y(); ++node[1])
      for (node[2] = static_cast<int>(first.z()); node[2] <= last.z(); ++node[2]) {
        const Vector3d place = grid_.place(node);
        if (std::abs(facet.normal.dot(place - a)) > reach * grid_.cell) continue;
        const Vector3d way = place - nearest_on_triangle(place, a, b, c);
        const double distance = way.norm() / grid_.cell;
        if (distance >= reach) continue;
        float &known = distances_[node], &steepness = steepness_[node];
        const double nearest = std::abs(known);
        if (distance > nearest + same_distance) continue;
        // At an edge that facets share, the one that the node is most over or under tells on which side it is. Of the two sides of a sheet
        // without thickness both are in the water.
        const double over = -facet.normal.dot(way) / grid_.cell, steep = std::abs(over);
        const bool as_near = distance >= nearest - same_distance;
        if (as_near && steep < steepness - same_distance) continue;
        if (as_near && steep <= steepness + same_distance && known >= 0) continue;
        known = static_cast<float>(over < 0 ? -distance : distance);
        steepness = static_cast<float>(steep);
      }
}

float WallDistances::at(const Vector3d& place) const {
  const Vector3d where = grid_.in_cells(place);
  const Vector3d low = where.array().floor();
  const Vector3d part = where - low;
  float sum = 0;
  for (int k = 0; k < 8; ++k) {
    const int far[3] = {k & 1, k >> 1 & 1, k >> 2 & 1};
    double weight = 1;
    Node node;
    for (int axis = 0; axis < 3; ++axis) {
      weight *= far[axis] != 0 ? part[axis] : 1 - part[axis];
      node[axis] = static_cast<int>(low[axis]) + far[axis];
    }
    if (weight > 0) sum += static_cast<float>(weight) * at(node);
  }
  return sum;
}

}  // namespace wavetank

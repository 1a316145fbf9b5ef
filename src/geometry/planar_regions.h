#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "wavetank/geometry/mesh.h"

namespace wavetank {

using FlatTriangle = std::array<Eigen::Vector2d, 3>;

/// Adjacent triangles of a mesh that lie in one plane.
struct PlanarRegion {
  std::vector<FlatTriangle> triangles;  ///< corners in plane coordinates (along, across), all turned the same way
  Vector3d origin, along, across;       ///< the plane's frame: along the region's longest outer edge; m and unit vectors
  Eigen::Vector2d min, max;             ///< bounding rectangle in plane coordinates, m
  double area = 0;                      ///< of the region's triangles, m²
  bool curved = false;                  ///< goes on smoothly in a neighbouring region: a facet of a curved wall

  bool is_rectangle() const;
};

/// All regions of the mesh; each triangle is in exactly one. The order depends on the mesh alone.
std::vector<PlanarRegion> planar_regions(const TriangleMesh& mesh);

}  // namespace wavetank

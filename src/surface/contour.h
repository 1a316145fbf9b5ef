#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

namespace wavetank {

/// A node of a grid and a value there: positive in the water.
struct NodeValue {
  std::array<int, 3> node;
  float value = 0;
};

/// In the grid's own lengths, node by node.
struct Contour {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::array<int, 3>> triangles;  ///< anticlockwise seen from where values are negative
};

bool can_contour();

/// Where the values pass through 0; all nodes that are not listed have the value `elsewhere`, below 0. Of more triangles than that it is
/// made coarser where it is flat, as far as that goes.
Contour contour(const std::vector<NodeValue>& values, float elsewhere, std::size_t most_triangles);

}  // namespace wavetank

#pragma once

#include <vector>

#include "node_values.h"
#include "wavetank/geometry/layout.h"
#include "wavetank/rigid/rigid_state.h"

namespace wavetank {

/// How far nodes of a grid are from the walls of one owner, as the layout has them; negative behind them, out of the water.
class WallDistances {
 public:
  /// In the grid's cells, beyond which nothing is known, and all counts as so far out in the open.
  static constexpr float reach = 4;

  WallDistances(const std::vector<Facet>& facets, int owner, int dimensions, const NodeGrid& grid);

  /// In cells.
  float at(const Node& node) const { return distances_.at(node); }
  /// Between nodes.
  float at(const Vector3d& place) const;
  /// About all that is within reach of the walls, m; empty (min > max) without walls.
  const Box& box() const { return box_; }

 private:
  void add(const Facet& facet);

  int dimensions_;
  NodeGrid grid_;
  NodeValues<float> distances_;
  NodeValues<float> steepness_;  ///< of the distance found: how far the node is from the plane of that facet, in cells
  Box box_;
};

}  // namespace wavetank

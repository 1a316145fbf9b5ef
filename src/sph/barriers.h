#pragma once

#include <vector>

#include "kept_buffer.h"
#include "moving_walls.h"
#include "wavetank/geometry/thin_walls.h"

namespace wavetank {

/// Thin walls on the device, that the water does not see through but about their free edges.
template <class Real>
struct Barriers {
  Barriers() = default;
  /// `plates`: the thin ones of `walls`, which are all of them. All where they are now.
  void place(const compute::Device& device, const std::vector<Facet>& plates, const std::vector<FreeEdge>& edges,
             const std::vector<Facet>& walls, const Discretisation& discretisation);

  KeptBuffer<int> starts, list;  ///< by cell
  KeptBuffer<Real> planes;       ///< field::barrier_count values each
  KeptBuffer<int> edge_starts, edge_list;
  KeptBuffer<Real> edges;  ///< field::free_edge_count values each
};

/// Where poses, one an owner, take thin walls.
std::vector<Facet> moved(std::vector<Facet> facets, const std::vector<WallPose>& poses);
std::vector<FreeEdge> moved(std::vector<FreeEdge> edges, const std::vector<WallPose>& poses);

}  // namespace wavetank

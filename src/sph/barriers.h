#pragma once

#include <vector>

#include "kept_buffer.h"
#include "moving_walls.h"
#include "wavetank/geometry/thin_walls.h"

namespace wavetank {

/// Thin walls on the device, that the water does not see through.
template <class Real>
struct Barriers {
  Barriers() = default;
  Barriers(const compute::Device& device, const std::vector<Facet>& facets, const std::vector<Brim>& brims,
           const Discretisation& discretisation);

  /// Facets and brims may have moved since.
  void place(const compute::Device& device, const std::vector<Facet>& facets, const std::vector<Brim>& brims,
             const Discretisation& discretisation);

  KeptBuffer<int> starts, list;  ///< by cell
  KeptBuffer<Real> planes;       ///< field::barrier_count values each
  KeptBuffer<int> brim_starts, brim_list;
  KeptBuffer<Real> brims;  ///< field::brim_count values each
};

/// Where poses, one an owner, take thin walls.
std::vector<Facet> moved(std::vector<Facet> facets, const std::vector<WallPose>& poses);
std::vector<Brim> moved(std::vector<Brim> brims, const std::vector<WallPose>& poses);

}  // namespace wavetank

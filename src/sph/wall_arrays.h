#pragma once

#include <vector>

#include "kernel_parameters.h"
#include "wavetank/compute/buffer.h"
#include "wavetank/geometry/layout.h"

namespace wavetank {

/// Wall elements sorted by the neighbour grid's cells, on the device. Walls that stand still are sorted once.
template <class Real>
struct WallArrays {
  WallArrays() = default;
  WallArrays(const compute::Device& device, const std::vector<WallElement>& elements, const Discretisation& discretisation);

  int count = 0;
  int stride = 0;
  std::vector<int> owner;        ///< of each element, in the device's order
  compute::Buffer<Real> fields;  ///< field::wall_count fields
  compute::Buffer<int> starts;   ///< of each cell, one more than cells
};

/// The elements of each owner, in chunks that one work-item sums.
template <class Real>
struct WallOwners {
  WallOwners() = default;
  WallOwners(const compute::Device& device, const WallArrays<Real>& walls, const std::vector<Eigen::Vector3d>& centres,
             const Discretisation& discretisation);

  int owners = 0;
  int chunks = 0;
  compute::Buffer<int> members;      ///< element indices by owner
  compute::Buffer<int> chunk_range;  ///< two a chunk: from, to in members
  compute::Buffer<int> chunk_owner;
  compute::Buffer<int> owner_chunks;  ///< owners + 1
  compute::Buffer<Real> centres;      ///< x y z an owner, relative to the grid's origin
  compute::Buffer<Real> partial, total;
};

}  // namespace wavetank

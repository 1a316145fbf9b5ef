#pragma once

#include <vector>

#include "tables/device_sizes.h"
#include "wavetank/compute/buffer.h"
#include "wavetank/geometry/thin_walls.h"
#include "wavetank/sph/discretisation.h"

namespace wavetank {

/// What the walls are made of on the device: elements of about the spacing, sorted by cells of side R, or facets of any size, of
/// which each cell has a list.
enum class WallKind { rectangles, triangles, facets };

/// Walls on the device, as the case's geometry has them.
template <class Real>
struct WallArrays {
  WallArrays() = default;
  WallArrays(const compute::Device& device, const std::vector<WallElement>& rectangles, const std::vector<Thin>& thin,
             const Discretisation& discretisation);
  /// `kind`: triangles or facets. `pieces`: of those facets that may be hidden in part; they follow the facets, and no list has them yet.
  WallArrays(const compute::Device& device, const std::vector<Facet>& facets, const std::vector<FacetPiece>& pieces,
             const std::vector<Thin>& thin, WallKind kind, const Discretisation& discretisation);

  WallKind kind = WallKind::facets;
  int count = 0;
  int stride = 0;                ///< from a field to the next; of facets, from a facet to the next
  compute::Buffer<Real> fields;  ///< field::wall_… has them, for the kind
  compute::Buffer<int> starts;   ///< of each cell, one more than cells: in the fields, or in the list
  compute::Buffer<int> list;     ///< of facets by cell
  std::vector<Facet> shapes;     ///< at rest, in the fields' order; of rectangles the centre alone
};

/// Corners in the order in which they turn left about the normal.
Facet turned_left(Facet facet, int dimensions);

}  // namespace wavetank

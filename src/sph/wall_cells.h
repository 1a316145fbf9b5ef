#pragma once

#include <utility>
#include <vector>

#include "wavetank/geometry/layout.h"
#include "wavetank/sph/discretisation.h"

namespace wavetank {

/// Things in the order of their cells, and where each cell's begin (one more than there are cells).
struct CellOrder {
  std::vector<int> order, begin;
};

/// Elements by the cell of their centre; those of one cell stay in their order.
CellOrder sorted_by_cell(const std::vector<Vector3d>& centres, const Discretisation& discretisation);

using CellPairs = std::vector<std::pair<int, int>>;  ///< cell, facet

/// Adds, for facet number `index`, every cell whose particles it may touch: those nearer than the support and `margin` (m) to any point of
/// the cell.
void add_cells_of(const Facet& facet, int index, double margin, const Discretisation& discretisation, CellPairs& pairs);

/// Each cell's list of facets.
CellOrder lists_of(CellPairs pairs, const Discretisation& discretisation);

/// The same of all facets at once.
CellOrder facets_by_cell(const std::vector<Facet>& facets, const Discretisation& discretisation);

/// Of the two ends of a segment in 2-D.
Vector3d middle_of(const Facet& facet, int dimensions);

}  // namespace wavetank

#include "wall_cells.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace wavetank {
namespace {

/// As cell_index in cells.cl.
int cell_of(const Eigen::Vector3d& relative, const Discretisation& d) {
  int cell[3] = {0, 0, 0};
  for (int axis = 0; axis < 3; ++axis) {
    if (d.cells[axis] == 1) continue;
    cell[axis] = std::clamp(static_cast<int>(relative[axis] / d.support) + 1, 1, d.cells[axis] - 2);
  }
  return (cell[2] * d.cells[1] + cell[1]) * d.cells[0] + cell[0];
}

int cell_count(const Discretisation& d) { return d.cells[0] * d.cells[1] * d.cells[2]; }

}  // namespace

CellOrder sorted_by_cell(const std::vector<Vector3d>& centres, const Discretisation& d) {
  CellOrder result;
  std::vector<int> cell(centres.size());
  result.order.resize(centres.size());
  result.begin.assign(static_cast<std::size_t>(cell_count(d)) + 1, 0);
  for (std::size_t s = 0; s < centres.size(); ++s) {
    cell[s] = cell_of(centres[s] - d.origin, d);
    ++result.begin[cell[s] + 1];
  }
  std::partial_sum(result.begin.begin(), result.begin.end(), result.begin.begin());
  std::iota(result.order.begin(), result.order.end(), 0);
  std::stable_sort(result.order.begin(), result.order.end(), [&](int a, int b) { return cell[a] < cell[b]; });
  return result;
}

Vector3d middle_of(const Facet& facet, int dimensions) {
  if (dimensions == 2) return 0.5 * (facet.corners[0] + facet.corners[1]);
  return (facet.corners[0] + facet.corners[1] + facet.corners[2]) / 3.0;
}

void add_cells_of(const Facet& facet, int index, double margin, const Discretisation& d, CellPairs& pairs) {
  const double half_diagonal = 0.5 * d.support * std::sqrt(static_cast<double>(d.dimensions));
  // particles drift by less than 0.02 of it between the sorting and the sweep that reads their cell
  const double touch = 1.02 * d.support + margin;
  int low[3] = {0, 0, 0}, high[3] = {0, 0, 0};
  for (int axis = 0; axis < 3; ++axis) {
    if (d.cells[axis] == 1) continue;
    double least = facet.corners[0][axis], most = least;
    for (const Vector3d& corner : facet.corners) {
      least = std::min(least, corner[axis]);
      most = std::max(most, corner[axis]);
    }
    const auto at = [&](double place) {
      return std::clamp(static_cast<int>(std::floor((place - d.origin[axis]) / d.support)) + 1, 0, d.cells[axis] - 1);
    };
    low[axis] = at(least - touch);
    high[axis] = at(most + touch);
  }
  for (int cz = low[2]; cz <= high[2]; ++cz)
    for (int cy = low[1]; cy <= high[1]; ++cy)
      for (int cx = low[0]; cx <= high[0]; ++cx) {
        Vector3d centre = d.origin + d.support * Vector3d(cx - 0.5, cy - 0.5, cz - 0.5);
        if (d.dimensions == 2) centre.y() = facet.corners[0].y();
        const Vector3d nearest = nearest_on_triangle(centre, facet.corners[0], facet.corners[1], facet.corners[2]);
        if ((nearest - centre).norm() <= touch + half_diagonal) pairs.emplace_back((cz * d.cells[1] + cy) * d.cells[0] + cx, index);
      }
}

CellOrder lists_of(CellPairs pairs, const Discretisation& d) {
  std::sort(pairs.begin(), pairs.end());
  CellOrder result;
  result.begin.assign(static_cast<std::size_t>(cell_count(d)) + 1, 0);
  for (const auto& [cell, facet] : pairs) {
    ++result.begin[cell + 1];
    result.order.push_back(facet);
  }
  std::partial_sum(result.begin.begin(), result.begin.end(), result.begin.begin());
  return result;
}

CellOrder facets_by_cell(const std::vector<Facet>& facets, const Discretisation& d) {
  CellPairs pairs;
  for (std::size_t f = 0; f < facets.size(); ++f) add_cells_of(facets[f], static_cast<int>(f), 0.0, d, pairs);
  return lists_of(std::move(pairs), d);
}

}  // namespace wavetank

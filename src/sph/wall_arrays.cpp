#include "wall_arrays.h"

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

}  // namespace

template <class Real>
WallArrays<Real>::WallArrays(const compute::Device& device, const std::vector<WallElement>& elements, const Discretisation& d)
    : count(static_cast<int>(elements.size())), stride(std::max(count, 1)) {
  const int cells = d.cells[0] * d.cells[1] * d.cells[2];
  std::vector<int> cell(elements.size()), order(elements.size()), begin(static_cast<std::size_t>(cells) + 1, 0);
  for (std::size_t s = 0; s < elements.size(); ++s) {
    cell[s] = cell_of(elements[s].centre - d.origin, d);
    ++begin[cell[s] + 1];
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return cell[a] < cell[b]; });

  std::vector<Real> values(static_cast<std::size_t>(field::wall_count) * stride, Real(0));
  owner.resize(elements.size());
  for (int s = 0; s < count; ++s) {
    const WallElement& element = elements[order[s]];
    owner[s] = element.owner;
    for (int axis = 0; axis < 3; ++axis) {
      values[static_cast<std::size_t>(field::wall_x + axis) * stride + s] = static_cast<Real>(element.centre[axis] - d.origin[axis]);
      values[static_cast<std::size_t>(field::normal_x + axis) * stride + s] = static_cast<Real>(element.normal[axis]);
      values[static_cast<std::size_t>(field::tangent_x + axis) * stride + s] = static_cast<Real>(element.tangent[axis]);
    }
    const auto set = [&](int member, double value) { values[static_cast<std::size_t>(member) * stride + s] = static_cast<Real>(value); };
    set(field::area, element.area);
    set(field::half_along, 0.5 * (d.dimensions == 3 ? std::sqrt(element.area * element.elongation) : element.area));
    set(field::half_across, d.dimensions == 3 ? 0.5 * std::sqrt(element.area / element.elongation) : 0.0);
    set(field::gap_along, element.gap[0]);
    set(field::gap_across, element.gap[1]);
  }
  fields = compute::Buffer<Real>(device, values);
  starts = compute::Buffer<int>(device, begin);
}

template <class Real>
WallOwners<Real>::WallOwners(const compute::Device& device, const WallArrays<Real>& walls, const std::vector<Eigen::Vector3d>& about,
                             const Discretisation& d)
    : owners(static_cast<int>(about.size())) {
  std::vector<int> member_list, ranges, chunk_owners, first_chunks(1, 0);
  for (int o = 0; o < owners; ++o) {
    const int begin = static_cast<int>(member_list.size());
    for (int s = 0; s < walls.count; ++s)
      if (walls.owner[s] == o) member_list.push_back(s);
    const int end = static_cast<int>(member_list.size());
    for (int from = begin; from < end; from += field::reduce_chunk) {
      ranges.push_back(from);
      ranges.push_back(std::min(end, from + field::reduce_chunk));
      chunk_owners.push_back(o);
    }
    first_chunks.push_back(static_cast<int>(chunk_owners.size()));
  }
  chunks = static_cast<int>(chunk_owners.size());
  std::vector<Real> centre_values;
  for (const Eigen::Vector3d& centre : about)
    for (int axis = 0; axis < 3; ++axis) centre_values.push_back(static_cast<Real>(centre[axis] - d.origin[axis]));
  members = compute::Buffer<int>(device, member_list);
  chunk_range = compute::Buffer<int>(device, ranges);
  chunk_owner = compute::Buffer<int>(device, chunk_owners);
  owner_chunks = compute::Buffer<int>(device, first_chunks);
  centres = compute::Buffer<Real>(device, centre_values);
  partial = compute::Buffer<Real>(device, static_cast<std::size_t>(chunks) * field::wrench_count);
  total = compute::Buffer<Real>(device, static_cast<std::size_t>(owners) * field::wrench_count);
}

template struct WallArrays<float>;
template struct WallArrays<double>;
template struct WallOwners<float>;
template struct WallOwners<double>;

}  // namespace wavetank

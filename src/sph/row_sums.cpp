#include "row_sums.h"

namespace wavetank {

template <class Real>
const compute::Buffer<Real>& RowSums<Real>::of(const compute::Device& device, const compute::Kernel& sum_rows,
                                               const compute::Buffer<Real>& array, int rows, int columns) {
  const compute::Buffer<Real>* from = &array;
  int next = 0;
  do {
    const int groups = chunks_of(rows);
    const std::size_t size = static_cast<std::size_t>(groups) * columns;
    compute::Buffer<Real>& to = parts_[next];
    if (to.size() < size) to = compute::Buffer<Real>(device, size);
    sum_rows.launch(size, rows, columns, *from, to);
    from = &to;
    next = 1 - next;
    rows = groups;
  } while (rows > 1);
  return *from;
}

template class RowSums<float>;
template class RowSums<double>;

}  // namespace wavetank

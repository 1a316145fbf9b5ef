#include "row_sums.h"

#include <cstdint>
#include <type_traits>
#include <utility>

namespace wavetank {

template <class Value>
void RowSums<Value>::bind(const compute::Device& device, const KernelMaker& make, const compute::Arguments& given,
                          const compute::Buffer<Value>& array, int columns) {
  device_ = device;
  columns_ = columns;
  compute::Arguments arguments = given;
  arguments.value("rows", rows_).value("columns", columns_).memory("from", array).memory("to", parts_[0]);
  const char* const kernel = std::is_same_v<Value, std::int64_t> ? "sum_exact_rows" : "sum_rows";
  first_ = make.exact("reduce.cl", kernel, arguments);
  arguments.memory("from", std::as_const(parts_[0])).memory("to", parts_[1]);
  onwards_ = make.exact("reduce.cl", kernel, arguments);
}

template <class Value>
void RowSums<Value>::sum(int rows) {
  const compute::BoundKernel* kernel = &first_;
  rows_ = rows;
  do {
    const int groups = chunks_of(rows_);
    const std::size_t size = static_cast<std::size_t>(groups) * columns_;
    compute::Buffer<Value>& to = parts_[kernel == &first_ ? 0 : 1];
    if (to.size() < size) to = compute::Buffer<Value>(*device_, size);
    kernel->launch(size);
    if (kernel == &onwards_) std::swap(parts_[0], parts_[1]);
    kernel = &onwards_;
    rows_ = groups;
  } while (rows_ > 1);
}

template class RowSums<float>;
template class RowSums<double>;
template class RowSums<std::int64_t>;

}  // namespace wavetank

#pragma once

#include <optional>
#include <vector>

#include "bound_kernels.h"
#include "tables/device_sizes.h"

namespace wavetank {

/// Sums of an array's rows on the device by a tree of a fixed shape, so that they repeat to the bit; of Real, or of whole numbers of 64
/// bits. Must stay where it is once it is bound.
template <class Value>
class RowSums {
 public:
  /// `array` has `columns` values a row.
  void bind(const compute::Device& device, const KernelMaker& make, const compute::Arguments& arguments,
            const compute::Buffer<Value>& array, int columns);
  /// Of its first `rows` > 0 rows, column by column: the first values of the result, which holds until the next call.
  void sum(int rows);
  /// Where kernels find the result, whatever the number of rows.
  const compute::Buffer<Value>& result() const { return parts_[0]; }
  std::vector<Value> download() const { return parts_[0].download(columns_); }

 private:
  std::optional<compute::Device> device_;  ///< once bound
  int rows_ = 0, columns_ = 0;
  compute::Buffer<Value> parts_[2];
  compute::BoundKernel first_, onwards_;
};

}  // namespace wavetank

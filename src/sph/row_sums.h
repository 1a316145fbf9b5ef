#pragma once

#include "kernel_parameters.h"
#include "wavetank/compute/program.h"

namespace wavetank {

/// Sums on the device by a tree of a fixed shape, so that they repeat to the bit.
template <class Real>
class RowSums {
 public:
  /// Of `rows` > 0 rows of an array, column by column: the first `columns` values of the result, which holds until the next call.
  const compute::Buffer<Real>& of(const compute::Device& device, const compute::Kernel& sum_rows, const compute::Buffer<Real>& array,
                                  int rows, int columns);

 private:
  compute::Buffer<Real> parts_[2];
};

}  // namespace wavetank

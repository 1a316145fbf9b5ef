#pragma once

#include "kernel_parameters.h"
#include "wavetank/compute/program.h"

namespace wavetank {

/// Sorts particles by cell on the device and keeps where each cell's begin.
class ParticleGrid {
 public:
  ParticleGrid() = default;
  /// `options`: the build options every kernel of the solver shares.
  ParticleGrid(const compute::Device& device, const compute::SourceFiles& files, const std::string& options, int cells, int particles);

  /// Reorders `state` and `id` (through the spare ones, with which they are swapped).
  template <class Real>
  void sort(const compute::Buffer<char>& parameters, compute::Buffer<Real>& state, compute::Buffer<Real>& spare_state, int stride,
            compute::Buffer<std::uint32_t>& id, compute::Buffer<std::uint32_t>& spare_id);

  const compute::Buffer<int>& starts() const { return starts_; }

 private:
  int cells_ = 0, particles_ = 0, blocks_ = 0;
  compute::Buffer<int> counts_, starts_, cursors_, block_sums_, cell_of_, order_;
  compute::Kernel clear_, count_, scan_blocks_, scan_totals_, scan_starts_, scatter_, settle_, reorder_;
};

template <class Real>
void ParticleGrid::sort(const compute::Buffer<char>& parameters, compute::Buffer<Real>& state, compute::Buffer<Real>& spare_state,
                        int stride, compute::Buffer<std::uint32_t>& id, compute::Buffer<std::uint32_t>& spare_id) {
  clear_.launch(cells_, cells_, counts_);
  count_.launch(particles_, parameters, particles_, state, stride, cell_of_, counts_);
  scan_blocks_.launch(blocks_, cells_, counts_, block_sums_);
  scan_totals_.launch(1, blocks_, block_sums_);
  scan_starts_.launch(blocks_, cells_, counts_, block_sums_, starts_, cursors_);
  scatter_.launch(particles_, particles_, cell_of_, cursors_, order_);
  settle_.launch(cells_, cells_, starts_, order_);
  reorder_.launch(particles_, particles_, order_, state, spare_state, stride, id, spare_id);
  std::swap(state, spare_state);
  std::swap(id, spare_id);
}

}  // namespace wavetank

#pragma once

#include "kernel_parameters.h"
#include "wavetank/compute/program.h"

namespace wavetank {

/// Sorts particles by slot on the device and keeps where each slot's begin.
class ParticleGrid {
 public:
  ParticleGrid() = default;
  /// `options`: the build options every kernel of the solver shares.
  ParticleGrid(const compute::Device& device, const compute::SourceFiles& files, const std::string& options, int slots, int particles);

  /// Reorders `state` and `id` (through the spare ones, with which they are swapped).
  template <class Real>
  void sort(const compute::Buffer<char>& parameters, compute::Buffer<Real>& state, compute::Buffer<Real>& spare_state, Stride stride,
            compute::Buffer<std::uint32_t>& id, compute::Buffer<std::uint32_t>& spare_id);

  const compute::Buffer<int>& starts() const { return starts_; }

 private:
  int slots_ = 0, particles_ = 0, blocks_ = 0;
  compute::Buffer<int> counts_, starts_, block_sums_, group_sums_, block_starts_, slot_of_, order_;
  compute::Kernel count_, scan_blocks_, scan_totals_, scan_starts_, scatter_, settle_, reorder_;
};

template <class Real>
void ParticleGrid::sort(const compute::Buffer<char>& parameters, compute::Buffer<Real>& state, compute::Buffer<Real>& spare_state,
                        Stride stride, compute::Buffer<std::uint32_t>& id, compute::Buffer<std::uint32_t>& spare_id) {
  count_.launch(particles_, parameters, particles_, state, stride, slot_of_, counts_);
  scan_blocks_.launch(blocks_, slots_, counts_, block_sums_);
  // a tree of three levels: of slots, blocks of them, and groups of blocks
  const int groups = (blocks_ + field::scan_block - 1) / field::scan_block;
  scan_blocks_.launch(groups, blocks_, block_sums_, group_sums_);
  scan_totals_.launch(1, groups, group_sums_);
  scan_starts_.launch(groups, blocks_, block_sums_, group_sums_, block_starts_);
  scan_starts_.launch(blocks_, slots_, counts_, block_starts_, starts_);
  scatter_.launch(particles_, particles_, slot_of_, starts_, counts_, order_);
  settle_.launch(slots_, slots_, starts_, state, stride, order_);
  reorder_.launch(particles_, particles_, order_, state, spare_state, stride, id, spare_id);
  std::swap(state, spare_state);
  std::swap(id, spare_id);
}

}  // namespace wavetank

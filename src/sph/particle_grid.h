#pragma once

#include "bound_kernels.h"
#include "tables/device_sizes.h"

namespace wavetank {

/// Sorts particles by slot on the device and keeps where each slot's begin; those that leave the water come after all others. Must stay
/// where it is once it is bound.
class ParticleGrid {
 public:
  ParticleGrid() = default;
  /// `listed`: values that starts() has room for after those of the slots.
  ParticleGrid(const compute::Device& device, int slots, int particles, int listed = 0);

  /// Another number of slots. What starts() had is lost.
  void resize(const compute::Device& device, int slots, int listed);
  /// Room for so many particles. What starts() had is lost if there is a list.
  void reserve(const compute::Device& device, int particles, int listed = 0);
  /// `arguments`: `state` and `id` are what is sorted, into `half_state` and `spare_id`, with which they are to be swapped then; and the
  /// drains.
  void bind(const KernelMaker& make, const compute::Arguments& arguments);
  void sort(int particles);

  /// Of each slot; then how many particles there are in the water, and how many with those that leave it; then, of a part of the water, its
  /// list of tiles (cells.cl).
  const compute::Buffer<int>& starts() const { return starts_; }
  compute::Buffer<int>& starts() { return starts_; }
  const int& slots() const { return slots_; }

 private:
  int slots_ = 0, all_slots_ = 0, particles_ = 0, blocks_ = 0, groups_ = 0;
  compute::Buffer<int> counts_, starts_, block_sums_, group_sums_, block_starts_, slot_of_, order_;
  compute::BoundKernel count_, sum_blocks_, sum_groups_, total_, start_blocks_, start_slots_, scatter_, settle_, reorder_;
};

}  // namespace wavetank

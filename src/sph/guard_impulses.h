#pragma once

#include <cstdint>
#include <vector>

#include "exact_sums.h"
#include "row_sums.h"
#include "tables/device_sizes.h"
#include "wavetank/compute/buffer.h"
#include "wavetank/parallel/group.h"

namespace wavetank {

/// What the guard has done to the particles in a step, and, where something can take it, what it took from them for the owners of walls.
template <class Real>
class GuardImpulses {
 public:
  /// `gives`: bodies, or the tank, get what the guard takes. `scale`: of a particle's momentum. `group`: of parts of the water, each with
  /// particles of its own; null if there is one.
  GuardImpulses(const compute::Device& device, bool gives, Stride stride, std::size_t owners, const ExactScale& scale,
                parallel::Group* group);

  /// Names what the guard writes. This must stay where it is once that is done.
  void add_to(compute::Arguments& arguments);
  /// `arguments`: of the state.
  void bind(const KernelMaker& make, const compute::Arguments& arguments);

  bool gives() const { return gives_; }
  /// Queues the sums of what the guard has just taken; of so many chunks of particles.
  void gather(int chunks);
  /// Room for particles so far apart; hits stay.
  void reserve(Stride stride);
  /// Of so many particles from the first of them on.
  void clear_hits(int first, int count);
  /// Them, if they were queued: the same of all parts. `any`: the guard has hit a particle of any part, or they are zero.
  void read(bool any);
  /// No hits, and nothing taken.
  void clear();
  /// field::impulse_count values each owner, N·s and N·m·s, of the last step.
  const std::vector<double>& values() const { return values_; }
  std::vector<double>& values() { return values_; }

  compute::Buffer<int> hits, takers;  ///< as guard.cl writes them
  compute::Buffer<Real> lost;

 private:
  compute::Device device_;
  bool gives_;
  int owners_;
  std::vector<double> values_;
  ExactScale scale_;
  Real per_impulse_, per_moment_;
  parallel::Group* group_;
  bool gathered_ = false;  ///< and not yet read
  int columns_;
  compute::Buffer<std::int64_t> parts_;
  RowSums<std::int64_t> sums_;
  compute::BoundKernel chunk_kernel_;
};

}  // namespace wavetank

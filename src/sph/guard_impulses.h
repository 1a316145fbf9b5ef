#pragma once

#include <vector>

#include "row_sums.h"
#include "tables/device_sizes.h"
#include "wavetank/compute/buffer.h"

namespace wavetank {

/// What the guard has done to the particles in a step, and, where something can take it, what it took from them for the owners of walls.
template <class Real>
class GuardImpulses {
 public:
  /// `gives`: bodies, or the tank, get what the guard takes; `report_place`: where the step's report has it.
  GuardImpulses(const compute::Device& device, bool gives, Stride stride, std::size_t owners, int report_place);

  /// Names what the guard writes. This must stay where it is once that is done.
  void add_to(compute::Arguments& arguments);
  /// `arguments`: of the state, and the step's `report`.
  void bind(const KernelMaker& make, const compute::Arguments& arguments);

  bool gives() const { return gives_; }
  /// Queues the sums of what the guard has just taken, for the step's report; of so many chunks of particles.
  void gather(int chunks);
  /// Room for particles so far apart; hits stay.
  void reserve(Stride stride);
  /// Of so many particles from the first of them on.
  void clear_hits(int first, int count);
  /// The report as it came from the device.
  void read(const std::vector<Real>& report);
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
  int report_place_;
  bool gathered_ = false;  ///< and not yet read
  int value_count_;
  compute::Buffer<Real> parts_;
  RowSums<Real> sums_;
  compute::BoundKernel chunk_kernel_, total_kernel_;
};

}  // namespace wavetank

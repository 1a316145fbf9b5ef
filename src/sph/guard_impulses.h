#pragma once

#include <vector>

#include "kernel_parameters.h"
#include "row_sums.h"
#include "solver_kernels.h"
#include "wavetank/compute/buffer.h"

namespace wavetank {

/// What the guard has done to the particles in a step, and, where something can take it, what it took from them for the owners of walls.
template <class Real>
class GuardImpulses {
 public:
  /// `gives`: bodies, or the tank, get what the guard takes.
  GuardImpulses(const compute::Device& device, bool gives, int particles, Stride stride, std::size_t owners);

  bool gives() const { return gives_; }
  /// Queues the sums of what the guard has just taken, for the step's report.
  void gather(const SolverKernels& kernels, const compute::Buffer<Real>& state, const compute::Buffer<Real>& motions,
              compute::Buffer<Real>& report);
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
  int particles_;
  Stride stride_;
  int chunks_, owners_;
  std::vector<double> values_;
  bool gathered_ = false;  ///< and not yet read
  compute::Buffer<Real> parts_;
  RowSums<Real> sums_;
};

}  // namespace wavetank

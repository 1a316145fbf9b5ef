#include "guard_impulses.h"

#include <algorithm>

namespace wavetank {

template <class Real>
GuardImpulses<Real>::GuardImpulses(const compute::Device& device, bool gives, int particles, Stride stride, std::size_t owners)
    : hits(device, particles),
      takers(device, gives ? field::guard_owners * static_cast<std::size_t>(stride) : 1),
      lost(device, gives ? 3 * field::guard_owners * static_cast<std::size_t>(stride) : 1),
      device_(device),
      gives_(gives),
      particles_(particles),
      stride_(stride),
      chunks_(chunks_of(particles)),
      owners_(static_cast<int>(owners)),
      values_(gives ? owners * field::impulse_count : 0, 0.0),
      parts_(device, values_.size() * chunks_) {}

template <class Real>
void GuardImpulses<Real>::gather(const SolverKernels& kernels, const compute::Buffer<Real>& state, const compute::Buffer<Real>& motions,
                                 compute::Buffer<Real>& report) {
  const int count = static_cast<int>(values_.size());
  kernels.guard_chunks.launch(chunks_, particles_, state, stride_, hits, takers, lost, owners_, motions, parts_);
  kernels.guard_totals.launch(count, count, sums_.of(device_, kernels.sum_rows, parts_, chunks_, count), report);
  gathered_ = true;
}

template <class Real>
void GuardImpulses<Real>::read(const std::vector<Real>& report) {
  if (gathered_) std::copy_n(report.begin() + field::report_impulses, values_.size(), values_.begin());
  gathered_ = false;
}

template <class Real>
void GuardImpulses<Real>::clear() {
  hits.fill_zero();
  std::fill(values_.begin(), values_.end(), 0.0);
}

template class GuardImpulses<float>;
template class GuardImpulses<double>;

}  // namespace wavetank

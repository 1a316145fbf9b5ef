#include "guard_impulses.h"

#include <algorithm>

namespace wavetank {

template <class Real>
GuardImpulses<Real>::GuardImpulses(const compute::Device& device, bool gives, int particles, Stride stride, std::size_t owners,
                                   int report_place)
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
      report_place_(report_place),
      value_count_(static_cast<int>(values_.size())),
      parts_(device, values_.size() * chunks_) {}

template <class Real>
void GuardImpulses<Real>::add_to(compute::Arguments& arguments) {
  arguments.memory("guard_hits", hits).memory("takers", takers).memory("lost", lost);
}

template <class Real>
void GuardImpulses<Real>::bind(const KernelMaker& make, const compute::Arguments& given) {
  compute::Arguments arguments = given;
  add_to(arguments);
  arguments.value("owners", owners_).value("values", value_count_).memory("impulses", parts_);
  sums_.bind(device_, make, given, parts_, value_count_);
  chunk_kernel_ = make.exact("reduce.cl", "guard_chunks", arguments);
  arguments.memory("impulses", sums_.result());
  total_kernel_ = make.exact("reduce.cl", "guard_totals", arguments);
}

template <class Real>
void GuardImpulses<Real>::gather() {
  chunk_kernel_.launch(chunks_);
  sums_.sum(chunks_);
  total_kernel_.launch(value_count_);
  gathered_ = true;
}

template <class Real>
void GuardImpulses<Real>::read(const std::vector<Real>& report) {
  if (gathered_) std::copy_n(report.begin() + report_place_, values_.size(), values_.begin());
  gathered_ = false;
}

template <class Real>
void GuardImpulses<Real>::clear() {
  hits.fill_zero();
  std::fill(values_.begin(), values_.end(), 0.0);
  gathered_ = false;
}

template class GuardImpulses<float>;
template class GuardImpulses<double>;

}  // namespace wavetank

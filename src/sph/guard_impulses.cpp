#include "guard_impulses.h"

#include <algorithm>
#include <utility>

namespace wavetank {

template <class Real>
GuardImpulses<Real>::GuardImpulses(const compute::Device& device, bool gives, Stride stride, std::size_t owners, int report_place)
    : device_(device),
      gives_(gives),
      owners_(static_cast<int>(owners)),
      values_(gives ? owners * field::impulse_count : 0, 0.0),
      report_place_(report_place),
      value_count_(static_cast<int>(values_.size())) {
  reserve(stride);
}

template <class Real>
void GuardImpulses<Real>::reserve(Stride stride) {
  const auto of_owners = gives_ ? field::guard_owners * static_cast<std::size_t>(stride) : 0;
  std::vector<int> had = hits.size() > 0 ? hits.download() : std::vector<int>();  // of this step, which its report has still to count
  had.resize(stride, 0);
  compute::Buffer<int> larger(device_, had), owners(device_, std::max<std::size_t>(of_owners, 1));
  compute::Buffer<Real> velocities(device_, std::max<std::size_t>(3 * of_owners, 1)),
      parts(device_, values_.size() * chunks_of(static_cast<int>(stride)));
  hits = std::move(larger);
  takers = std::move(owners);
  lost = std::move(velocities);
  parts_ = std::move(parts);
}

template <class Real>
void GuardImpulses<Real>::clear_hits(int first, int count) {
  const std::vector<int> none(count, 0);
  hits.memory().write(none.data(), count * sizeof(int), first * sizeof(int));
}

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
void GuardImpulses<Real>::gather(int chunks) {
  chunk_kernel_.launch(chunks);
  sums_.sum(chunks);
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

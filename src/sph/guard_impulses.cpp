#include "guard_impulses.h"

#include <algorithm>
#include <utility>

namespace wavetank {
namespace {

constexpr int places = exact_places(field::impulse_count);

}  // namespace

template <class Real>
GuardImpulses<Real>::GuardImpulses(const compute::Device& device, bool gives, Stride stride, std::size_t owners, const ExactScale& scale,
                                   parallel::Group* group)
    : device_(device),
      gives_(gives),
      owners_(static_cast<int>(owners)),
      values_(gives ? owners * field::impulse_count : 0, 0.0),
      scale_(scale),
      per_impulse_(static_cast<Real>(scale.quanta[0])),
      per_moment_(static_cast<Real>(scale.quanta[1])),
      group_(group),
      columns_(gives ? owners_ * places : 0) {
  reserve(stride);
}

template <class Real>
void GuardImpulses<Real>::reserve(Stride stride) {
  const auto of_owners = gives_ ? field::guard_owners * static_cast<std::size_t>(stride) : 0;
  std::vector<int> had = hits.size() > 0 ? hits.download() : std::vector<int>();  // of this step, which its report has still to count
  had.resize(stride, 0);
  compute::Buffer<int> larger(device_, had), owners(device_, std::max<std::size_t>(of_owners, 1));
  compute::Buffer<Real> velocities(device_, std::max<std::size_t>(3 * of_owners, 1));
  compute::Buffer<std::int64_t> parts(device_, static_cast<std::size_t>(columns_) * chunks_of(static_cast<int>(stride)));
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
  arguments.value("owners", owners_).value("per_impulse", per_impulse_).value("per_moment", per_moment_);
  chunk_kernel_ = make.exact("reduce.cl", "guard_chunks", arguments.memory("impulses", parts_));
  sums_.bind(device_, make, given, parts_, columns_);
}

template <class Real>
void GuardImpulses<Real>::gather(int chunks) {
  chunk_kernel_.launch(chunks);
  sums_.sum(chunks);
  gathered_ = true;
}

template <class Real>
void GuardImpulses<Real>::read(bool any) {
  if (!std::exchange(gathered_, false)) return;
  std::fill(values_.begin(), values_.end(), 0.0);
  if (!any) return;
  std::vector<std::int64_t> sums = sums_.download();
  if (group_ != nullptr) sums = group_->sums(sums);
  for (int owner = 0; owner < owners_; ++owner)
    for (int k = 0; k < field::impulse_count; ++k)
      values_[owner * field::impulse_count + k] =
          exact_value(&sums[static_cast<std::size_t>(owner) * places], k, field::impulse_count, scale_.quanta[k < 3 ? 0 : 1]);
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

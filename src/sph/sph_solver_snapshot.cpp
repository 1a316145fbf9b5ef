#include <cstring>

#include "sph_solver.h"
#include "wavetank/common/error.h"

namespace wavetank {
namespace {

constexpr std::size_t step_values = 3;  ///< of the report: the next step and what it follows from

}  // namespace

template <class Real>
std::vector<char> SphSolver<Real>::save() const {
  const std::vector<Real> state = state_.download();
  const std::vector<Real> rates = rates_.download();
  const std::vector<Real> step = report_.download(step_values);
  const std::vector<std::uint32_t> id = id_.download();
  std::vector<char> bytes;
  const auto append = [&](const void* from, std::size_t size) {
    const char* begin = static_cast<const char*>(from);
    bytes.insert(bytes.end(), begin, begin + size);
  };
  append(state.data(), state.size() * sizeof(Real));
  append(&rates[static_cast<std::size_t>(field::rate_compression) * stride_], stride_ * sizeof(Real));  // the next drift begins with these
  append(step.data(), step.size() * sizeof(Real));
  const std::vector<double> listed = moving_walls_ ? moving_walls_->listed() : std::vector<double>();
  append(listed.data(), listed.size() * sizeof(double));
  append(guarded_.values().data(), guarded_.values().size() * sizeof(double));
  append(id.data(), id.size() * sizeof(std::uint32_t));
  return bytes;
}

template <class Real>
void SphSolver<Real>::restore(const std::vector<char>& bytes) {
  std::vector<Real> state(state_.size()), rates(rates_.size(), Real(0)), step(step_values);
  std::vector<std::uint32_t> id(count_);
  std::vector<double> listed = moving_walls_ ? moving_walls_->listed() : std::vector<double>();
  const std::size_t expected = (state.size() + stride_ + step.size()) * sizeof(Real) + id.size() * sizeof(std::uint32_t) +
                               (listed.size() + guarded_.values().size()) * sizeof(double);
  if (bytes.size() != expected)
    throw Error("the snapshot's fluid has " + std::to_string(bytes.size()) + " bytes, but this case's has " + std::to_string(expected) +
                ".");
  const char* next = bytes.data();
  const auto take = [&](void* to, std::size_t size) {
    std::memcpy(to, next, size);
    next += size;
  };
  take(state.data(), state.size() * sizeof(Real));
  take(&rates[static_cast<std::size_t>(field::rate_compression) * stride_], stride_ * sizeof(Real));
  take(step.data(), step.size() * sizeof(Real));
  take(listed.data(), listed.size() * sizeof(double));
  take(guarded_.values().data(), guarded_.values().size() * sizeof(double));
  take(id.data(), id.size() * sizeof(std::uint32_t));
  if (moving_walls_) moving_walls_->list_for(walls_, listed);
  state_.upload(state);
  rates_.upload(rates);
  report_.upload(step);
  step_ = step[field::report_step];
  greatest_speed_ = step[field::report_speed];
  greatest_acceleration_ = step[field::report_acceleration];
  id_.upload(id);
  sort();  // already sorted, so this changes nothing but finds the cells
}

template std::vector<char> SphSolver<float>::save() const;
template void SphSolver<float>::restore(const std::vector<char>&);
template std::vector<char> SphSolver<double>::save() const;
template void SphSolver<double>::restore(const std::vector<char>&);

}  // namespace wavetank

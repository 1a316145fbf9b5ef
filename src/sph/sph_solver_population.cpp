#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "equation_of_state.h"
#include "sph_solver.h"
#include "wavetank/common/error.h"

namespace wavetank {
namespace {

void check(const NewParticles& particles) {
  const std::size_t count = particles.position.size();
  if (particles.velocity.size() != count || particles.volume.size() != count || particles.pressure.size() != count)
    throw Error("particles are to come in with " + std::to_string(count) + " places, but " + std::to_string(particles.velocity.size()) +
                " velocities, " + std::to_string(particles.volume.size()) + " volumes and " + std::to_string(particles.pressure.size()) +
                " pressures");
  for (std::size_t k = 0; k < count; ++k)
    if (!particles.position[k].allFinite() || !particles.velocity[k].allFinite() || !std::isfinite(particles.pressure[k]) ||
        !(particles.volume[k] > 0) || !std::isfinite(particles.volume[k]))
      throw Error("particle " + std::to_string(k) + " of those that are to come in has a value that is not finite, or no volume");
}

/// Each component of an array of as many particles, so far apart as is wanted.
template <class Real>
compute::Buffer<Real> respaced(const compute::Device& device, const compute::Buffer<Real>& from, Stride stride, Stride wanted) {
  if (from.size() == 0) return compute::Buffer<Real>(device, 0);
  const std::vector<Real> old = from.download();
  const std::size_t components = old.size() / static_cast<std::size_t>(stride);
  std::vector<Real> values(components * static_cast<std::size_t>(wanted), Real(0));
  for (std::size_t k = 0; k < components; ++k)
    std::copy_n(old.begin() + static_cast<std::ptrdiff_t>(k * stride), stride, values.begin() + static_cast<std::ptrdiff_t>(k * wanted));
  return compute::Buffer<Real>(device, values);
}

}  // namespace

template <class Real>
void SphSolver<Real>::set_count(int count) {
  count_ = count;
  chunks_ = std::max(chunks_of(count_), 1);
  groups_ = chunks_of(chunks_);
}

template <class Real>
void SphSolver<Real>::let_in(const NewParticles& particles) {
  check(particles);
  const auto add = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  add(waiting_.position, particles.position);
  add(waiting_.velocity, particles.velocity);
  add(waiting_.volume, particles.volume);
  add(waiting_.pressure, particles.pressure);
}

template <class Real>
void SphSolver<Real>::set_drains(const std::vector<Drain>& drains) {
  drains_.set(device_, drains, discretisation_.origin);
}

template <class Real>
void SphSolver<Real>::reserve(int count) {
  const Stride wanted = stride_for(count);
  if (wanted <= stride_) return;
  const Stride stride = stride_for(count + count / 4);
  for (Buffer* array : {&state_, &rates_, &gradient_, &half_, &sum_}) *array = respaced(device_, *array, stride_, stride);
  for (compute::Buffer<std::uint32_t>* ids : {&id_, &spare_id_}) *ids = respaced(device_, *ids, static_cast<Stride>(ids->size()), stride);
  around_ = Buffer();
  fillings_ = Buffer(device_, stride);
  guarded_.reserve(stride);
  surroundings_.grid.reserve(device_, static_cast<int>(stride));
  const auto chunks = static_cast<std::size_t>(chunks_of(static_cast<int>(stride)));
  const auto groups = static_cast<std::size_t>(chunks_of(static_cast<int>(chunks)));
  watches_ = Buffer(device_, chunks * reports_.greatest_count());
  group_watches_ = Buffer(device_, groups * reports_.greatest_count());
  alarms_ = compute::Buffer<int>(device_, chunks * reports_.integer_count());
  group_alarms_ = compute::Buffer<int>(device_, groups * reports_.integer_count());
  energy_parts_ = Buffer(device_, chunks * field::energy_count);
  stride_ = surroundings_.stride = stride;
}

template <class Real>
void SphSolver<Real>::add_waiting() {
  const auto count = static_cast<int>(waiting_.position.size());
  if (count == 0) return;
  if (next_id_ + count > std::numeric_limits<std::uint32_t>::max())
    throw Error("more than " + std::to_string(std::numeric_limits<std::uint32_t>::max()) + " particles have come in: ids have run out");
  reserve(count_ + count);
  const double stiffness = case_.fluid.density * discretisation_.sound_speed * discretisation_.sound_speed;
  std::vector<Real> state(fields_.count(ParticleArray::state) * static_cast<std::size_t>(count), Real(0));
  const auto put = [&](int place, int k, double value) { state[static_cast<std::size_t>(place) * count + k] = static_cast<Real>(value); };
  const auto at = [this](const char* component) { return fields_.at(ParticleArray::state, component); };
  std::vector<std::uint32_t> id(count);
  for (int k = 0; k < count; ++k) {
    id[k] = static_cast<std::uint32_t>(next_id_ + k);
    const Eigen::Vector3d place = waiting_.position[k] - discretisation_.origin;
    for (int axis = 0; axis < 3; ++axis) {
      put(static_cast<int>(first_.place) + axis, k, place[axis]);
      if ((long_axes_ >> axis & 1) != 0)
        put(static_cast<int>(first_.rest) + axis, k, static_cast<double>(static_cast<Real>(place[axis])) - place[axis]);
      put(static_cast<int>(first_.velocity) + axis, k, waiting_.velocity[k][axis]);
    }
    const double compression = compression_at(waiting_.pressure[k] / stiffness, case_);
    put(at("compression"), k, compression);
    put(at("pressure"), k, waiting_.pressure[k]);
    put(at("volume"), k, waiting_.volume[k]);
    put(at("mass"), k, case_.fluid.density * (1 + compression) * waiting_.volume[k]);
  }
  const auto write = [&](Buffer& to, std::size_t component, const Real* from) {
    to.memory().write(from, count * sizeof(Real), (component * static_cast<std::size_t>(stride_) + count_) * sizeof(Real));
  };
  for (int f = 0; f < fields_.count(ParticleArray::state); ++f) write(state_, f, &state[static_cast<std::size_t>(f) * count]);
  // what the places held of particles that have left
  const std::vector<Real> nothing(count, Real(0));
  for (int f = 0; f < fields_.count(ParticleArray::rates); ++f) write(rates_, f, nothing.data());
  guarded_.clear_hits(count_, count);
  id_.memory().write(id.data(), count * sizeof(std::uint32_t), count_ * sizeof(std::uint32_t));
  set_count(count_ + count);
  next_id_ += count;
  waiting_ = NewParticles();
}

#define WAVETANK_POPULATION(Real)                                       \
  template void SphSolver<Real>::set_count(int);                        \
  template void SphSolver<Real>::reserve(int);                          \
  template void SphSolver<Real>::let_in(const NewParticles&);           \
  template void SphSolver<Real>::set_drains(const std::vector<Drain>&); \
  template void SphSolver<Real>::add_waiting();
WAVETANK_POPULATION(float)
WAVETANK_POPULATION(double)

}  // namespace wavetank

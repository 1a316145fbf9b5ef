#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "equation_of_state.h"
#include "sph_solver.h"
#include "wavetank/common/error.h"

namespace wavetank {

void check_new_particles(const NewParticles& particles) {
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

namespace {

void check(const Drain& drain) {
  const Eigen::Vector3d sizes = drain.half_edges.colwise().norm();
  const Eigen::Matrix3d products = drain.half_edges.transpose() * drain.half_edges;
  const double least = sizes.minCoeff(), most = sizes.maxCoeff();
  if (!drain.centre.allFinite() || !drain.half_edges.allFinite() || !(least > 0))
    throw Error("a drain has a value that is not finite, or no size");
  if (!((products - Eigen::Matrix3d(products.diagonal().asDiagonal())).cwiseAbs().maxCoeff() < 1e-6 * most * most))
    throw Error("a drain's edges are not at right angles");
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
  check_new_particles(particles);
  // before anything has changed: a step that finds no memory for them at its end is lost
  reserve(count_ + static_cast<int>(waiting_.position.size() + particles.position.size()));
  open_ = true;
  const auto add = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  add(waiting_.position, particles.position);
  add(waiting_.velocity, particles.velocity);
  add(waiting_.volume, particles.volume);
  add(waiting_.pressure, particles.pressure);
}

template <class Real>
void SphSolver<Real>::set_drains(const std::vector<Drain>& drains) {
  for (const Drain& drain : drains) check(drain);
  open_ = true;
  drains_.set(device_, drains, discretisation_.origin);
}

template <class Real>
void SphSolver<Real>::set_zones(const std::vector<ImposedZone>& zones) {
  zones_.set(device_, zones, discretisation_.origin, case_);
}

template <class Real>
void SphSolver<Real>::check_nobody_came() const {
  if (next_id_ != given_ || !waiting_.position.empty())
    throw Error("a case was to be started, settled or packed when particles had come in already");
}

template <class Real>
void SphSolver<Real>::sort_all() {
  drains_.close(true);
  sort();
  drains_.close(false);
}

template <class Real>
void SphSolver<Real>::sort_all_alone() {
  if (!part_) {
    sort_all();
    return;
  }
  drains_.close(true);
  sort_alone();
  drains_.close(false);
}

/// All memory is there before anything is changed, so that the particles can still be saved where there is none left.
template <class Real>
void SphSolver<Real>::reserve(int count) {
  if (stride_for(count) <= stride_) return;
  const Stride stride = stride_for(count + count / (part_ ? 32 : 4));  // a part's number goes up and down by little
  const auto chunks = static_cast<std::size_t>(chunks_of(static_cast<int>(stride)));
  const auto groups = static_cast<std::size_t>(chunks_of(static_cast<int>(chunks)));
  Buffer* const arrays[] = {&state_, &rates_, &gradient_, &around_, &half_, &sum_};
  std::vector<Buffer> larger;
  for (const Buffer* array : arrays) larger.push_back(respaced(device_, *array, stride_, stride));
  compute::Buffer<std::uint32_t> ids = respaced(device_, id_, static_cast<Stride>(id_.size()), stride), spare_ids(device_, stride);
  Buffer fillings(device_, stride), watches(device_, chunks * reports_.greatest_count()),
      group_watches(device_, groups * reports_.greatest_count());
  compute::Buffer<int> alarms(device_, chunks * reports_.integer_count()), group_alarms(device_, groups * reports_.integer_count());
  guarded_.reserve(stride);
  surroundings_.grid.reserve(device_, static_cast<int>(stride), part_ ? 1 + 2 * static_cast<int>(stride) : 0);

  for (std::size_t k = 0; k < larger.size(); ++k) *arrays[k] = std::move(larger[k]);
  id_ = std::move(ids);
  spare_id_ = std::move(spare_ids);
  fillings_ = std::move(fillings);
  watches_ = std::move(watches);
  group_watches_ = std::move(group_watches);
  alarms_ = std::move(alarms);
  group_alarms_ = std::move(group_alarms);
  stride_ = surroundings_.stride = stride;
  if (part_) part_->reserve(stride);
}

template <class Real>
void SphSolver<Real>::add_waiting() {
  const std::vector<int> own = part_ ? own_points(waiting_.position) : std::vector<int>();
  const auto coming = static_cast<int>(waiting_.position.size());
  const int count = part_ ? static_cast<int>(own.size()) : coming;
  if (coming == 0) return;
  if (next_id_ + coming > std::numeric_limits<std::uint32_t>::max())
    throw Error("more than " + std::to_string(std::numeric_limits<std::uint32_t>::max()) + " particles have come in: ids have run out");
  reserve(count_ + count);
  const double stiffness = case_.fluid.density * discretisation_.sound_speed * discretisation_.sound_speed;
  std::vector<Real> state(fields_.count(ParticleArray::state) * static_cast<std::size_t>(count), Real(0));
  const auto put = [&](int place, int k, double value) { state[static_cast<std::size_t>(place) * count + k] = static_cast<Real>(value); };
  const auto at = [this](const char* component) { return fields_.at(ParticleArray::state, component); };
  std::vector<double> compressions(coming);
  for (int j = 0; j < coming; ++j) {
    compressions[j] = compression_at(waiting_.pressure[j] / stiffness, case_);
    masses_let_in_.push_back(static_cast<Real>(case_.fluid.density * (1 + compressions[j]) * waiting_.volume[j]));
  }
  std::vector<std::uint32_t> id(count);
  for (int k = 0; k < count; ++k) {
    const int j = part_ ? own[k] : k;
    id[k] = static_cast<std::uint32_t>(next_id_ + j);
    Eigen::Vector3d place = waiting_.position[j], velocity = waiting_.velocity[j];
    if (case_.dimensions == 2) place.y() = velocity.y() = 0;
    set_place(state, count, k, place);
    for (int axis = 0; axis < 3; ++axis) put(static_cast<int>(first_.velocity) + axis, k, velocity[axis]);
    put(at("compression"), k, compressions[j]);
    put(at("pressure"), k, waiting_.pressure[j]);
    put(at("volume"), k, waiting_.volume[j]);
    put(at("mass"), k, case_.fluid.density * (1 + compressions[j]) * waiting_.volume[j]);
    if (part_) put(at("own"), k, 1);
  }
  const auto write = [&](Buffer& to, std::size_t component, const Real* from) {
    to.memory().write(from, count * sizeof(Real), (component * static_cast<std::size_t>(stride_) + count_) * sizeof(Real));
  };
  for (int f = 0; count > 0 && f < fields_.count(ParticleArray::state); ++f) write(state_, f, &state[static_cast<std::size_t>(f) * count]);
  // what the places held of particles that have left
  const std::vector<Real> nothing(count, Real(0));
  for (int f = 0; count > 0 && f < fields_.count(ParticleArray::rates); ++f) write(rates_, f, nothing.data());
  if (count > 0) {
    guarded_.clear_hits(count_, count);
    id_.memory().write(id.data(), count * sizeof(std::uint32_t), count_ * sizeof(std::uint32_t));
  }
  set_count(count_ + count);
  next_id_ += coming;
  waiting_ = NewParticles();
}

#define WAVETANK_POPULATION(Real)                                            \
  template void SphSolver<Real>::set_count(int);                             \
  template void SphSolver<Real>::reserve(int);                               \
  template void SphSolver<Real>::let_in(const NewParticles&);                \
  template void SphSolver<Real>::set_drains(const std::vector<Drain>&);      \
  template void SphSolver<Real>::set_zones(const std::vector<ImposedZone>&); \
  template void SphSolver<Real>::check_nobody_came() const;                  \
  template void SphSolver<Real>::sort_all();                                 \
  template void SphSolver<Real>::sort_all_alone();                           \
  template void SphSolver<Real>::add_waiting();
WAVETANK_POPULATION(float)
WAVETANK_POPULATION(double)

}  // namespace wavetank

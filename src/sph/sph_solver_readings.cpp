#include <cmath>
#include <numeric>

#include "sph_solver.h"

namespace wavetank {
namespace {

constexpr std::size_t point_results = 6;  // pressure, filling, γ, and where it is wanted the velocity

}  // namespace

template <class Real>
struct SphSolver<Real>::DevicePoints final : PointSet {
  DevicePoints(const compute::Device& on, const Eigen::Vector3d& grid_origin, bool with_velocities)
      : device(on), origin(grid_origin), velocities(with_velocities) {}

  void set(const std::vector<Eigen::Vector3d>& points) override {
    count = static_cast<int>(points.size());
    std::vector<Real> values(3 * points.size());
    for (int i = 0; i < count; ++i)
      for (int axis = 0; axis < 3; ++axis) values[axis * count + i] = static_cast<Real>(points[i][axis] - origin[axis]);
    places.set(device, values);
    const std::size_t wanted = std::max<std::size_t>(point_results * points.size(), 1);
    if (results.size() < wanted) results = Buffer(device, 2 * wanted);
  }

  compute::Device device;
  Eigen::Vector3d origin;
  bool velocities;
  int count = 0;
  KeptBuffer<Real> places;
  mutable Buffer results;
  mutable BoundSweep kernel;
  mutable int binding = 0;  ///< of the solver, that the kernel is of
};

template <class Real>
std::unique_ptr<PointSet> SphSolver<Real>::make_points(const std::vector<Eigen::Vector3d>& points, PointValues wanted) const {
  auto set =
      std::make_unique<DevicePoints>(device_, discretisation_.origin, wanted == PointValues::velocity || options_.at("OPENINGS") != 0);
  set->set(points);
  bind(*set);
  return set;
}

template <class Real>
void SphSolver<Real>::bind(const DevicePoints& set) const {
  compute::Arguments all = arguments();
  all.value("count", set.count).memory("points", set.places.on_device()).memory("results", set.results);
  set.kernel = make_->over_points("points.cl", "points", all, {{"VELOCITIES", set.velocities}});
  set.binding = bindings_;
}

template <class Real>
std::vector<PointValue> SphSolver<Real>::evaluate(const PointSet& set) {
  const auto& points = dynamic_cast<const DevicePoints&>(set);
  if (points.binding != bindings_) bind(points);
  points.kernel.launch(points.count);
  std::vector<Real> results = points.results.download((points.velocities ? point_results : 3) * static_cast<std::size_t>(points.count));
  results.resize(point_results * static_cast<std::size_t>(points.count), Real(0));
  std::vector<PointValue> values(points.count);
  for (int i = 0; i < points.count; ++i) {
    const auto result = [&](int k) { return static_cast<double>(results[static_cast<std::size_t>(k) * points.count + i]); };
    values[i] = {result(0), result(1), result(2), Eigen::Vector3d(result(3), result(4), result(5))};
  }
  return values;
}

template <class Real>
std::vector<WallWrench> SphSolver<Real>::wrenches() {
  // those of a step that begins with new ones are not kept: whether they are there may depend on other readings
  if (accelerates_by_gradients_ && (!gradients_are_held_ || begins_with_gradients_)) find_gradients(Slot::now);
  load_walls(Slot::now);  // at this instant; the step found its own in its middle
  std::vector<int> owners(centres_.size());
  std::iota(owners.begin(), owners.end(), 0);
  return wrenches_.find(Slot::now, owners);
}

template <class Real>
FluidEnergies SphSolver<Real>::energies() {
  const int pieces = energy_rows_ * energy_pieces_;
  kernels_.energy_pieces.launch(pieces);
  energy_sums_.sum(pieces);
  std::vector<std::int64_t> sums = energy_sums_.download();
  if (part_) sums = part_->parting().group->sums(sums);
  std::vector<double> total;
  for (int k = 0; k < field::energy_count; ++k) total.push_back(exact_value(sums.data(), k, field::energy_count, energy_quanta_[k]));
  const auto vector = [&total](int first) { return Eigen::Vector3d(total[first], total[first + 1], total[first + 2]); };
  FluidEnergies energies;
  energies.kinetic = total[field::energy_kinetic];
  energies.potential = total[field::energy_potential];
  energies.compression = total[field::energy_compression];
  energies.mass = total[field::energy_mass];
  energies.damper_power = total[field::energy_damper];
  energies.zone_force = vector(field::energy_zone_force);
  energies.zone_moment = vector(field::energy_zone_moment) + discretisation_.origin.cross(energies.zone_force);
  energies.mass_centre = discretisation_.origin;
  if (energies.mass != 0) energies.mass_centre += vector(field::energy_moment) / energies.mass;
  // from the grid's origin to the tank's floor
  const Eigen::Vector3d up = upward(case_);
  Eigen::Vector3d floor = Eigen::Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    if (up[axis] > 0) floor[axis] = discretisation_.tank.min[axis] - discretisation_.origin[axis];
    if (up[axis] < 0) floor[axis] = discretisation_.tank.max[axis] - discretisation_.origin[axis];
  }
  energies.potential += energies.mass * case_.gravity.dot(floor);
  return energies;
}

template <class Real>
Crowding SphSolver<Real>::crowding() {
  constexpr double crowded = 1.1;  // packed particles are so by 1 or 2 %, those that hit a wall by some more
  over_own(kernels_.crowding);
  const std::vector<Real> fillings = fillings_.download(count_), state = state_.download();
  const std::vector<std::uint32_t> id = id_.download(count_);
  const Real* const volumes = component(state, "volume");
  const double quantum = volume_quantum(discretisation_);
  Crowding found;
  for (const int i : own_particles(state)) {
    if (!std::isfinite(fillings[i]) || !std::isfinite(volumes[i])) continue;  // of which the watchdog tells
    const double volume = volumes[i], lost = fillings[i] > crowded ? volume * (1 - 1.0 / fillings[i]) : 0.0;
    const auto quanta = [quantum](double amount) { return std::llround(std::clamp(amount / quantum, 0.0, 1e12)); };
    found.add({quanta(lost), quanta(volume), fillings[i], id[i], place_of(state, i)});
  }
  return found;
}

template <class Real>
FluidState SphSolver<Real>::download() {
  const std::vector<Real> state = state_.download();
  const std::vector<std::uint32_t> id = id_.download(count_);
  FluidState fluid;
  const Real* const pressure = component(state, "pressure");
  const Real* const compression = component(state, "compression");
  const Real* const mass = component(state, "mass");
  fluid.id.reserve(count_);
  for (auto* const vectors : {&fluid.position, &fluid.velocity}) vectors->reserve(count_);
  for (auto* const numbers : {&fluid.pressure, &fluid.compression, &fluid.mass}) numbers->reserve(count_);
  for (const int i : own_particles(state)) {
    fluid.id.push_back(id[i]);
    fluid.position.push_back(place_of(state, i));
    fluid.velocity.push_back(velocity_of(state, i));
    fluid.pressure.push_back(pressure[i]);
    fluid.compression.push_back(compression[i]);
    fluid.mass.push_back(mass[i]);
  }
  return fluid;
}

template <class Real>
FluidSurface SphSolver<Real>::find_surface() {
  sweep_surface();
  const std::vector<Real> around = around_.download();
  if (!shifts()) around_ = Buffer();
  FluidSurface found;
  for (const int i : own_particles(part_ ? state_.download() : std::vector<Real>())) {
    found.on_surface.push_back(around[field::around_surface * stride_ + i] > Real(0.5) ? 1 : 0);
    found.shepard.push_back(around[field::around_shepard * stride_ + i]);
    found.eigenvalue.push_back(around[field::around_eigenvalue * stride_ + i]);
  }
  return found;
}

template <class Real>
PairCount SphSolver<Real>::count_pairs() {
  pair_counts_ = compute::Buffer<int>(device_, 2 * static_cast<std::size_t>(stride_));
  over_own(kernels_.pairs);
  const std::vector<int> values = pair_counts_.download();
  pair_counts_ = compute::Buffer<int>();
  PairCount found;
  for (const int i : own_particles(part_ ? state_.download() : std::vector<Real>())) {
    found.pairs += static_cast<std::uint64_t>(values[i]);
    found.candidates += static_cast<std::uint64_t>(values[stride_ + i]);
  }
  return found;
}

template std::unique_ptr<PointSet> SphSolver<float>::make_points(const std::vector<Eigen::Vector3d>&, PointValues) const;
template std::vector<PointValue> SphSolver<float>::evaluate(const PointSet&);
template std::vector<WallWrench> SphSolver<float>::wrenches();
template FluidEnergies SphSolver<float>::energies();
template Crowding SphSolver<float>::crowding();
template FluidState SphSolver<float>::download();
template FluidSurface SphSolver<float>::find_surface();
template PairCount SphSolver<float>::count_pairs();
template std::unique_ptr<PointSet> SphSolver<double>::make_points(const std::vector<Eigen::Vector3d>&, PointValues) const;
template std::vector<PointValue> SphSolver<double>::evaluate(const PointSet&);
template std::vector<WallWrench> SphSolver<double>::wrenches();
template FluidEnergies SphSolver<double>::energies();
template Crowding SphSolver<double>::crowding();
template FluidState SphSolver<double>::download();
template FluidSurface SphSolver<double>::find_surface();
template PairCount SphSolver<double>::count_pairs();

}  // namespace wavetank

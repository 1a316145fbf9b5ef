#include <algorithm>
#include <cmath>

#include "equation_of_state.h"
#include "sph_solver.h"
#include "wavetank/common/error.h"
#include "wavetank/scene/initial_state.h"

namespace wavetank {
template <class Real>
StepReport SphSolver<Real>::start() {
  check_nobody_came();
  set_hydrostatic();
  start_at_rest();
  return start_as_given();
}

template <class Real>
StepReport SphSolver<Real>::start_as_given() {
  const InitialState initial(case_);
  std::vector<Real> state = state_.download();
  for (int axis = 0; axis < 3; ++axis) {
    if (!initial.has_velocity(axis) || (case_.dimensions == 2 && axis == 1)) continue;
    for (int i = 0; i < count_; ++i)
      state[(first_.velocity + axis) * stride_ + i] = static_cast<Real>(initial.velocity(axis, place_of(state, i)));
  }
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i < count_; ++i) state[(first_.velocity + axis) * stride_ + i] += static_cast<Real>(case_.fluid.current[axis]);
  if (initial.has_pressure()) {
    // of water that fills the volume that each particle was given
    const double stiffness = case_.fluid.density * discretisation_.sound_speed * discretisation_.sound_speed;
    const std::vector<std::uint32_t> id = id_.download();
    for (int i = 0; i < count_; ++i) {
      const double compression = compression_at(initial.pressure(place_of(state, i)) / stiffness, case_);
      const double volume = volumes_[id[i]];
      component(state, "compression")[i] = static_cast<Real>(compression);
      component(state, "volume")[i] = static_cast<Real>(volume);
      component(state, "mass")[i] = static_cast<Real>(case_.fluid.density * (1 + compression) * volume);
    }
  }
  state_.upload(state);
  return start_from_state();
}

template <class Real>
void SphSolver<Real>::set_hydrostatic() {
  // below the free surface that the particle was filled under
  const double c2 = discretisation_.sound_speed * discretisation_.sound_speed;
  std::vector<Real> state = state_.download();
  const std::vector<std::uint32_t> id = id_.download();
  const double g = -case_.gravity.dot(up_);
  Real* const compressions = component(state, "compression");
  Real* const masses = component(state, "mass");
  Real* const volumes = component(state, "volume");
  for (int i = 0; i < count_; ++i) {
    const double head = g * std::max(levels_[id[i]] - up_.dot(place_of(state, i)), 0.0) / c2;
    compressions[i] = static_cast<Real>(compression_at(head, case_));
    masses[i] = static_cast<Real>(case_.fluid.density * volumes_[id[i]]);
    volumes[i] = static_cast<Real>(volumes_[id[i]]);
  }
  for (const FieldRow& row : fields_.rows())
    if (row.evolution == FieldRow::Evolution::follower)
      for (const std::string& name : row.components) std::fill_n(component(state, name.c_str()), count_, Real(0));
  state_.upload(state);
}

template <class Real>
StepReport SphSolver<Real>::start_at_rest() {
  std::vector<Real> state = state_.download();
  for (int axis = 0; axis < 3; ++axis) {
    std::fill_n(state.begin() + (first_.velocity + axis) * stride_, stride_, Real(0));
    if ((long_axes_ >> axis & 1) == 0)  // elsewhere they are part of the place
      std::fill_n(state.begin() + (first_.rest + axis) * stride_, stride_, Real(0));
    if (shifts()) std::fill_n(state.begin() + (fields_.at(ParticleArray::state, "shift_x") + axis) * stride_, stride_, Real(0));
  }
  state_.upload(state);
  return start_from_state();
}

template <class Real>
StepReport SphSolver<Real>::start_from_state() {
  forget_gradients();
  kernels_.derive.launch(count_);
  if (case_.numerics.integrator == Integrator::symplectic) {
    find_accelerations(Slot::now);
    find_compression_rates(Slot::now);
  } else {
    find_rates(Slot::now);  // by the one kernel that the steps need as well
  }
  guarded_.clear();
  if (part_) part_->still_others(count_, part_->watched() - count_);  // the report is of own particles
  const StepReport report = watch();
  // a step moves a part's halo with it
  refresh("acceleration");
  refresh("compression rate");
  return report;
}

template <class Real>
double SphSolver<Real>::packing_error() {
  if (packing_parts_.size() < static_cast<std::size_t>(chunks_)) packing_parts_ = Buffer(device_, 2 * static_cast<std::size_t>(chunks_));
  kernels_.packing_chunks.launch(chunks_);
  packing_sums_.sum(chunks_);
  const double sum = packing_sums_.download()[0];
  return std::sqrt(part_ ? sum_of_parts(sum) / static_cast<double>(part_->all) : sum / count_);
}

/// The walls, and of the lid what holds the water up or to the side.
template <class Real>
WallArrays<Real> SphSolver<Real>::make_supported_walls() const {
  const std::vector<WallElement> lid = case_walls_.supporting_lid();
  if (ghosts_ && !lid.empty())
    throw Error(
        "numerics/packing/settling needs the tank's walls on all sides of the water where numerics/walls/method is ghost; "
        "set it to 0, or choose boundary_integral.");
  return case_walls_.arrays_at_start<Real>(device_, true, lid);
}

template <class Real>
StepReport SphSolver<Real>::settle(double periods, const std::function<void(double)>& progress) {
  const double duration = periods * discretisation_.sound_period;
  if (duration == 0) return start();
  check_nobody_came();
  WallArrays<Real> supported = make_supported_walls();
  set_hydrostatic();
  StepReport report = start_at_rest();

  ParameterBlock damped = *values_;
  damped.set("damping", 4.0 * std::acos(-1.0) / discretisation_.sound_period);
  const Eigen::Vector3d rest = gravity_at_rest(), hydrostatic = rest / (discretisation_.sound_speed * discretisation_.sound_speed);
  for (int axis = 0; axis < 3; ++axis) {
    damped.set(std::string("gravity_") + "xyz"[axis], rest[axis]);
    damped.set(std::string("hydrostatic_") + "xyz"[axis], hydrostatic[axis]);
  }
  const std::vector<Real> moving = surroundings_.motions.values();
  std::vector<Real> still = moving;
  for (int k = 0; k < 9; ++k) still[k] = k < 3 ? static_cast<Real>(rest[k]) : Real(0);  // of the frame
  for (std::size_t k = field::frame_count; k < still.size(); ++k)
    if (const std::size_t at = (k - field::frame_count) % field::motion_count; at >= field::motion_velocity && at < field::motion_friction)
      still[k] = Real(0);
  upload_parameters(damped);
  surroundings_.motions.set(device_, still);
  std::swap(walls_, supported);
  Buffer loads(device_, elements_ ? walls_.stride : 1);
  std::swap(loads_, loads);
  const auto end_settling = [&] {
    std::swap(loads_, loads);
    std::swap(walls_, supported);
    surroundings_.motions.set(device_, moving);
    upload_parameters(*values_);
  };
  const auto may_go_on = [&] { return report.valid() && report.time_step >= discretisation_.least_time_step; };
  try {
    report = start_at_rest();
    for (double time = 0; time < duration && may_go_on();) {
      time += report.time_step;
      report = advance(nullptr);
      if (progress) progress(std::min(time / duration, 1.0));
    }
  } catch (...) {
    end_settling();
    throw;
  }
  end_settling();
  if (!may_go_on()) return report;
  start_at_rest();
  return start_as_given();
}

template <class Real>
PackingReport SphSolver<Real>::pack(int iterations, const std::function<void(double)>& progress) {
  check_nobody_came();
  PackingReport report;
  const auto with_lid = [&](bool real_walls) { return case_walls_.arrays_at_start<Real>(device_, real_walls, case_walls_.lid()); };
  WallArrays<Real> closed = with_lid(!ghosts_);  // the ghosts themselves are the walls
  WallArrays<Real> of_guard = ghosts_ ? with_lid(true) : WallArrays<Real>();
  const auto among = [this](WallArrays<Real>& walls, const auto& launch) {
    std::swap(walls_, walls);
    try {
      launch();
    } catch (...) {
      std::swap(walls_, walls);
      throw;
    }
    std::swap(walls_, walls);
  };
  const int report_interval = 10;
  for (int k = 0; k <= iterations; ++k) {
    among(closed, [this] { over_own(kernels_.packing); });
    hold_zones(Slot::now);
    if (k % report_interval == 0 || k == iterations) {
      report.last_error = packing_error();
      if (k == 0) report.first_error = report.last_error;
      if (progress) progress(iterations == 0 ? 1.0 : static_cast<double>(k) / iterations);
    }
    report.iterations = k;
    if (k == iterations) break;
    kernels_.move_packed.launch(count_);
    among(ghosts_ ? of_guard : closed, [this] { kernels_.guard.launch(count_); });
    sort_all();
  }
  packing_parts_ = Buffer();
  return report;
}

template StepReport SphSolver<float>::start();
template StepReport SphSolver<float>::settle(double, const std::function<void(double)>&);
template double SphSolver<float>::packing_error();
template double SphSolver<double>::packing_error();
template PackingReport SphSolver<float>::pack(int, const std::function<void(double)>&);
template StepReport SphSolver<double>::start();
template StepReport SphSolver<double>::settle(double, const std::function<void(double)>&);
template PackingReport SphSolver<double>::pack(int, const std::function<void(double)>&);

}  // namespace wavetank

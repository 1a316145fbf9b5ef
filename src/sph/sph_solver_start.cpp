#include <algorithm>
#include <cmath>

#include "sph_solver.h"
#include "wavetank/common/error.h"

namespace wavetank {
template <class Real>
StepReport SphSolver<Real>::start() {
  set_hydrostatic();
  return start_at_rest();
}

template <class Real>
void SphSolver<Real>::set_hydrostatic() {
  // below the free surface that the particle was filled under
  std::vector<Real> state = state_.download();
  const std::vector<std::uint32_t> id = id_.download();
  const double c2 = discretisation_.sound_speed * discretisation_.sound_speed;
  const double g = -case_.gravity.dot(up_);
  for (int i = 0; i < count_; ++i) {
    const double head = g * std::max(levels_[id[i]] - up_.dot(place_of(state, i)), 0.0) / c2;  // p/(ρ₀c₀²)
    const double compression =
        case_.numerics.equation_of_state == EquationOfState::cole ? std::pow(1.0 + 7.0 * head, 1.0 / 7.0) - 1.0 : head;
    state[static_cast<std::size_t>(field::compression) * stride_ + i] = static_cast<Real>(compression);
    state[static_cast<std::size_t>(field::steady) * stride_ + i] = Real(0);
  }
  state_.upload(state);
}

template <class Real>
StepReport SphSolver<Real>::start_at_rest() {
  std::vector<Real> state = state_.download();
  const auto clear = [&](int f) { std::fill_n(state.begin() + static_cast<std::ptrdiff_t>(f) * stride_, stride_, Real(0)); };
  for (int axis = 0; axis < 3; ++axis) {
    clear(field::u + axis);
    if ((long_axes_ >> axis & 1) == 0) clear(field::rest_x + axis);  // elsewhere they are part of the place
  }
  state_.upload(state);
  kernels_.derive.launch(count_, surroundings_.parameters, count_, state_, stride_);
  accelerate(state_);
  compress_at(state_);
  guarded_.clear();
  return watch();
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
  StepReport report = start();
  const double duration = periods * discretisation_.sound_period;
  if (duration == 0) return report;
  WallArrays<Real> supported = make_supported_walls();

  KernelParameters<Real> damped = values_;
  damped.damping = static_cast<Real>(4.0 * std::acos(-1.0) / discretisation_.sound_period);
  const Eigen::Vector3d rest = gravity_at_rest(), hydrostatic = rest / (discretisation_.sound_speed * discretisation_.sound_speed);
  damped.gravity_x = static_cast<Real>(rest.x());
  damped.gravity_y = static_cast<Real>(rest.y());
  damped.gravity_z = static_cast<Real>(rest.z());
  damped.hydrostatic_x = static_cast<Real>(hydrostatic.x());
  damped.hydrostatic_y = static_cast<Real>(hydrostatic.y());
  damped.hydrostatic_z = static_cast<Real>(hydrostatic.z());
  const std::vector<Real> moving = surroundings_.motions.values();
  std::vector<Real> still = moving;
  for (int k = 0; k < 9; ++k) still[k] = k < 3 ? static_cast<Real>(rest[k]) : Real(0);  // of the frame
  for (std::size_t k = field::frame_count; k < still.size(); ++k)
    if ((k - field::frame_count) % field::motion_count >= 3) still[k] = Real(0);
  upload_parameters(damped);
  surroundings_.motions.set(device_, still);
  std::swap(walls_, supported);
  Buffer loads(device_, elements_ ? walls_.stride : 1);
  std::swap(loads_, loads);
  const auto end_settling = [&] {
    std::swap(loads_, loads);
    std::swap(walls_, supported);
    surroundings_.motions.set(device_, moving);
    upload_parameters(values_);
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
  return may_go_on() ? start_at_rest() : report;
}

template <class Real>
PackingReport SphSolver<Real>::pack(int iterations, const std::function<void(double)>& progress) {
  PackingReport report;
  const WallArrays<Real> closed =
      case_walls_.arrays_at_start<Real>(device_, !ghosts_, case_walls_.lid());  // the ghosts themselves are the walls
  const WallArrays<Real> of_guard = ghosts_ ? case_walls_.arrays_at_start<Real>(device_, true, case_walls_.lid()) : WallArrays<Real>();
  const WallArrays<Real>& guarded = ghosts_ ? of_guard : closed;
  Buffer squares(device_, chunks_);
  const int report_interval = 10;
  for (int k = 0; k <= iterations; ++k) {
    sweep(kernels_.packing, count_, state_, closed, surroundings_.film.on_device(), rates_);
    if (k % report_interval == 0 || k == iterations) {
      kernels_.packing_chunks.launch(chunks_, count_, rates_, stride_, squares);
      report.last_error = std::sqrt(sums_.of(device_, kernels_.sum_rows, squares, chunks_, 1).download(1)[0] / static_cast<Real>(count_));
      if (k == 0) report.first_error = report.last_error;
      if (progress) progress(iterations == 0 ? 1.0 : static_cast<double>(k) / iterations);
    }
    report.iterations = k;
    if (k == iterations) break;
    kernels_.move_packed.launch(count_, surroundings_.parameters, count_, state_, half_, stride_, rates_);
    sweep(kernels_.guard, count_, state_, guarded, rates_, half_, report_, guarded_.hits, guarded_.takers, guarded_.lost);
    sort();
  }
  return report;
}

template StepReport SphSolver<float>::start();
template StepReport SphSolver<float>::settle(double, const std::function<void(double)>&);
template PackingReport SphSolver<float>::pack(int, const std::function<void(double)>&);
template StepReport SphSolver<double>::start();
template StepReport SphSolver<double>::settle(double, const std::function<void(double)>&);
template PackingReport SphSolver<double>::pack(int, const std::function<void(double)>&);

}  // namespace wavetank

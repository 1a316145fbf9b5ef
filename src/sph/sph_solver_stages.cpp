// What integrators are made of.
#include <algorithm>
#include <utility>

#include "sph_solver.h"

namespace wavetank {
namespace {

bool all_finite(const std::vector<WallWrench>& wrenches) {
  for (const WallWrench& wrench : wrenches)
    for (const Eigen::Vector3d& part : wrench)
      if (!part.allFinite()) return false;
  return true;
}

/// Of the grid by which walls are found, the border's too.
std::size_t cells_of(const Discretisation& d) {
  return static_cast<std::size_t>(d.cells[0]) * static_cast<std::size_t>(d.cells[1]) * static_cast<std::size_t>(d.cells[2]);
}

}  // namespace

template <class Real>
void SphSolver<Real>::walls_at(double fraction) {
  if (mover_ != nullptr) place_walls(mover_->at(step_, fraction));
}

template <class Real>
void SphSolver<Real>::find_accelerations(Slot state) {
  if (accelerates_by_gradients_ && !gradients_are_held_) find_gradients(state);
  load_walls(state);
  over_own(kernels_.momentum[state]);
  hold_zones(state);
}

template <class Real>
void SphSolver<Real>::find_compression_rates(Slot state) {
  if (compresses_by_gradients_) find_gradients(state);
  over_own(kernels_.continuity[state]);
  hold_zones(state);
}

template <class Real>
void SphSolver<Real>::find_rates(Slot state) {
  find_gradients(state);
  load_walls(state);
  over_own(kernels_.rates[state]);
  hold_zones(state);
}

template <class Real>
void SphSolver<Real>::find_gradients(Slot state) {
  if (gradient_.size() == 0) return;
  if (std::exchange(gradients_are_ahead_, false) && state == Slot::now) return;
  find_gradients(state, state == Slot::now && ends_with_surface());
}

template <class Real>
void SphSolver<Real>::find_gradients(Slot state, bool with_surface) {
  spoil("gradients");
  sweep_gradients(state, with_surface);
  refresh("gradients");
}

template <class Real>
void SphSolver<Real>::sweep_gradients(Slot state, bool with_surface) {
  reserve_blocks();
  gradients_are_of_now_ = state == Slot::now;
  gradients_are_held_ = holds_gradients_ && gradients_are_of_now_;
  surface_is_of_now_ = with_surface;
  if (with_surface) reserve_surroundings();
  over_own(with_surface ? kernels_.surroundings : kernels_.gradients[state]);
}

template <class Real>
void SphSolver<Real>::forget_gradients() {
  gradients_are_of_now_ = gradients_are_ahead_ = gradients_are_held_ = surface_is_of_now_ = false;
}

template <class Real>
void SphSolver<Real>::reserve_blocks() {
  const std::size_t wanted = listed_blocks_ == 0 ? 0 : static_cast<std::size_t>(tiles()) * (listed_blocks_ + 2);
  if (blocks_.size() < wanted) blocks_ = compute::Buffer<int>(device_, wanted + wanted / 8);
}

template <class Real>
void SphSolver<Real>::add_wrenches(Slot state, double weight) {
  if (mover_ == nullptr) return;
  const std::vector<WallWrench> wrenches = wrenches_.find(state, mover_->coupled());
  const bool first = step_wrenches_.empty();
  step_wrenches_.resize(wrenches.size());
  for (std::size_t k = 0; k < wrenches.size(); ++k)
    for (std::size_t part = 0; part < wrenches[k].size(); ++part) {
      const Eigen::Vector3d share = weight * wrenches[k][part];
      step_wrenches_[k][part] = first ? share : Eigen::Vector3d(step_wrenches_[k][part] + share);
    }
}

/// With what the guard took at the end of the last step.
template <class Real>
void SphSolver<Real>::walls_to_end() {
  if (mover_ == nullptr) return;
  const std::vector<int> owners = mover_->coupled();
  for (std::size_t k = 0; guarded_.gives() && k < owners.size(); ++k) {
    const double* impulse = &guarded_.values()[owners[k] * field::impulse_count];
    step_wrenches_[k][0] += Eigen::Vector3d(impulse) / step_;
    step_wrenches_[k][2] += Eigen::Vector3d(impulse + 3) / step_;
  }
  load_lost_ = !all_finite(step_wrenches_);
  if (!load_lost_) place_walls(mover_->to_end(step_, step_wrenches_));
}

template <class Real>
void SphSolver<Real>::guard() {
  kernels_.guard.launch(count_);
  if (guarded_.gives() && mover_ != nullptr) guarded_.gather(chunks_);
}

template <class Real>
void SphSolver<Real>::reserve_surroundings() {
  const std::size_t wanted = static_cast<std::size_t>(field::around_count) * stride_;
  if (around_.size() != wanted) around_ = Buffer(device_, wanted);
}

template <class Real>
void SphSolver<Real>::sweep_surface() {
  reserve_surroundings();
  if (joins_surface_ ? !surface_is_of_now_ : listed_blocks_ != 0 && !gradients_are_of_now_) find_gradients(Slot::now, joins_surface_);
  if (!joins_surface_) over_own(kernels_.normals);
  over_own(kernels_.cone);
}

template <class Real>
void SphSolver<Real>::find_shifts() {
  reserve_surroundings();
  spoil("surroundings");
  if (begins_with_gradients_) forget_gradients();
  sweep_surface();
  refresh("surroundings");
  if (surface_cells_.size() == 0) surface_cells_ = compute::Buffer<int>(device_, cells_of(discretisation_));
  surface_cells_.fill_zero();
  kernels_.mark_surface.launch(count_);
  over_own(kernels_.shifts);
  if (zones_.any()) kernels_.hold_shifts.launch(count_);
  gradients_are_ahead_ = gradients_are_of_now_;
  if (!begins_with_gradients_) return;
  refresh("shift");
  find_compression_rates(Slot::now);
}

template <class Real>
void SphSolver<Real>::impose_zones() {
  if (!zones_.any()) return;
  kernels_.impose.launch(count_);
  if (!gradients_are_held_) forget_gradients();  // that a reading between two steps left, or it would matter whether there was one
}

template <class Real>
void SphSolver<Real>::damp_velocities() {
  kernels_.damp.launch(count_);
  if (!gradients_are_held_) forget_gradients();
}

template <class Real>
void SphSolver<Real>::hold_zones(Slot state) {
  if (zones_.any()) kernels_.hold_rates[state].launch(count_);
}

template <class Real>
void SphSolver<Real>::drift_to_middle() {
  kernels_.predict.launch(count_);
  widen_reach(0.5, greatest_speed_);
}

template <class Real>
void SphSolver<Real>::kick_and_drift_to_end() {
  kernels_.correct.launch(count_);
}

template <class Real>
void SphSolver<Real>::compress_to_end() {
  kernels_.compress.launch(count_);
}

template <class Real>
void SphSolver<Real>::go_on_trial(Slot, bool first, double weight, double part) {
  trial_ = {first ? 1 : 0, static_cast<Real>(weight), static_cast<Real>(part)};
  kernels_.go_on_trial.launch(count_);
  widen_reach(part, speed_in_step());
}

template <class Real>
void SphSolver<Real>::take_sum(double weight) {
  trial_.weight = static_cast<Real>(weight);
  kernels_.take_sum.launch(count_);
}

template <class Real>
void SphSolver<Real>::predict_end() {
  kernels_.predict_end.launch(count_);
  widen_reach(1.0, speed_in_step());
}

template <class Real>
void SphSolver<Real>::correct_end() {
  kernels_.correct_end.launch(count_);
}

#define WAVETANK_STAGES(Real)                                             \
  template void SphSolver<Real>::walls_at(double);                        \
  template void SphSolver<Real>::find_accelerations(Slot);                \
  template void SphSolver<Real>::find_compression_rates(Slot);            \
  template void SphSolver<Real>::find_rates(Slot);                        \
  template void SphSolver<Real>::find_gradients(Slot);                    \
  template void SphSolver<Real>::find_gradients(Slot, bool);              \
  template void SphSolver<Real>::sweep_gradients(Slot, bool);             \
  template void SphSolver<Real>::reserve_surroundings();                  \
  template void SphSolver<Real>::forget_gradients();                      \
  template void SphSolver<Real>::reserve_blocks();                        \
  template void SphSolver<Real>::add_wrenches(Slot, double);              \
  template void SphSolver<Real>::walls_to_end();                          \
  template void SphSolver<Real>::guard();                                 \
  template void SphSolver<Real>::sweep_surface();                         \
  template void SphSolver<Real>::find_shifts();                           \
  template void SphSolver<Real>::impose_zones();                          \
  template void SphSolver<Real>::damp_velocities();                       \
  template void SphSolver<Real>::hold_zones(Slot);                        \
  template void SphSolver<Real>::drift_to_middle();                       \
  template void SphSolver<Real>::kick_and_drift_to_end();                 \
  template void SphSolver<Real>::compress_to_end();                       \
  template void SphSolver<Real>::go_on_trial(Slot, bool, double, double); \
  template void SphSolver<Real>::take_sum(double);                        \
  template void SphSolver<Real>::predict_end();                           \
  template void SphSolver<Real>::correct_end();
WAVETANK_STAGES(float)
WAVETANK_STAGES(double)

}  // namespace wavetank

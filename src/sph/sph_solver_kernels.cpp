#include <utility>

#include "sph_solver.h"

namespace wavetank {

/// Under the names that kernels have for them: what all may read. Those that write are given what they write.
template <class Real>
compute::Arguments SphSolver<Real>::arguments() const {
  compute::Arguments all = surroundings_.arguments(walls_);
  all.value("count", count_).memory("motions", surroundings_.motions.on_device());
  all.memory("state", state_).memory("half_state", half_).memory("rates", rates_).memory("gradient", gradient_).memory("blocks", blocks_);
  all.memory("wall_loads", loads_).memory("time_step", report_).memory("id", id_).memory("guard_hits", guarded_.hits);
  return all;
}

template <class Real>
compute::Arguments SphSolver<Real>::arguments_of(Slot state) const {
  return arguments().memory("state", buffer_of(state));
}

template <class Real>
void SphSolver<Real>::bind_kernels() {
  make_.emplace(device_, sources_, text_of(options_), tiling_);
  ++bindings_;
  bind_sweeps();
  bind_time_step();
  bind_zones();
  bind_reductions();
  compute::Arguments sorting = arguments();
  drains_.add_to(sorting);
  surroundings_.grid.bind(*make_, sorting.memory("half_state", half_).memory("spare_id", spare_id_));
  wrenches_.bind(*make_, case_.numerics.gradients == Gradients::sph ? "wall_forces.cl" : "mls_wall_forces.cl",
                 {{Slot::now, arguments_of(Slot::now)}, {Slot::trial, arguments_of(Slot::trial)}});
  guarded_.bind(*make_, arguments());
  if (moving_walls_) moving_walls_->bind(*make_, arguments(), walls_);
  if (part_) bind_part();
}

template <class Real>
void SphSolver<Real>::bind_sweeps() {
  const std::string by = case_.numerics.gradients == Gradients::sph ? "" : "mls_";  // of all that goes by the case's gradients
  for (const Slot slot : {Slot::now, Slot::trial}) {
    const compute::Arguments of_state = arguments_of(slot);
    compute::Arguments writes = of_state;
    kernels_.continuity[slot] = make_->over_particles(by + "continuity.cl", "continuity", writes.memory("rates", rates_));
    kernels_.momentum[slot] = make_->over_particles(by + "momentum.cl", "momentum", writes);
    kernels_.rates[slot] = make_->over_particles(by + "rates.cl", "rates_of_state", writes);
    writes = of_state;
    kernels_.gradients[slot] =
        make_->over_particles(by + "gradients.cl", "gradients", writes.memory("gradient", gradient_).memory("blocks", blocks_));
    writes = of_state;
    kernels_.loads[slot] = make_->over_points("wall_loads.cl", "wall_loads", writes.value("count", walls_.count).memory("loads", loads_));
  }
  kernels_.packing = make_->over_particles("packing.cl", "packing", arguments().memory("rates", rates_));
  kernels_.normals = make_->over_particles("surface.cl", "surface_normals", arguments().memory("around", around_));
  kernels_.surroundings = make_->over_particles(
      "surroundings.cl", "surroundings", arguments().memory("gradient", gradient_).memory("blocks", blocks_).memory("around", around_));
  kernels_.cone = make_->over_particles("cone.cl", "surface_cone", arguments().memory("around", around_));
  if (shifts()) bind_shifts();
  kernels_.crowding = make_->over_particles("crowding.cl", "crowding", arguments().memory("fillings", fillings_));
  kernels_.pairs = make_->over_particles("pairs.cl", "pairs", arguments().memory("counts", pair_counts_));
  compute::Arguments guarding = arguments().memory("state", state_);
  guarded_.add_to(guarding);
  kernels_.guard = {make_->exact("guard.cl", "guard", guarding), 1};
}

template <class Real>
void SphSolver<Real>::bind_shifts() {
  compute::Arguments shifting = arguments();
  shifting.memory("around", std::as_const(around_));
  kernels_.mark_surface =
      make_->exact("mark_surface.cl", "mark_surface", compute::Arguments(shifting).memory("surface_cells", surface_cells_));
  kernels_.shifts =
      make_->over_particles("shifts.cl", "shifts", shifting.memory("state", state_).memory("surface_cells", std::as_const(surface_cells_)));
}

template <class Real>
void SphSolver<Real>::bind_time_step() {
  const auto kernel = [&](const char* name, const compute::Arguments& writes) { return make_->exact("time_step.cl", name, writes); };
  kernels_.derive = kernel("derive_state", arguments().memory("state", state_));
  kernels_.predict = kernel("predict", arguments().memory("half_state", half_));
  kernels_.correct = kernel("correct", arguments().memory("state", state_));
  kernels_.compress = kernel("compress", arguments().memory("state", state_));
  kernels_.move_packed = kernel("move_packed", arguments().memory("state", state_).memory("half_state", half_));
  compute::Arguments towards = arguments();
  towards.memory("now", std::as_const(state_)).memory("trial", half_).memory("sum", sum_);
  towards.value("first", trial_.first).value("weight", trial_.weight).value("part", trial_.part);
  kernels_.go_on_trial = kernel("go_on_trial", towards);
  kernels_.predict_end = kernel("predict_end", towards);
  compute::Arguments back = towards;
  back.memory("now", state_).memory("rates", rates_).memory("sum", std::as_const(sum_));
  kernels_.take_sum = kernel("take_sum", back);
  kernels_.correct_end = kernel("correct_end", back);
}

template <class Real>
void SphSolver<Real>::bind_zones() {
  const auto kernel = [&](const char* name, compute::Arguments writes) {
    zones_.add_to(writes);
    return make_->exact("zones.cl", name, writes);
  };
  kernels_.impose = kernel("impose_zones", arguments().memory("state", state_));
  for (const Slot slot : {Slot::now, Slot::trial})
    kernels_.hold_rates[slot] = kernel("hold_zone_rates", arguments_of(slot).memory("rates", rates_));
  kernels_.hold_shifts = kernel("hold_zone_shifts", arguments().memory("state", state_));
  compute::Arguments damped = arguments();
  damping_.add_to(damped);
  kernels_.damp = make_->exact("damping.cl", "damp_velocities", damped.memory("state", state_));
}

template <class Real>
void SphSolver<Real>::bind_reductions() {
  const auto kernel = [&](const char* name, const compute::Arguments& writes) { return make_->exact("reduce.cl", name, writes); };
  compute::Arguments watching = arguments();
  watching.memory("watches", watches_).memory("alarms", alarms_).value("slots", surroundings_.grid.slots());
  kernels_.watch_chunks = kernel("watch_chunks", watching);
  watching.memory("group_watches", group_watches_).memory("group_alarms", group_alarms_).value("chunks", chunks_);
  kernels_.watch_groups = kernel("watch_groups", watching);
  watching.memory("watches", std::as_const(group_watches_)).memory("alarms", std::as_const(group_alarms_)).value("chunks", groups_);
  kernels_.watch_total = kernel("watch_total", watching.value("longest", longest_step_).memory("report", report_));
  compute::Arguments energies = arguments();
  damping_.add_to(energies);
  energies.value("rows", energy_rows_).value("pieces", energy_pieces_).value("segment", energy_segment_);
  kernels_.energy_pieces =
      kernel("energy_pieces", energies.memory("quanta", std::as_const(energy_quanta_on_device_)).memory("energies", energy_parts_));
  energy_sums_.bind(device_, *make_, arguments(), energy_parts_, exact_places(field::energy_count));
  kernels_.packing_chunks = kernel("packing_chunks", arguments().memory("sums", packing_parts_));
  packing_sums_.bind(device_, *make_, arguments(), packing_parts_, 1);
}

template compute::Arguments SphSolver<float>::arguments() const;
template compute::Arguments SphSolver<float>::arguments_of(Slot) const;
template void SphSolver<float>::bind_kernels();
template compute::Arguments SphSolver<double>::arguments() const;
template compute::Arguments SphSolver<double>::arguments_of(Slot) const;
template void SphSolver<double>::bind_kernels();

}  // namespace wavetank

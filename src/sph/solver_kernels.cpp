#include "solver_kernels.h"

namespace wavetank {

SolverKernels::SolverKernels(const compute::Device& device, const compute::SourceFiles& files, const std::string& options,
                             const Tiling& tiling) {
  const std::string fast = options + " -cl-fast-relaxed-math";
  const auto lazy = [&](const char* file, const char* name, const std::string& own_options) {
    return LazyKernel(
        [device, &files, file, name, own_options] { return compute::Program(device, files, file, own_options).kernel(name); });
  };
  const auto of_particles = [&](const char* file, const char* name) {
    return SweepKernel{lazy(file, name, fast + tiling.particles.build_options()), tiling.particles.own};
  };
  const auto of_points = [&](const char* file, const char* name) {
    return SweepKernel{lazy(file, name, fast + tiling.points.build_options()), 1};
  };
  continuity = of_particles("continuity.cl", "continuity");
  momentum = of_particles("momentum.cl", "momentum");
  wall_forces = of_particles("wall_forces.cl", "wall_forces");
  wall_forces.own = 1;  // an item is a run of slots
  gradient = of_particles("density_gradient.cl", "density_gradient");
  loads = of_points("wall_loads.cl", "wall_loads");
  packing = of_particles("packing.cl", "packing");
  facing_walls = of_points("facing_walls.cl", "facing_walls");
  guard.kernel = lazy("guard.cl", "guard", options);
  points = of_points("points.cl", "points");
  surface = of_particles("points.cl", "surface");
  crowding = of_particles("crowding.cl", "crowding");
  pairs = {lazy("pairs.cl", "pairs", options + tiling.particles.build_options()), tiling.particles.own};
  const compute::Program time_step(device, files, "time_step.cl", options);
  derive = time_step.kernel("derive_state");
  predict = time_step.kernel("predict");
  correct = time_step.kernel("correct");
  compress = time_step.kernel("compress");
  move_packed = time_step.kernel("move_packed");
  go_on_trial = time_step.kernel("go_on_trial");
  take_sum = time_step.kernel("take_sum");
  predict_end = time_step.kernel("predict_end");
  correct_end = time_step.kernel("correct_end");
  const compute::Program reduce(device, files, "reduce.cl", options);
  watch_chunks = reduce.kernel("watch_chunks");
  watch_groups = reduce.kernel("watch_groups");
  watch_total = reduce.kernel("watch_total");
  guard_chunks = reduce.kernel("guard_chunks");
  guard_totals = reduce.kernel("guard_totals");
  energy_chunks = reduce.kernel("energy_chunks");
  packing_chunks = reduce.kernel("packing_chunks");
  sum_rows = reduce.kernel("sum_rows");
  wrench_chunks = reduce.kernel("wrench_chunks");
  wrench_totals = reduce.kernel("wrench_totals");
  facing_chunks = reduce.kernel("facing_chunks");
  facing_totals = reduce.kernel("facing_totals");
}

}  // namespace wavetank

#pragma once

#include <string>

#include "lazy_kernel.h"
#include "tiling.h"
#include "wavetank/compute/program.h"

namespace wavetank {

/// A kernel that goes over the neighbours of particles, points or walls, `own` of them an item.
struct SweepKernel {
  LazyKernel kernel;
  int own = 1;
};

/// The solver's kernels, but for those that helpers of it own.
struct SolverKernels {
  SolverKernels() = default;
  /// What every run needs is built at once, the sweeps when they are needed: `files` must be there for as long.
  SolverKernels(const compute::Device& device, const compute::SourceFiles& files, const std::string& options, const Tiling& tiling);

  SweepKernel continuity, momentum, gradient, loads, packing, points, surface, crowding, pairs, guard, wall_forces, facing_walls;
  compute::Kernel derive, predict, correct, compress, move_packed, go_on_trial, take_sum, predict_end, correct_end;
  compute::Kernel watch_chunks, watch_groups, watch_total, guard_chunks, guard_totals, energy_chunks, packing_chunks, sum_rows,
      wrench_chunks, wrench_totals, facing_chunks, facing_totals;
};

}  // namespace wavetank

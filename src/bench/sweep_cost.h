#pragma once

#include <string>
#include <vector>

#include "bench_case.h"

namespace wavetank::bench {

/// What one candidate of the neighbour loop costs a sweep, counted by hand from the kernels' sources.
struct SweepCost {
  std::string kernel;
  double flops = 0;  ///< additions, multiplications, maxima, divisions and square roots, each one
  double bytes = 0;  ///< loaded, if none of it is in registers
};

/// Of the sweeps over all particles that a step of the case has; of δ-SPH with the symplectic integrator, and without those of shifting:
/// the others are not counted.
std::vector<SweepCost> sweep_costs(const BenchCase& bench_case);

}  // namespace wavetank::bench

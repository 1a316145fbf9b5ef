#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench_case.h"
#include "series.h"
#include "start_up.h"
#include "wavetank/sph/pair_count.h"

namespace wavetank::bench {

/// Steps that were timed together.
struct Block {
  int steps = 0;
  double seconds = 0;               ///< wall clock
  std::vector<KernelTime> kernels;  ///< of these steps alone
  PairCount pairs;                  ///< at their end
};

struct KernelSeries {
  std::string kernel;
  Series milliseconds;  ///< a step
};

/// A sweep over the particles beside the device's limits, whatever these are.
struct SweepRate {
  std::string kernel;
  double flops_per_candidate = 0;
  double bytes_per_candidate = 0;  ///< loaded, from caches for the most part
  Series flops;                    ///< 1/s
  Series bytes;                    ///< 1/s
};

/// What the benchmark tells of a case. One value a block in every series.
struct Measurement {
  BenchCase bench_case;
  std::size_t particles = 0;
  int steps = 0;                   ///< in a block, at the least
  Series particle_steps;           ///< 1/s, of whole steps by the wall clock
  Series evaluations;              ///< particles/s, of the kernels that find the rates of change
  Series pairs;                    ///< true pairs/s, of the same kernels
  Series pairs_per_particle;       ///< within the support
  Series candidates_per_particle;  ///< that the neighbour loop goes through
  Series step_milliseconds;
  Series host_milliseconds;           ///< a step, outside of the kernels
  Series host_percent;                ///< of a step
  std::vector<KernelSeries> kernels;  ///< the dearest first
  std::vector<SweepRate> sweeps;
  double bytes_per_particle = 0;  ///< on the device
  StartUp start_up;
  double cold_build = 0;  ///< s; NaN if it was not measured
};

/// Whether a kernel is one of those that find all rates of change once a step.
bool is_evaluation(const std::string& kernel);

/// The series of these blocks.
Measurement summarised(const BenchCase& bench_case, std::size_t particles, const std::vector<Block>& blocks);

/// Steps on from where the simulation is, for `repeats` blocks after a few steps that are not counted. `stopped` is asked after each step;
/// once it is true, the blocks that are whole come back.
std::vector<Block> measure_blocks(Simulation& simulation, int repeats, const std::function<bool()>& stopped);

}  // namespace wavetank::bench

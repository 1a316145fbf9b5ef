#include "measurement.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <map>

#include "sweep_cost.h"

namespace wavetank::bench {
namespace {

constexpr int warm_up_steps = 3;
constexpr int least_steps = 5;
constexpr double least_seconds = 0.5;

/// Of a thing that took no time, none is known.
double rate(double amount, double seconds) { return seconds > 0 ? amount / seconds : std::numeric_limits<double>::quiet_NaN(); }

/// What was added from one list of times to a later one.
std::vector<KernelTime> difference(const std::vector<KernelTime>& later, const std::vector<KernelTime>& earlier) {
  std::map<std::string, KernelTime> before;
  for (const KernelTime& time : earlier) before[time.kernel] = time;
  std::vector<KernelTime> result;
  for (KernelTime time : later) {
    time.launches -= before[time.kernel].launches;
    time.seconds -= before[time.kernel].seconds;
    if (time.launches > 0) result.push_back(time);
  }
  return result;
}

const KernelTime* find(const Block& block, const std::string& kernel) {
  for (const KernelTime& time : block.kernels)
    if (time.kernel == kernel) return &time;
  return nullptr;
}

void add_block(Measurement& to, const Block& block) {
  const double particles = static_cast<double>(to.particles);
  double in_kernels = 0, in_evaluations = 0;
  for (const KernelTime& time : block.kernels) {
    in_kernels += time.seconds;
    if (is_evaluation(time.kernel)) in_evaluations += time.seconds;
  }
  to.particle_steps.values.push_back(rate(particles * block.steps, block.seconds));
  to.evaluations.values.push_back(rate(particles * block.steps, in_evaluations));
  to.pairs.values.push_back(rate(static_cast<double>(block.pairs.pairs) * block.steps, in_evaluations));
  to.pairs_per_particle.values.push_back(static_cast<double>(block.pairs.pairs) / particles);
  to.candidates_per_particle.values.push_back(static_cast<double>(block.pairs.candidates) / particles);
  to.step_milliseconds.values.push_back(1e3 * block.seconds / block.steps);
  to.host_milliseconds.values.push_back(1e3 * (block.seconds - in_kernels) / block.steps);
  to.host_percent.values.push_back(100 * (1 - in_kernels / block.seconds));
}

std::vector<KernelSeries> kernels_of(const std::vector<Block>& blocks) {
  std::map<std::string, Series> series;
  for (const Block& block : blocks)
    for (const KernelTime& time : block.kernels) series[time.kernel];
  for (auto& [kernel, values] : series)
    for (const Block& block : blocks) {
      const KernelTime* time = find(block, kernel);
      values.values.push_back(time != nullptr ? 1e3 * time->seconds / block.steps : 0);
    }
  std::vector<KernelSeries> result;
  result.reserve(series.size());
  for (const auto& [kernel, values] : series) result.push_back({kernel, values});
  std::stable_sort(result.begin(), result.end(),
                   [](const KernelSeries& a, const KernelSeries& b) { return a.milliseconds.median() > b.milliseconds.median(); });
  return result;
}

SweepRate sweep_rate(const SweepCost& cost, const std::vector<Block>& blocks) {
  SweepRate result{cost.kernel, cost.flops, cost.bytes, {}, {}};
  for (const Block& block : blocks) {
    const KernelTime* time = find(block, cost.kernel);
    if (time == nullptr) continue;
    const double candidates = rate(static_cast<double>(block.pairs.candidates) * static_cast<double>(time->launches), time->seconds);
    result.flops.values.push_back(cost.flops * candidates);
    result.bytes.values.push_back(cost.bytes * candidates);
  }
  return result;
}

}  // namespace

bool is_evaluation(const std::string& kernel) {
  return kernel == "momentum" || kernel == "rates_of_state" || kernel == "continuity" || kernel == "gradients" ||
         kernel == "surroundings" || kernel == "wall_loads";
}

Measurement summarised(const BenchCase& bench_case, std::size_t particles, const std::vector<Block>& blocks) {
  Measurement result;
  result.bench_case = bench_case;
  result.particles = particles;
  result.cold_build = std::numeric_limits<double>::quiet_NaN();
  for (const Block& block : blocks) {
    result.steps = result.steps == 0 ? block.steps : std::min(result.steps, block.steps);
    add_block(result, block);
  }
  result.kernels = kernels_of(blocks);
  for (const SweepCost& cost : sweep_costs(bench_case)) result.sweeps.push_back(sweep_rate(cost, blocks));
  return result;
}

std::vector<Block> measure_blocks(Simulation& simulation, int repeats, const std::function<bool()>& stopped) {
  using Clock = std::chrono::steady_clock;
  std::vector<Block> blocks;
  for (int step = 0; step < warm_up_steps && !stopped(); ++step) simulation.advance();
  while (static_cast<int>(blocks.size()) < repeats) {
    const std::vector<KernelTime> earlier = simulation.kernel_times();
    Block block;
    const Clock::time_point begin = Clock::now();
    while (block.steps < least_steps || block.seconds < least_seconds) {
      if (stopped()) return blocks;
      simulation.advance();  // ends with a download: the device is done with the step
      ++block.steps;
      block.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    }
    block.kernels = difference(simulation.kernel_times(), earlier);
    block.pairs = simulation.count_pairs();
    blocks.push_back(block);
  }
  return blocks;
}

}  // namespace wavetank::bench

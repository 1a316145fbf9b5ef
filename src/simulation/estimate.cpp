#include <algorithm>
#include <chrono>

#include "expected_waves.h"
#include "simulation_parts.h"
#include "wavetank/sph/parted_solver.h"

namespace wavetank {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// The middle of what each of several goes takes, which a hiccup of the machine does not change.
template <class Go>
double median_seconds(const Go& go) {
  constexpr int fewest = 5, most = 60;
  constexpr double enough = 0.6;  // s in all
  std::vector<double> laps;
  const Clock::time_point begin = Clock::now();
  while (static_cast<int>(laps.size()) < fewest || (static_cast<int>(laps.size()) < most && seconds_since(begin) < enough)) {
    const Clock::time_point lap = Clock::now();
    go();
    laps.push_back(seconds_since(lap));
  }
  const auto middle = laps.begin() + static_cast<std::ptrdiff_t>(laps.size() / 2);
  std::nth_element(laps.begin(), middle, laps.end());
  return *middle;
}

}  // namespace

double Simulation::Parts::loading_seconds() {
  constexpr double loading = 1.5;  // s: whatever took longer compiled
  const double spent = compiling.seconds();
  if (spent < loading) return spent;
  try {
    const Stopwatch::Lap lap(compiling);
    solver_on(chosen_devices());  // other devices keep no programs yet
  } catch (const Error&) {        // there is no room for two
    return 0;
  }
  return compiling.seconds() - spent;
}

Estimate estimate(const Case& checked, const SimulationOptions& options) {
  const Clock::time_point begin = Clock::now();
  Simulation::Parts parts(checked, options);
  Estimate result;
  result.start_seconds = seconds_since(begin) - parts.compiling.seconds();
  result.start_seconds += parts.loading_seconds();
  Solver& solver = *parts.solver;
  const NumericsCase& numerics = parts.scene.numerics;
  const auto unheard = [](double) {};
  if (numerics.packing.iterations > 0) {
    solver.pack(1, unheard);  // the first launch of a kernel may still compile it
    constexpr int iterations = 8;
    const Clock::time_point packing = Clock::now();
    solver.pack(iterations, unheard);
    result.start_seconds += seconds_since(packing) / iterations * numerics.packing.iterations;
  }
  parts.report = solver.start();
  try {
    parts.check_start();
  } catch (const Violation&) {  // which packing and settling, as the run does them, may cure: only then is it judged
    solver.pack(numerics.packing.iterations, unheard);
    parts.find_films();
    solver.start();
    parts.find_films();
    parts.report = solver.settle(numerics.packing.settling, unheard);
    parts.check_start();
  }
  parts.time_step = parts.report.time_step;
  if (parts.world.anything_moves()) solver.set_wall_motions(parts.coupling.now());
  parts.shorten_step();
  parts.step_on();
  const double step_seconds = median_seconds([&] {
    parts.shorten_step();
    parts.step_on();
  });

  result.particles = parts.layout.particles.size();
  result.wall_elements = walls_in_use(parts.scene, parts.layout);
  result.lid_elements = parts.layout.lid.size();
  result.device_memory = static_cast<double>(solver.device_memory());
  result.size = size_of(parts.scene, parts.layout, parts.world);
  if (const std::optional<ThinWall> wall = solver.thinnest_wall()) result.thinnest_wall = wall->thickness;
  result.waves = expected_waves(parts.scene, parts.layout, options.resolve);
  result.spacing = parts.layout.spacing;
  result.time_step = std::min(
      {parts.discretisation.acoustic_time, parts.discretisation.viscous_time, parts.coupling.longest_time_step(), parts.time_step});
  result.start_seconds += numerics.packing.settling * parts.discretisation.sound_period / result.time_step * step_seconds;
  const double steps = parts.scene.duration / result.time_step;
  result.step_seconds = steps * step_seconds;
  result.instrument_seconds = steps * parts.recorder.seconds_a_step(solver, result.time_step);
  result.wall_seconds = result.start_seconds + result.step_seconds + result.instrument_seconds;
  return result;
}

PartsEstimate estimate_parts(const Case& checked, int parts, const SimulationOptions& options) {
  const Layout layout = lay_out(checked, options.resolve);
  const Case scene = settled(checked, layout);
  const compute::Device device(compute::choose_devices(scene.device)[0]);
  return {layout.spacing, layout.particles.size(), need_of_parts(parts, device, scene, layout, discretise(scene, layout))};
}

}  // namespace wavetank

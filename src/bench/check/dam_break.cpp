#include "dam_break.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "../bench_case.h"
#include "wavetank/simulation/simulation.h"

namespace wavetank::bench {
namespace {

constexpr double flow_time = 1.0;             // s
constexpr double spacing_of_dam = 0.55 / 18;  // m: 24 thousand particles
constexpr double impulse_from = 0.35;         // s, as config/spheric2_key_figures.csv has it

/// Lost at most, J: all of the potential energy over that of the same water spread over the floor of the tank.
double spendable_energy(const EnergySample& start, double depth, double spread_depth) {
  return start.mass * 9.81 * 0.5 * (depth - spread_depth);
}

Case dam_break_for(const compute::DeviceInfo& device) {
  BenchCase spheric2;
  spheric2.name = "dam break";
  spheric2.spacing = spacing_of_dam;
  spheric2.smoothing = 1.5;
  Case scene = make_case(spheric2, device.indices());
  scene.instruments.pressure_probes = {{"P1", Vector3d(0.8245, 0.4745, 0.021), "box"}, {"P2", Vector3d(0.8245, 0.4745, 0.061), "box"}};
  scene.instruments.wave_gauges = {{"x1488mm", Vector3d(1.488, 0.5, 0)}, {"x2638mm", Vector3d(2.638, 0.5, 0)}};
  scene.instruments.rate = 1000;
  scene.instruments.gauge_rate = 200;
  scene.instruments.energy_rate = 100;
  scene.instruments.wrench_rate = 1e-3;
  return scene;
}

/// When a value first exceeds a limit, s; NaN if it never does.
template <class Sample, class Value>
double arrival(const std::vector<Sample>& samples, double limit, const Value& value) {
  for (const Sample& sample : samples)
    if (value(sample) > limit) return sample.time;
  return std::numeric_limits<double>::quiet_NaN();
}

double sum_of(const EnergySample& energies) { return energies.kinetic + energies.potential + energies.compression; }

/// Particles that are not in the tank, whose guard keeps spray over it.
std::size_t outside(const ParticleCloud& cloud, const Box& tank) {
  return static_cast<std::size_t>(std::count_if(cloud.position.begin(), cloud.position.end(), [&](const Eigen::Vector3f& position) {
    const Vector3d place = position.cast<double>();
    const bool within = (place.head<2>().array() >= tank.min.head<2>().array()).all() &&
                        (place.head<2>().array() <= tank.max.head<2>().array()).all() && place.z() >= tank.min.z();
    return !within;
  }));
}

std::vector<Check> key_figures(const Case& scene) {
  Simulation simulation(scene);
  const std::size_t particles = simulation.state().particles;
  while (simulation.state().time < flow_time) simulation.advance();
  const Samples samples = simulation.take_samples();

  const auto probe = [](std::size_t index) { return [index](const PressureSample& sample) { return sample.pressures[index]; }; };
  const auto gauge = [](std::size_t index) { return [index](const LevelSample& sample) { return sample.levels[index]; }; };
  double peak = 0, impulses[2] = {0, 0};
  for (const PressureSample& sample : samples.pressures) {
    peak = std::max(peak, sample.pressures[0]);
    for (std::size_t k = 0; k < 2 && sample.time >= impulse_from; ++k) impulses[k] += sample.pressures[k] * 1e-3;
  }
  const EnergySample first = samples.energies.front(), last = samples.energies.back();
  double most = 0;
  for (const EnergySample& sample : samples.energies) most = std::max(most, sum_of(sample));
  const BoxTank tank = std::get<BoxTank>(simulation.scene().tank.shape);
  const double volume = first.mass / simulation.scene().fluid.density, floor = tank.size.x() * tank.size.y();
  const double spendable = spendable_energy(first, 2 * first.potential / (first.mass * 9.81), volume / floor);

  const ParticleCloud cloud = simulation.particles();
  // What was found on pocl, and how far a device may be from it. Gravity changed by 1e-6 or Δt by 1e-5, much more than rounding, moves no
  // front by a sample, the pressures' peak and impulses by 0.1 %, and the shares of energy by 0.0002.
  const auto near = [](const std::string& what, double value, double found, double allowed, const char* unit) {
    return Check{what, value, found - allowed, found + allowed, unit};
  };
  const char* const share = "of what can be lost";
  return {near("particles after 1 s", static_cast<double>(cloud.id.size()), static_cast<double>(particles), 0, ""),
          near("particles outside the tank", static_cast<double>(outside(cloud, {tank.origin, tank.origin + tank.size})), 0, 0, ""),
          near("change of mass in 1 s", last.mass / first.mass - 1, 0, 1e-6, "of the mass"),
          near("front at x = 1.488 m", arrival(samples.levels, 0.02, gauge(0)), 0.245, 0.01, "s"),
          near("front at the box", arrival(samples.pressures, 500, probe(0)), 0.413, 0.004, "s"),
          near("greatest pressure at P1", peak, 20640, 400, "Pa"),
          near("impulse of P1, 0.35 to 1 s", impulses[0], 3242, 65, "Pa s"),
          near("impulse of P2, 0.35 to 1 s", impulses[1], 2513, 50, "Pa s"),
          near("level at x = 2.638 m after 1 s", samples.levels.back().levels[1], 0.2786, 0.003, "m"),
          {"greatest gain of energy", (most - sum_of(first)) / spendable, 0, 1e-3, share},  // as test/simulation/energy_balance_test.cpp
          near("energy lost in 1 s", (sum_of(first) - sum_of(last)) / spendable, 0.17, 0.005, share),
          near("kinetic energy after 1 s", last.kinetic / spendable, 0.619, 0.005, share)};
}

}  // namespace

std::vector<Check> check_dam_break(const compute::DeviceInfo& device) { return key_figures(dam_break_for(device)); }

}  // namespace wavetank::bench

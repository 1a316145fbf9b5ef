// Openings: what comes in and leaves, at rest and in a current.
#include <map>
#include <numeric>

#include "simulation_fixture.h"

namespace wavetank {
namespace {

constexpr double depth = 0.4, spacing = 0.04;

OpeningCase opening(const std::string& name, OpeningKind kind, const Vector3d& centre, const Vector3d& normal, double height) {
  OpeningCase result;
  result.name = name;
  result.kind = kind;
  result.centre = centre;
  result.normal = normal;
  result.size = std::array<double, 2>{1.0, height};
  return result;
}

/// A tank of 1.2 m × 0.6 m, with a hole over the whole height of its right end.
Case tank_with_outlet() {
  Case scene = box_case(Vector3d(1.2, 0, 0.6), depth, spacing);
  scene.duration = 4;
  scene.openings = {opening("end", OpeningKind::outlet, Vector3d(1.2, 0, 0.3), -Vector3d::UnitX(), 0.6)};
  scene.openings[0].level = depth;
  return scene;
}

/// The same, with water that comes in at the left and leaves at the right.
Case channel(const std::string& velocity) {
  Case scene = tank_with_outlet();
  scene.numerics.walls.slip = Slip::free_slip;
  OpeningCase inlet = opening("start", OpeningKind::inlet, Vector3d(0, 0, 0.3), Vector3d::UnitX(), 0.6);
  inlet.velocity = velocity;
  inlet.level = depth;
  scene.openings.insert(scene.openings.begin(), inlet);
  return scene;
}

double mass_of(const Simulation& simulation) { return simulation.energies().mass; }

struct Balance {
  double in = 0, out = 0;
};

Balance balance_of(const Simulation& simulation) {
  Balance balance;
  for (const OpeningState& state : simulation.openings()) {
    balance.in += state.mass_in;
    balance.out += state.mass_out;
  }
  return balance;
}

using Openings = SimulationTest;

TEST_F(Openings, StillWaterAtItsOutletsLevelStaysStill) {
  Simulation simulation(tank_with_outlet());
  double fastest = 0;
  while (simulation.state().time < 2) {
    simulation.advance();
    fastest = std::max(fastest, simulation.state().greatest_speed);
  }
  std::printf("fastest %g at last %g; in %g out %g kg\n", fastest, simulation.state().greatest_speed, balance_of(simulation).in, balance_of(simulation).out);
  EXPECT_LT(fastest, 0.02 * std::sqrt(9.81 * depth));
}

TEST_F(Openings, AChannelKeepsItsDepthAndItsMass) {
  Case scene = channel("0.4");
  scene.fluid.current = Vector3d(0.4, 0, 0);
  scene.instruments.wave_gauges = {{"a", Vector3d(0.3, 0, 0)}, {"b", Vector3d(0.9, 0, 0)}};
  Simulation simulation(scene);
  const double mass = mass_of(simulation);
  while (simulation.state().time < 4) simulation.advance();
  const Balance balance = balance_of(simulation);
  const Samples samples = simulation.take_samples();
  std::printf("mass %.6f → %.6f, in %.6f out %.6f: %.2e; levels %g %g\n", mass, mass_of(simulation), balance.in, balance.out,
              (mass + balance.in - balance.out - mass_of(simulation)) / mass, samples.levels.back().levels[0], samples.levels.back().levels[1]);
  for (std::size_t k = 0; k < samples.levels.size(); k += samples.levels.size() / 20)
    std::printf("t %.2f levels %.4f %.4f Q %.4f %.4f\n", samples.levels[k].time, samples.levels[k].levels[0], samples.levels[k].levels[1],
                samples.flows[k].flows[0].discharge, samples.flows[k].flows[1].discharge);
  EXPECT_NEAR(mass + balance.in - balance.out, mass_of(simulation), 1e-6 * mass);
  for (const double level : samples.levels.back().levels) EXPECT_NEAR(level, depth, spacing);
}

}  // namespace
}  // namespace wavetank

// What tank and bodies at rest cannot give: the water's energies never add up to more than at the start.
#include "simulation_fixture.h"

namespace wavetank::energy_balance_test {
namespace {

/// The greatest sum of the three energies over the first, less the first, of the energy that the water can lose.
double greatest_gain(const Case& scene, double duration, double spendable) {
  Simulation simulation(scene);
  const Samples samples = run_to(simulation, duration);
  const auto sum = [](const EnergySample& e) { return e.kinetic + e.potential + e.compression; };
  const double first = sum(samples.energies.front());
  double greatest = first;
  for (const EnergySample& sample : samples.energies) greatest = std::max(greatest, sum(sample));
  std::printf("%s: at the start %.4g J, at the most %.4g J, at the end %.4g J\n", scene.title.c_str(), first, greatest,
              sum(samples.energies.back()));
  return (greatest - first) / spendable;
}

// Water that falls onto an obstacle and is torn into spray.
TEST(EnergyBalance, OfSpray) {
  for (const EquationOfState law : {EquationOfState::linear, EquationOfState::cole})
    for (const NegativePressure tension : {NegativePressure::clamped, NegativePressure::allowed}) {
      Case scene = box_case(Vector3d(0.6, 0, 1), 0.1, 0.02);
      scene.title = "falling block";
      scene.fluid.sound_speed = 30;
      scene.fluid.fill = {Box{Vector3d(0.2, 0, 0.45), Vector3d(0.4, 0, 0.75)}};
      scene.bodies.push_back({"step", Box{Vector3d(0.28, 0, 0.1), Vector3d(0.4, 0, 0.2)}, Motion::fixed});
      scene.numerics.equation_of_state = law;
      scene.numerics.negative_pressure = tension;
      scene.instruments.rate = 200;
      const double spendable = 1000 * 0.2 * 0.3 * 9.81 * 0.6;
      EXPECT_LT(greatest_gain(scene, 0.7, spendable), 1e-3);
    }
}

TEST(EnergyBalance, OfADamBreak) {
  Case scene = dam_break(0.02);
  scene.title = "dam break";
  scene.numerics.artificial_viscosity = 0.02;
  const double spendable = 1000 * 0.4 * 0.4 * 9.81 * 0.2;
  EXPECT_LT(greatest_gain(scene, 1.0, spendable), 1e-3);
}

}  // namespace
}  // namespace wavetank::energy_balance_test

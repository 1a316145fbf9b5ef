// The acoustic damper takes sound away as a bulk viscosity does, and nothing else.
#include <cmath>
#include <complex>

#include "periodic_square.h"

namespace wavetank::acoustic_damper_test {
namespace {

constexpr double side = PeriodicSquare::side, sound_speed = PeriodicSquare::sound_speed, wave_number = 2 * M_PI / side;

NumericsCase damped(Scheme scheme, double damping) {
  NumericsCase numerics;
  numerics.scheme = scheme;
  numerics.acoustic_damping = damping;
  return numerics;
}

struct DampedSquare : PeriodicSquare {
  DampedSquare(Scheme scheme, double damping) : PeriodicSquare(0.025, damped(scheme, damping)) {}
  /// u and w by place, at no pressure.
  template <class Velocity>
  void set(const Velocity& velocity) {
    StateBytes<float> state(*solver);
    for (std::size_t i = 0; i < state.count; ++i) {
      const auto [u, w] = velocity(state.get("x", i) + discretisation.origin.x(), state.get("z", i) + discretisation.origin.z());
      state.set("u", i, u);
      state.set("w", i, w);
    }
    solver->restore(state.bytes());
  }
  /// Kinetic energy and that of compression, after a time.
  double energy_after(double duration) {
    for (double time = 0; time < duration;) {
      const double step = std::min(solver->shorten_step(duration - time + 1e-9), duration - time + 1e-9);
      time += step;
      EXPECT_TRUE(solver->advance().valid());
    }
    const FluidEnergies energies = solver->energies();
    return energies.kinetic + energies.compression;
  }
};

/// How fast the energy of a standing sound wave decays, 1/s, over a whole period of it.
double decay(Scheme scheme, double damping) {
  DampedSquare square(scheme, damping);
  square.set([](double x, double) { return std::array<double, 2>{0.1 * std::sin(wave_number * x), 0.0}; });
  const double period = side / sound_speed, before = square.energy_after(1e-6);
  return std::log(before / square.energy_after(period)) / period;
}

/// The same of u_tt = c₀² (u + τ u_t)_xx, τ = α₂ h/c₀: c₀² τ k² while that is small against c₀ k.
double decay_in_theory(double damping, double smoothing) {
  const double frequency = sound_speed * wave_number, period = side / sound_speed;
  const double rate = 0.5 * damping * smoothing * sound_speed * wave_number * wave_number;
  const std::complex<double> root = std::sqrt(std::complex<double>(rate * rate - frequency * frequency, 0));
  const std::complex<double> one = root - rate, other = -root - rate;  // u = (A e^one t + B e^other t), u(0) = 1, u'(0) = −2 rate
  const std::complex<double> a = (-2 * rate - other) / (one - other), b = 1.0 - a;
  const std::complex<double> u = a * std::exp(one * period) + b * std::exp(other * period);
  const std::complex<double> slope = a * one * std::exp(one * period) + b * other * std::exp(other * period);
  const double pressure = std::real(-slope - 2 * rate * u) / frequency;  // over ρ₀ c₀
  return -std::log(std::real(u) * std::real(u) + pressure * pressure) / period;
}

/// The sums' own gradients of this wave are a few hundredths too small.
TEST(AcousticDamper, TakesSoundAwayAsABulkViscosityDoes) {
  for (const MethodWord<Scheme>& known : method_words<Scheme>()) {
    const double without = decay(known.choice, 0);
    for (const double damping : {0.5, 2.0, 6.0}) {  // with the last steps are shorter
      const double smoothing = DampedSquare(known.choice, damping).discretisation.smoothing_length;
      const double expected = decay_in_theory(damping, smoothing);
      const double found = decay(known.choice, damping) - without;
      std::printf("%-18s alpha_2 = %.1f: the energy of sound decays by %.2f/s, %.2f/s without; by theory %.2f/s\n", known.word, damping,
                  found, without, expected);
      EXPECT_NEAR(found, expected, 0.1 * expected) << known.word;
    }
  }
}

/// Of a standing sound wave, which loses a third of its energy.
TEST(AcousticDamper, TellsWhatItTakes) {
  DampedSquare square(Scheme::delta_sph, 0.5);
  square.set([](double x, double) { return std::array<double, 2>{0.1 * std::sin(wave_number * x), 0.0}; });
  const double before = square.energy_after(1e-6), period = side / sound_speed;
  double taken = 0, after = before, power = square.solver->energies().damper_power;
  constexpr int readings = 100;
  for (int k = 0; k < readings; ++k) {
    after = square.energy_after(period / readings);
    const double next = square.solver->energies().damper_power;
    taken += 0.5 * (power + next) * period / readings;
    power = next;
  }
  std::printf("energy lost %.4g J/m, of %.4g; taken by the damper %.4g J/m\n", before - after, before, taken);
  EXPECT_NEAR(taken, before - after, 0.03 * (before - after));
}

/// With the other terms of a case as they are unless it says otherwise, in 3-D, and damping far beyond what the usual step bears.
TEST(AcousticDamper, LeavesWaterThatFallsFinite) {
  for (const int dimensions : {2, 3}) {
    Case scene = box_case(Vector3d(0.6, dimensions == 3 ? 0.2 : 0, 0.6), 0.4, 0.04);
    scene.fluid.fill = {Box{Vector3d::Zero(), Vector3d(0.3, dimensions == 3 ? 0.2 : 0, 0.4)}};
    scene.numerics.acoustic_damping = 8;
    Tank tank(scene);
    tank.pack_and_start(20);
    const double before = tank.solver->energies().potential;
    for (double time = 0; time < 0.3;) {
      const StepReport report = tank.solver->advance();
      ASSERT_TRUE(report.valid());
      time += report.time_step;
    }
    const FluidEnergies after = tank.solver->energies();
    EXPECT_LT(after.kinetic, before - after.potential) << "energy came from nowhere";
    EXPECT_GT(after.kinetic, 0.5 * (before - after.potential)) << "the water hardly falls";
  }
}

/// In vortices there is no sound to take away.
TEST(AcousticDamper, LeavesVorticesAlone) {
  const auto energy = [](double damping) {
    DampedSquare square(Scheme::delta_sph, damping);
    square.set([](double x, double z) {
      return std::array<double, 2>{std::sin(wave_number * x) * std::cos(wave_number * z),
                                   -std::cos(wave_number * x) * std::sin(wave_number * z)};
    });
    const double before = square.solver->energies().kinetic;
    square.energy_after(0.05);
    return square.solver->energies().kinetic / before;
  };
  const double without = energy(0), with = energy(2);
  std::printf("of the vortices' energy is left: %.4f without the damper, %.4f with\n", without, with);
  EXPECT_NEAR(with, without, 0.004);
}

}  // namespace
}  // namespace wavetank::acoustic_damper_test

// What the water's energies count.
#include "sph_fixture.h"

namespace wavetank::energies_test {
namespace {

/// Particles without walls whose compression is set.
class Loose {
 public:
  Loose(EquationOfState law, NegativePressure tension, Precision precision) : tank_(scene(law, tension, precision), layout()) {
    tank_.solver->start();
  }

  /// The compression energy over c₀² and mass of particles that all have the compression s.
  double stored(double s) {
    if (tank_.scene.numerics.precision == Precision::single)
      set(StateBytes<float>(*tank_.solver), s);
    else
      set(StateBytes<double>(*tank_.solver), s);
    const FluidEnergies energies = tank_.solver->energies();
    return energies.compression / (energies.mass * sound_speed * sound_speed);
  }

 private:
  static constexpr double sound_speed = 20;
  static Case scene(EquationOfState law, NegativePressure tension, Precision precision) {
    Case scene = box_case(Vector3d(1, 0, 1), 0.5, 0.1);
    scene.gravity = Vector3d::Zero();
    scene.fluid.sound_speed = sound_speed;
    scene.numerics.equation_of_state = law;
    scene.numerics.negative_pressure = tension;
    scene.numerics.precision = precision;
    return scene;
  }
  static Layout layout() {
    return loose_particles({Vector3d::Zero(), Vector3d(1, 0, 1)}, 0.1, {{0.3, 0, 0.3}, {0.7, 0, 0.7}, {0.3, 0, 0.7}}, 2);
  }
  template <class State>
  void set(State state, double s) {
    for (std::size_t i = 0; i < tank_.solver->particle_count(); ++i) state.set("compression", i, s);
    tank_.solver->restore(state.bytes());
  }
  Tank tank_;
};

/// ∫ p/ρ² dρ/c₀² from rest, by Simpson's rule.
double work(EquationOfState law, double s) {
  const int pieces = 2000;
  double sum = 0;
  for (int k = 0; k <= pieces; ++k) {
    const double t = s * k / pieces;
    const double pressure = law == EquationOfState::cole ? (std::pow(1 + t, 7) - 1) / 7 : t;
    sum += (k == 0 || k == pieces ? 1 : k % 2 ? 4 : 2) * pressure / ((1 + t) * (1 + t));
  }
  return sum * s / (3.0 * pieces);
}

struct Kind {
  const char* name;
  EquationOfState law;
  NegativePressure tension;
  Precision precision;
};

class CompressionEnergy : public ::testing::TestWithParam<Kind> {};

TEST_P(CompressionEnergy, IsTheWorkOfThePressure) {
  const Kind& kind = GetParam();
  if (!has_precision(kind.precision)) GTEST_SKIP() << "this device has no double precision";
  Loose particles(kind.law, kind.tension, kind.precision);
  for (const double s : {1e-6, 0.001, 0.02, 0.029, 0.031, 0.1, 0.3}) {
    const double exact = work(kind.law, s);
    EXPECT_NEAR(particles.stored(s), exact, 2e-4 * exact) << s;
    const double tension = kind.tension == NegativePressure::allowed ? work(kind.law, -s) : 0;
    EXPECT_NEAR(particles.stored(-s), tension, 2e-4 * tension) << -s;
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, CompressionEnergy,
                         ::testing::Values(Kind{"Linear", EquationOfState::linear, NegativePressure::clamped, Precision::single},
                                           Kind{"LinearInTension", EquationOfState::linear, NegativePressure::allowed, Precision::double_},
                                           Kind{"Cole", EquationOfState::cole, NegativePressure::clamped, Precision::double_},
                                           Kind{"ColeInTension", EquationOfState::cole, NegativePressure::allowed, Precision::single}),
                         [](const ::testing::TestParamInfo<Kind>& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace wavetank::energies_test

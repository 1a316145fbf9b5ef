// Variants of one term against each other: alike where their difference does not count, and apart by what theory says where it does.
#include <algorithm>
#include <cmath>

#include "sph_fixture.h"

namespace wavetank {
namespace {

constexpr double side = 1, wave_number = 2 * M_PI / side, sound = 10, rest_density = 1000;

/// A square of water that is periodic both ways, on the lattice, without anything that damps it but what a test adds.
Case square(double spacing) {
  Case scene = box_case(Vector3d(side, 0, side), side, spacing);
  scene.gravity = Vector3d::Zero();
  scene.tank.periodic = {true, false, true};
  scene.fluid.density = rest_density;
  scene.fluid.sound_speed = sound;
  scene.numerics.precision = Precision::double_;
  scene.numerics.courant = 1;
  scene.numerics.packing.iterations = 0;
  scene.numerics.density_diffusion = DensityDiffusion::none;
  scene.numerics.negative_pressure = NegativePressure::allowed;
  scene.numerics.artificial_viscosity = 0;
  return scene;
}

/// The water after `steps` equal steps over `duration`, by id.
FluidState after(const Case& scene, double duration, int steps) {
  Tank tank(scene);
  tank.solver->start();
  const double step = duration / steps;
  tank.solver->limit_time_step(step);
  tank.solver->shorten_step(step);
  for (int k = 0; k < steps; ++k)
    EXPECT_NEAR(tank.solver->advance().time_step, step, 1e-6 * step) << "the step is bounded by something else";
  const FluidState unsorted = tank.solver->download();
  FluidState fluid = unsorted;
  for (std::size_t i = 0; i < unsorted.id.size(); ++i) {
    fluid.position[unsorted.id[i]] = unsorted.position[i];
    fluid.velocity[unsorted.id[i]] = unsorted.velocity[i];
  }
  return fluid;
}

/// The greatest difference of the velocities over the greatest velocity.
double difference(const FluidState& a, const FluidState& b) {
  double apart = 0, greatest = 0;
  for (std::size_t i = 0; i < a.velocity.size(); ++i) {
    apart = std::max(apart, (a.velocity[i] - b.velocity[i]).norm());
    greatest = std::max(greatest, a.velocity[i].norm());
  }
  return apart / greatest;
}

/// A standing sound wave of a compression, given as a pressure, for a quarter of its period.
FluidState sound_wave(double compression, EquationOfState equation, Precision precision = Precision::double_) {
  Case scene = square(0.05);
  scene.numerics.equation_of_state = equation;
  scene.numerics.precision = precision;
  scene.fluid.initial.pressure = std::to_string(rest_density * sound * sound * compression) + "*cos(2*pi*x)";
  return after(scene, 0.25 * side / sound, 32);
}

// The stiffness at the compression s is c₀² by the one and c₀² (1 + s)⁶ by the other: what they differ by grows as s does.
TEST(AlikeVariants, EquationsOfStateAreOneAtSmallCompressions) {
  if (!has_precision(Precision::double_)) GTEST_SKIP() << "needs double precision";
  const auto apart = [](double s) { return difference(sound_wave(s, EquationOfState::linear), sound_wave(s, EquationOfState::cole)); };
  const double small = apart(1e-4), large = apart(1e-3);
  std::printf("velocities by Cole's equation differ from the linear one's by %.2e at a compression of 1e-4, %.2e at 1e-3\n", small, large);
  EXPECT_LT(small, 6e-4) << "6 s";
  EXPECT_NEAR(large / small, 10, 0.5);
}

// A shear wave u(z) dies away as exp(−ν k² t) by either sum.
TEST(AlikeVariants, ViscositiesBrakeAShearWaveAlike) {
  if (!has_precision(Precision::double_)) GTEST_SKIP() << "needs double precision";
  constexpr double viscosity = 50, duration = 0.01;
  std::vector<double> rates;
  for (const ViscosityModel model : {ViscosityModel::monaghan_gingold, ViscosityModel::morris}) {
    Case scene = square(0.025);
    scene.fluid.viscosity = viscosity;
    scene.numerics.viscosity_model = model;
    scene.fluid.initial.u = "0.1*sin(2*pi*z)";
    const FluidState fluid = after(scene, duration, 16);
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < fluid.velocity.size(); ++i) {
      const double wave = std::sin(wave_number * fluid.position[i].z());
      sum += fluid.velocity[i].x() * wave;
      squares += 0.1 * wave * wave;
    }
    rates.push_back(-std::log(sum / squares) / duration / (viscosity / rest_density * wave_number * wave_number));
  }
  std::printf("a shear wave dies away %.4f times as fast as by theory with monaghan_gingold, %.4f with morris\n", rates[0], rates[1]);
  for (const double rate : rates) EXPECT_NEAR(rate, 1, 0.03);  // of the order (k h)²/12 and (Δx/h)²: h = 2 Δx
  EXPECT_NEAR(rates[0] / rates[1], 1, 0.02);
}

TEST(AlikeVariants, PrecisionsDifferByRounding) {
  if (!has_precision(Precision::double_)) GTEST_SKIP() << "needs double precision";
  const double apart = difference(sound_wave(0.01, EquationOfState::linear), sound_wave(0.01, EquationOfState::linear, Precision::single));
  std::printf("velocities in single precision differ by %.2e from those in double\n", apart);
  EXPECT_LT(apart, 1e-4) << "some hundred roundings of 6e-8";
  EXPECT_GT(apart, 1e-9) << "the same bits: both are in one precision";
}

}  // namespace
}  // namespace wavetank

// Variants of one term against each other: alike where their difference does not count, and apart by what theory says where it does.
#include <algorithm>
#include <cmath>

#include "sph_fixture.h"

namespace wavetank::alike_variants_test {
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
  EXPECT_GT(small, 1e-5) << "the same equation twice";
  EXPECT_NEAR(large / small, 10, 0.5);
}

/// How fast a sum over the square lattice brakes u(z) = sin(k z), over ν k²: F times 2 by Morris, times 2(d + 2) x²/r² by Monaghan and
/// Gingold.
double braking_on_lattice(ViscosityModel model, double spacing, double support) {
  const double h = support / 2, alpha = 7 / (4 * M_PI * h * h);
  const int reach = static_cast<int>(support / spacing) + 1;
  double sum = 0;
  for (int i = -reach; i <= reach; ++i)
    for (int j = -reach; j <= reach; ++j) {
      const double x = i * spacing, z = j * spacing, r = std::hypot(x, z);
      if (r == 0 || r >= support) continue;
      const double slope = 5 * alpha / (h * h) * std::pow(1 - r / support, 3);
      sum += slope * (model == ViscosityModel::morris ? 2 : 8 * x * x / (r * r)) * (1 - std::cos(wave_number * z)) * spacing * spacing;
    }
  return sum / (wave_number * wave_number);
}

// A shear wave u(z) dies away as exp(−ν k² t), less what either sum lacks on this lattice: 1 % and 5 %.
TEST(AlikeVariants, ViscositiesBrakeAShearWaveAlike) {
  if (!has_precision(Precision::double_)) GTEST_SKIP() << "needs double precision";
  constexpr double viscosity = 50, duration = 0.01, speed = 0.1, spacing = 0.025;
  for (const ViscosityModel model : {ViscosityModel::monaghan_gingold, ViscosityModel::morris}) {
    Case scene = square(spacing);
    scene.fluid.viscosity = viscosity;
    scene.numerics.viscosity_model = model;
    scene.numerics.support = 4;
    scene.fluid.initial.u = std::to_string(speed) + "*sin(2*pi*z)";
    const FluidState fluid = after(scene, duration, 16);
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < fluid.velocity.size(); ++i) {
      const double wave = std::sin(wave_number * fluid.position[i].z());
      sum += fluid.velocity[i].x() * wave;
      squares += speed * wave * wave;
    }
    const double rate = -std::log(sum / squares) / duration / (viscosity / rest_density * wave_number * wave_number);
    const double expected = braking_on_lattice(model, spacing, 4 * spacing);
    std::printf("%s: a shear wave dies away %.4f times as fast as by theory, %.4f by the sum on the lattice\n", word_of(model).c_str(),
                rate, expected);
    EXPECT_NEAR(rate, expected, 2e-3) << "the lattice is sheared by a 25th of the spacing meanwhile";
    EXPECT_NEAR(rate, 1, model == ViscosityModel::morris ? 0.01 : 0.05);
  }
}

TEST(AlikeVariants, PrecisionsDifferByRounding) {
  if (!has_precision(Precision::double_)) GTEST_SKIP() << "needs double precision";
  const double apart = difference(sound_wave(0.01, EquationOfState::linear), sound_wave(0.01, EquationOfState::linear, Precision::single));
  std::printf("velocities in single precision differ by %.2e from those in double\n", apart);
  EXPECT_LT(apart, 1e-5) << "some roundings of 6e-8 in each of 32 steps";
  EXPECT_GT(apart, 1e-9) << "the same bits: both are in one precision";
}

}  // namespace
}  // namespace wavetank::alike_variants_test

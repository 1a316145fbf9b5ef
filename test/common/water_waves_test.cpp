// Theory of waves: the fields fulfil what they are solutions of.
#include "wavetank/common/water_waves.h"

#include <gtest/gtest.h>

#include <cmath>

namespace wavetank::water_waves_test {
namespace {

constexpr double depth = 0.4, gravity = 9.81, step = 1e-5;

WaveField regular(double height, double length, bool second_order) {
  WaveField field;
  field.second_order = second_order;
  field.depth = depth;
  field.height = height;
  field.gravity = gravity;
  field.wave_number = 2 * M_PI / length;
  return field;
}

WaveField solitary(double height) {
  WaveField field;
  field.kind = WaveField::Kind::solitary;
  field.depth = depth;
  field.height = height;
  field.gravity = gravity;
  return field;
}

/// ∂u/∂along + ∂w/∂up, 1/s.
double divergence(const WaveField& field, double along, double up) {
  return (field.velocity(along + step, up).x() - field.velocity(along - step, up).x() + field.velocity(along, up + step).y() -
          field.velocity(along, up - step).y()) /
         (2 * step);
}

double rotation(const WaveField& field, double along, double up) {
  return (field.velocity(along, up + step).x() - field.velocity(along, up - step).x() - field.velocity(along + step, up).y() +
          field.velocity(along - step, up).y()) /
         (2 * step);
}

/// By how much the surface is no streamline of what travels with the wave: w − (u − c) η′, m/s.
double leak(const WaveField& field, double along) {
  const double eta = field.elevation(along), slope = (field.elevation(along + step) - field.elevation(along - step)) / (2 * step);
  const Eigen::Vector2d velocity = field.velocity(along, eta);
  return velocity.y() - (velocity.x() - field.celerity()) * slope;
}

double worst_leak(const WaveField& field) {
  double worst = 0;
  for (double along = -2; along <= 2; along += 0.05) worst = std::max(worst, std::abs(leak(field, along)));
  return worst;
}

TEST(WaveFields, HaveNoDivergenceNoFlowThroughTheFloorAndNoPressureAtTheSurface) {
  for (const WaveField& field : {regular(0.05, 2, false), regular(0.05, 2, true), solitary(0.12)})
    for (double along = -1.5; along <= 1.5; along += 0.3) {
      for (const double up : {-0.35, -0.2, -0.02}) EXPECT_NEAR(divergence(field, along, up), 0, 1e-6);
      EXPECT_NEAR(field.velocity(along, -depth).y(), 0, 1e-12);
      EXPECT_NEAR(field.pressure_over_density(along, field.elevation(along)), 0, 1e-12);
    }
}

// What is left grows with the square of the height by linear theory and with the cube by the second order's.
TEST(WaveFields, OfHigherOrderFulfilTheConditionAtTheSurfaceToHigherOrder) {
  const double linear = worst_leak(regular(0.04, 2, false)) / worst_leak(regular(0.02, 2, false));
  const double second = worst_leak(regular(0.04, 2, true)) / worst_leak(regular(0.02, 2, true));
  EXPECT_NEAR(linear, 4, 0.3);
  EXPECT_NEAR(second, 8, 0.8);
  EXPECT_LT(worst_leak(regular(0.02, 2, true)), 0.3 * worst_leak(regular(0.02, 2, false)));
  for (double along = -1; along <= 1; along += 0.25) {
    EXPECT_NEAR(rotation(regular(0.05, 2, true), along, -0.1), 0, 1e-6);
    EXPECT_NEAR(leak(solitary(0.12), along), 0, 1e-6) << "exactly, of the solitary wave";
  }
}

TEST(WaveFields, AreAsHighAndAsFastAsTheyAreSaidToBe) {
  EXPECT_DOUBLE_EQ(solitary(0.12).elevation(0), 0.12);
  EXPECT_NEAR(solitary(0.12).celerity(), std::sqrt(gravity * 0.52), 1e-12);
  const WaveField wave = regular(0.05, 2, true);
  EXPECT_NEAR(wave.elevation(0) - wave.elevation(1), 0.05, 1e-12) << "the second harmonic raises crest and trough alike";
  const double k = M_PI;
  EXPECT_NEAR(wave.celerity(), std::sqrt(gravity / k * std::tanh(k * depth)), 1e-12);
  // Dean and Dalrymple, Water Wave Mechanics, (11.6): H²k/16 cosh kd (2 + cosh 2kd)/sinh³ kd
  const double kd = k * depth;
  EXPECT_NEAR(wave.elevation(0) - 0.025, 0.05 * 0.05 * k / 16 * std::cosh(kd) * (2 + std::cosh(2 * kd)) / std::pow(std::sinh(kd), 3),
              1e-12);
  // of long waves the horizontal velocity is η √(g/d), of the solitary one's mean c η/(d + η)
  const WaveField length = regular(0.001, 100, false);
  EXPECT_NEAR(length.velocity(0, -0.2).x(), 0.0005 * std::sqrt(gravity / depth), 2e-6);
  double mean = 0;
  for (int n = 0; n < 1000; ++n)
    mean += solitary(0.12).velocity(0.1, -depth + (n + 0.5) / 1000 * (depth + solitary(0.12).elevation(0.1))).x() / 1000;
  const double eta = solitary(0.12).elevation(0.1);
  EXPECT_NEAR(mean, solitary(0.12).celerity() * eta / (depth + eta), 1e-5);
}

TEST(WaveFields, StandingOnesRestWhenTheyAreHighest) {
  WaveField field = regular(0.02, 2, false);
  field.kind = WaveField::Kind::standing;
  EXPECT_EQ(field.velocity(0.3, -0.1), Eigen::Vector2d::Zero());
  EXPECT_DOUBLE_EQ(field.elevation(0), 0.01);
  // at the floor 1/cosh kd of the crest's weight beside the still water's, but for kη = 0.03 of it
  EXPECT_NEAR(field.pressure_over_density(0, -depth) - gravity * depth, gravity * 0.01 / std::cosh(M_PI * depth), 0.03 * gravity * 0.01);
}

}  // namespace
}  // namespace wavetank::water_waves_test

// Paddles that take away the waves which come back to them, in water of linear theory.
#include "../../src/rigid/wave_absorption.h"

#include <cmath>

#include "rigid_fixture.h"

namespace wavetank {
namespace {

constexpr double depth = 0.4, to_gauge = 0.2, time_step = 2e-3;

WaveCase absorbing(double period) {
  WaveCase wave;
  wave.depth = depth;
  wave.height = 0.04;
  wave.period = period;
  wave.absorption = WaveAbsorptionCase{"front", std::nullopt, std::nullopt};
  return wave;
}

WaveAbsorption made(const WaveCase& wave, const PaddlePlace& place = {to_gauge, 5, 0.3}) {
  return WaveAbsorption(wave, gravity, place, "", "body 'piston'");
}

/// What the paddle sends of a wave of unit amplitude that comes back to it, and where it is then in the mean, m: the water before it has
/// small waves of one period, and the gauge shows them, those that the paddle is to make, and a level of its own.
struct Outcome {
  double sent = 0, drift = 0;
};
Outcome outcome(double made_for, double period, double amplitude) {
  WaveAbsorption paddle = made(absorbing(made_for));
  const double omega = 2 * M_PI / period, k = wave_number(omega, depth, gravity), lag = k * to_gauge / omega;
  const double speed = omega / wave_over_stroke(k, depth, std::nullopt);  // of a paddle over the amplitude of its waves
  const double own = 2 * M_PI / made_for, own_lag = wave_number(own, depth, gravity) * to_gauge / own;
  std::vector<double> sent;  // surface of what goes out, at the paddle
  const auto sent_at = [&](double time) {
    const auto n = static_cast<std::ptrdiff_t>(std::lround(time / time_step));
    return n < 0 || n >= static_cast<std::ptrdiff_t>(sent.size()) ? 0.0 : sent[static_cast<std::size_t>(n)];
  };
  const double duration = 60 * period;
  double in_phase = 0, quadrature = 0, drift = 0;
  for (int n = 0; n * time_step < duration; ++n) {
    const double time = n * time_step, comes = amplitude * std::cos(omega * time);
    sent.push_back(paddle.at(time).rate / speed + comes);
    WaveField field;
    field.second_order = true;
    field.depth = depth;
    field.height = time - own_lag < made_for ? 0.0 : 0.04;
    field.wave_number = own * own_lag / to_gauge;
    field.gravity = gravity;
    const double asked_for = time - own_lag < made_for ? 0.0 : field.elevation(-own * (time - own_lag) / field.wave_number);
    paddle.see(time, 0.41 + asked_for + sent_at(time - lag) + amplitude * std::cos(omega * (time + lag)));
    paddle.advance(time, time_step);
    if (time < duration - 10 * period) continue;
    in_phase += sent.back() * std::cos(omega * time) * time_step / (5 * period);
    quadrature += sent.back() * std::sin(omega * time) * time_step / (5 * period);
    drift += paddle.at(time + time_step).value * time_step / (10 * period);
  }
  return {std::hypot(in_phase, quadrature) / amplitude, drift};
}

TEST(Absorption, TakesAwayWavesOfItsPeriodAndNearIt) {
  EXPECT_LT(outcome(1.2, 1.2, 0.02).sent, 0.02);
  EXPECT_LT(outcome(0.9, 0.9, 0.02).sent, 0.02);
  EXPECT_LT(outcome(2.5, 2.5, 0.02).sent, 0.02);
  EXPECT_LT(outcome(1.2, 1.1, 0.02).sent, 0.1);
  EXPECT_LT(outcome(1.2, 1.4, 0.02).sent, 0.1);
  // a stroke of 0.032 m: no drift, for all that the gauge's level is 0.01 m off
  EXPECT_LT(std::abs(outcome(1.2, 1.2, 0.02).drift), 0.01 * 0.032);
}

TEST(Absorption, ShortWavesDoNotGrowBetweenGaugeAndPaddle) {
  for (const double period : {0.8, 0.6, 0.5, 0.4, 0.3}) EXPECT_LT(outcome(1.2, period, 0.005).sent, 3.0) << period;
}

TEST(Absorption, KeepsToItsReach) {
  WaveCase wave = absorbing(1.2);
  wave.absorption->reach = 0.01;
  WaveAbsorption paddle = made(wave);
  double farthest = 0, before = 0;
  for (int n = 0; n < 5000; ++n) {
    const double time = n * time_step;
    paddle.see(time, 0.4 + 0.1 * std::sin(2 * M_PI * time / 1.2));
    const Change change = paddle.at(time);
    // velocity and acceleration are the derivatives of what it does, within a step
    const double hair = 1e-6;
    EXPECT_NEAR((paddle.at(time + hair).value - change.value) / hair, change.rate, 1e-5);
    EXPECT_NEAR((paddle.at(time + hair).rate - change.rate) / hair, change.acceleration, 1e-3);
    EXPECT_NEAR(change.value, before, 1e-12) << "no step begins elsewhere than the last one ended";
    before = paddle.at(time + time_step).value;
    farthest = std::max(farthest, std::abs(change.value));
    paddle.advance(time, time_step);
  }
  EXPECT_LT(farthest, 0.01);
  EXPECT_GT(farthest, 0.009);
  EXPECT_NEAR(paddle.taken(), std::abs(before) / 0.01, 1e-9);
}

TEST(Absorption, GoesOnFromWhatItHasSaved) {
  WaveAbsorption first = made(absorbing(1.2)), second = made(absorbing(1.2));
  const auto go = [](WaveAbsorption& paddle, int from, int to) {
    for (int n = from; n < to; ++n) {
      paddle.see(n * time_step, 0.4 + 0.02 * std::sin(3.0 * n * time_step));
      paddle.advance(n * time_step, time_step);
    }
  };
  go(first, 0, 700);
  const std::vector<double> saved = first.save();
  ASSERT_EQ(saved.size(), WaveAbsorption::saved_numbers);
  second.restore(saved.data());
  go(first, 700, 900);
  go(second, 700, 900);
  EXPECT_EQ(first.save(), second.save());
  EXPECT_NE(first.save(), saved);
}

TEST(Absorption, NeedsRoomAndAGaugeWellBeforeThePaddle) {
  const auto refused = [](const PaddlePlace& place) { return error_of([&] { made(absorbing(1.2), place); }); };
  EXPECT_NE(
      refused({0.6, 5, 0.3}).find("absorption/gauge stands 0.6 m before the paddle; it must be within a quarter of a wavelength, 0.48"),
      std::string::npos)
      << refused({0.6, 5, 0.3});
  EXPECT_NE(refused({0.01, 5, 0.3}).find("it must stand farther before it"), std::string::npos);
  EXPECT_NE(refused({0.2, 5, 0.01}).find("prescribed/waves/absorption has no room"), std::string::npos);
}

}  // namespace
}  // namespace wavetank

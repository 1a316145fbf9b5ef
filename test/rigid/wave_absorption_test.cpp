// Paddles that take away the waves which come back to them, in water of linear theory.
#include "../../src/rigid/wave_absorption.h"

#include <cmath>

#include "rigid_fixture.h"

namespace wavetank::wave_absorption_test {
namespace {

constexpr double depth = 0.4, usual_gauge = 0.2, time_step = 2e-3;

WaveCase absorbing(double period) {
  WaveCase wave;
  wave.depth = depth;
  wave.height = 0.04;
  wave.period = period;
  wave.absorption = WaveAbsorptionCase{"front", std::nullopt, std::nullopt};
  return wave;
}

WaveAbsorption made(const WaveCase& wave, const PaddlePlace& place = {usual_gauge, 5, 0.3}) {
  return WaveAbsorption(wave, gravity, place, "", "body 'piston'");
}

/// What the paddle sends of a wave of unit amplitude that comes back to it, and where it is then in the mean, m: the water before it has
/// small waves of one period, and the gauge shows them, those that the paddle is to make, and a level of its own.
struct Outcome {
  double sent = 0, drift = 0;
};
Outcome outcome(double made_for, double period, double amplitude, double to_gauge = usual_gauge) {
  WaveAbsorption paddle = made(absorbing(made_for), {to_gauge, 5, 0.3});
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
  EXPECT_LT(outcome(1.0, 1.0, 0.02).sent, 0.02);
  EXPECT_LT(outcome(2.5, 2.5, 0.02).sent, 0.02);
  EXPECT_LT(outcome(1.2, 1.1, 0.02).sent, 0.1);
  EXPECT_LT(outcome(1.2, 1.4, 0.02).sent, 0.1);
  // a stroke of 0.032 m: no drift, for all that the gauge's level is 0.01 m off
  EXPECT_LT(std::abs(outcome(1.2, 1.2, 0.02).drift), 0.01 * 0.032);
}

// The low pass is late for short waves, and the paddle that answers to them late makes them larger: by a quarter at most, wherever the
// gauge may stand, at all frequencies from the waves' own to three times that.
TEST(Absorption, SendsShortWavesBackAQuarterLargerAtMost) {
  for (const double to_gauge : {0.1, 0.2, 0.28}) {
    double largest = 0;
    for (double ratio = 1; ratio < 3.01; ratio += 0.1) largest = std::max(largest, outcome(1.2, 1.2 / ratio, 0.002, to_gauge).sent);
    std::printf("gauge at %.2f m: %.3f times as high at most\n", to_gauge, largest);
    EXPECT_LT(largest, 1.25) << to_gauge;
  }
}

TEST(Absorption, IsAsItsOwnTheoryHasIt) {
  const WaveAbsorption paddle = made(absorbing(1.2));
  EXPECT_LT(paddle.sent_back(2 * M_PI / 1.2), 1e-12);
  for (const double period : {1.4, 1.0, 0.7, 0.5}) EXPECT_NEAR(outcome(1.2, period, 0.002).sent, paddle.sent_back(2 * M_PI / period), 0.04);
  // in deep and in shallow water, and for gauges near and as far as they may be
  for (const double period : {0.5, 0.7, 1.6, 3.0, 6.0})
    for (const double part : {0.03, 0.08, 0.149}) {
      const double omega = 2 * M_PI / period;
      const WaveAbsorption other = made(absorbing(period), {part * 2 * M_PI / wave_number(omega, depth, gravity), 5, 0.3});
      for (double ratio = 1; ratio < 3.01; ratio += 0.05) EXPECT_LT(other.sent_back(ratio * omega), 1.35) << period << " s, " << part;
    }
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
  // from another paddle's state it would not
  WaveCase slower = absorbing(1.2);
  slower.absorption->recall = 6;
  EXPECT_EQ(first.settings(), second.settings());
  EXPECT_NE(first.settings(), made(slower).settings());
  EXPECT_NE(first.settings(), made(absorbing(1.2), {0.21, 5, 0.3}).settings());
}

TEST(Absorption, NeedsRoomAndAGaugeWellBeforeThePaddle) {
  const auto refused = [](const PaddlePlace& place) { return error_of([&] { made(absorbing(1.2), place); }); };
  EXPECT_NE(refused({0.6, 5, 0.3}).find("absorption/gauge stands 0.6 m before the paddle; it must be within 0.15 of a wavelength, 0.29"),
            std::string::npos)
      << refused({0.6, 5, 0.3});
  EXPECT_NE(refused({0.01, 5, 0.3}).find("it must stand farther before it"), std::string::npos);
  EXPECT_NE(refused({0.2, 5, 0.01}).find("prescribed/waves/absorption has no room"), std::string::npos);
  EXPECT_NE(refused({0.2, 0.01, 0.3}).find("has no room: the tank leaves the paddle 0.01 m before it"), std::string::npos);
}

TEST(Absorption, HasNoMoreReachThanThereIsRoom) {
  const auto refused = [](const PaddlePlace& place) {
    WaveCase wave = absorbing(1.2);
    wave.absorption->reach = 0.15;
    return error_of([&] { made(wave, place); });
  };
  WaveCase enough = absorbing(1.2);
  enough.absorption->reach = 0.15;
  EXPECT_NO_THROW(made(enough));
  for (const auto& [place, why] : {std::pair(PaddlePlace{0.1, 5, 0.3}, "the gauge stands 0.1 m before the paddle, of which theory takes"),
                                   std::pair(PaddlePlace{0.2, 0.1, 0.3}, "the tank leaves the paddle 0.1 m before it"),
                                   std::pair(PaddlePlace{0.2, 5, 0.1}, "the tank leaves the paddle 0.1 m behind it")})
    EXPECT_NE(refused(place).find(std::string("prescribed/waves/absorption/reach is 0.15 m, but ") + why), std::string::npos)
        << refused(place);
}

TEST(Absorption, NeedsARecallThatItsFilterCanStand) {
  WaveCase wave = absorbing(1.2);
  wave.absorption->recall = 0.02;
  const std::string message = error_of([&] { made(wave); });
  EXPECT_NE(message.find("absorption/recall is 0.02 s"), std::string::npos) << message;
  EXPECT_NE(message.find("four periods are usual, 4.8 s"), std::string::npos) << message;
}

}  // namespace
}  // namespace wavetank::wave_absorption_test

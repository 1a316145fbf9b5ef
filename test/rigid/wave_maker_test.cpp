// Waves by theory: what a paddle must do for them, and what is told of them.
#include "../../src/rigid/wave_maker.h"

#include <numeric>

#include "rigid_fixture.h"
#include "wavetank/rigid/wave_theory.h"

namespace wavetank::wave_maker_test {
namespace {

constexpr double depth = 0.4;

WaveCase regular(double height, double period) {
  WaveCase wave;
  wave.depth = depth;
  wave.height = height;
  wave.period = period;
  return wave;
}

WaveCase sea(WaveKind kind) {
  WaveCase wave;
  wave.kind = kind;
  wave.depth = depth;
  wave.height = 0.12;
  wave.significant_height = 0.08;
  wave.peak_period = 1.4;
  wave.focus = {4.0, 20.0};
  return wave;
}

std::vector<WaveComponent> components_of(const WaveCase& wave) { return wave_components(wave, gravity, "", "body 'paddle'"); }

/// The surface at a distance from the paddle, m.
double elevation(const std::vector<WaveComponent>& components, double distance, double time) {
  double sum = 0;
  for (const WaveComponent& component : components)
    sum += component.amplitude * std::cos(component.angular_frequency * time -
                                          wave_number(component.angular_frequency, depth, gravity) * distance + component.phase);
  return sum;
}

TEST(WaveTheory, WaveNumbersFulfilTheDispersionRelation) {
  for (const double kd : {1e-3, 0.1, 0.5, 1.0, 1.2, 2.0, 5.0, 30.0}) {
    const double omega = std::sqrt(gravity * kd / depth * std::tanh(kd));
    EXPECT_NEAR(wave_number(omega, depth, gravity) * depth / kd, 1.0, 1e-12) << "kd = " << kd;
  }
}

// Long waves: a piston moves the whole depth and a flap hinged at the floor half of it; short ones follow its top.
TEST(WaveTheory, PaddlesMakeWhatIsKnownOfLongAndShortWaves) {
  EXPECT_NEAR(wave_over_stroke(0.01 / depth, depth, std::nullopt) / 0.01, 1.0, 1e-4);
  EXPECT_NEAR(wave_over_stroke(0.01 / depth, depth, 0.0) / 0.01, 0.5, 1e-4);
  EXPECT_NEAR(wave_over_stroke(30 / depth, depth, std::nullopt), 2.0, 1e-9);
  EXPECT_NEAR(wave_over_stroke(30 / depth, depth, 0.0), 2.0 * (1 - 1.0 / 30), 1e-9);
  EXPECT_NEAR(wave_over_stroke(1000 / depth, depth, std::nullopt), 2.0, 1e-9);
  EXPECT_NEAR(wave_over_stroke(1000 / depth, depth, 0.1), 2.0 * (1 - 1.0 / 750), 1e-9);
  // a hinge far below is a piston's, and one between changes sides with the depth that moves
  EXPECT_NEAR(wave_over_stroke(2.5, depth, -1e6), wave_over_stroke(2.5, depth, std::nullopt), 1e-6);
  // 4 sinh kd/(sinh 2kd + 2kd) · ∫ k (s − b)/(d − b) cosh ks ds from the hinge b to d, by Simpson's rule
  const double k = 3.0, hinge = 0.15;
  const int steps = 2000;
  double integral = 0;
  for (int i = 0; i <= steps; ++i) {
    const double s = hinge + (depth - hinge) * i / steps;
    const double weight = i == 0 || i == steps ? 1 : i % 2 == 1 ? 4 : 2;
    integral += weight * k * (s - hinge) / (depth - hinge) * std::cosh(k * s) * (depth - hinge) / steps / 3;
  }
  const double kd = k * depth;
  EXPECT_NEAR(wave_over_stroke(k, depth, hinge), 4 * std::sinh(kd) / (std::sinh(2 * kd) + 2 * kd) * integral, 1e-9);
}

TEST(WaveTheory, ASeaHasItsHeightAndItsPeak) {
  for (const WaveSpectrum spectrum : {WaveSpectrum::jonswap, WaveSpectrum::pierson_moskowitz}) {
    WaveCase wave = sea(WaveKind::irregular);
    wave.spectrum = spectrum;
    const std::vector<WaveComponent> components = components_of(wave);
    ASSERT_EQ(components.size(), 200u);
    double variance = 0;
    const WaveComponent* greatest = &components.front();
    for (const WaveComponent& component : components) {
      variance += 0.5 * component.amplitude * component.amplitude;
      if (component.amplitude > greatest->amplitude) greatest = &component;
    }
    EXPECT_NEAR(4 * std::sqrt(variance), 0.08, 1e-12);
    EXPECT_NEAR(2 * M_PI / greatest->angular_frequency, 1.4, 0.02);
  }
}

TEST(WaveTheory, ASeedGivesTheSameBits) {
  WaveCase wave = sea(WaveKind::irregular);
  const std::vector<WaveComponent> first = components_of(wave), again = components_of(wave);
  EXPECT_EQ(first[17].phase, again[17].phase);
  // of the seed 1 the generator's first 64 bits are, by its definition, 2469588189546311528
  EXPECT_NEAR(first[0].angular_frequency, 2 * M_PI * (0.5 / 1.4 + 0.13387664401253263 * 2.5 / 1.4 / 200), 1e-12);
  wave.seed = 2;
  EXPECT_NE(first[17].phase, components_of(wave)[17].phase);
}

TEST(WaveTheory, CrestsOfAFocusedWaveMeet) {
  const WaveCase wave = sea(WaveKind::focused);
  const std::vector<WaveComponent> components = components_of(wave);
  EXPECT_NEAR(elevation(components, wave.focus.distance, wave.focus.time), 0.12, 1e-12);
  double elsewhere = 0;
  for (double time = 0; time < 60; time += 0.01)
    if (std::abs(time - wave.focus.time) > 0.3) elsewhere = std::max(elsewhere, elevation(components, wave.focus.distance, time));
  EXPECT_LT(elsewhere, 0.1);
}

struct WaveRecord : testing::Test {
  const ScratchDirectory scratch;
};

TEST_F(WaveRecord, IsSeenAgainWhereItWasTaken) {
  const auto surface = [](double time) { return 0.03 * std::cos(2 * M_PI * 0.7 * time - 0.4) + 0.02 * std::sin(2 * M_PI * 1.1 * time); };
  std::string text = "t,eta_mm\n";
  for (int i = 0; i <= 2000; ++i) {
    const double time = 5 + 0.01 * i;
    text += std::to_string(time) + "," + std::to_string(1000 * surface(time) + 7) + "\n";
  }
  WaveCase wave = sea(WaveKind::record);
  wave.record.time_column = "t";
  wave.record.column = "eta_mm";
  wave.record.factor = 1e-3;
  wave.record.distance = 2.5;
  wave.record.delay = -1;
  const std::vector<WaveComponent> components = wave_components(wave, gravity, scratch.write("waves.csv", text), "body 'paddle'");
  EXPECT_LT(components.size(), 40u);
  for (double time = 6; time < 20; time += 0.37) EXPECT_NEAR(elevation(components, 2.5, time - 1), surface(time), 1e-3) << time;
  scratch.write("waves.csv", "t,eta_mm\n0,1\n1,1\n2,1\n");
  EXPECT_NE(error_of([&] { wave_components(wave, gravity, scratch.file("waves.csv"), "body 'paddle'"); }).find("has 3 lines of elevations"),
            std::string::npos);
  scratch.write("waves.csv", "t,eta_mm\n0,1\n1,1\n2,1\n3,1\n4,1\n5,1\n6,1\n7,1\n");
  EXPECT_NE(
      error_of([&] { wave_components(wave, gravity, scratch.path() / "waves.csv", "body 'paddle'"); }).find("the surface does not move"),
      std::string::npos);
}

MotionTerm term_of(const WaveCase& wave) { return wave_term(wave, gravity, "", "body 'paddle'"); }

TEST(WaveMaker, RatesAreTheDerivatives) {
  WaveCase flap = regular(0.1, 1.2);
  flap.direction = Direction::pitch;
  flap.hinge = 0.1;
  WaveCase second = regular(0.1, 1.6);
  second.order = 2;
  WaveCase backwards = sea(WaveKind::solitary);
  backwards.reversed = true;
  for (const WaveCase& wave : {regular(0.1, 1.2), flap, second, sea(WaveKind::irregular), sea(WaveKind::focused), backwards}) {
    const MotionTerm term = term_of(wave);
    EXPECT_EQ(term.at(0).value, 0.0);
    const double step = 1e-4;
    double greatest = 0;
    for (double time = 0.05; time < 4; time += 0.0613) {
      const Change before = term.at(time - step), at = term.at(time), after = term.at(time + step);
      greatest = std::max(greatest, std::abs(at.value));
      ASSERT_NEAR((after.value - before.value) / (2 * step), at.rate, 1e-6) << "t = " << time;
      ASSERT_NEAR((after.rate - before.rate) / (2 * step), at.acceleration, 1e-4) << "t = " << time;
    }
    EXPECT_GT(greatest, 1e-4);
    EXPECT_LT(term.resolution, 0.1);
  }
}

TEST(WaveMaker, RegularWavesHaveTheirStroke) {
  // a = 0.05 m; kd of ω = 2π/1.2 at 0.4 m: 1.4038 by ω²d/g = kd tanh kd
  const double k = wave_number(2 * M_PI / 1.2, depth, gravity), e = 0.05 / wave_over_stroke(k, depth, std::nullopt);
  const MotionTerm piston = term_of(regular(0.1, 1.2));
  EXPECT_NEAR(piston.at(6.3).value, e, 1e-12);  // a quarter of a period after a whole number of them
  EXPECT_NEAR(piston.at(6.0).rate, e * 2 * M_PI / 1.2, 1e-12);
  WaveCase reversed = regular(0.1, 1.2);
  reversed.reversed = true;
  EXPECT_NEAR(term_of(reversed).at(6.3).value, -e, 1e-12);
  WaveCase flap = regular(0.1, 1.2);
  flap.direction = Direction::pitch;
  flap.hinge = 0.1;
  EXPECT_NEAR(term_of(flap).at(6.3).value, std::atan(0.05 / wave_over_stroke(k, depth, 0.1) / 0.3), 1e-12);
  WaveCase slow = regular(0.1, 1.2);
  slow.rise = 2.4;
  EXPECT_NEAR(term_of(slow).at(1.5).value, (std::pow(0.625, 3) * (10 + 0.625 * (6 * 0.625 - 15))) * e, 1e-12);
}

// Madsen's second-order stroke, H²/(32 d) (3 cosh kd/sinh³ kd − 2/m), by hand for kd = 1: cosh 1.543081, sinh 1.175201, m = 4 sinh²/(sinh 2
// + 2)
TEST(WaveMaker, TheSecondOrderIsMadsens) {
  const double omega = std::sqrt(gravity / depth * std::tanh(1.0));
  WaveCase wave = regular(0.1, 2 * M_PI / omega);
  const Change first = term_of(wave).at(5.125 * wave.period);  // sin 2ωt = 1 there
  wave.order = 2;
  const Change second = term_of(wave).at(5.125 * wave.period);
  const double m = 4 * 1.175201 * 1.175201 / (3.626860 + 2);
  const double expected = 0.01 / (32 * 0.4) * (3 * 1.543081 / std::pow(1.175201, 3) - 2 / m);
  EXPECT_GT(expected, 5e-4);
  EXPECT_NEAR(second.value - first.value, expected, 1e-8);
  wave.reversed = true;
  WaveCase linear = wave;
  linear.order = 1;
  EXPECT_NEAR(term_of(wave).at(5.125 * wave.period).value - term_of(linear).at(5.125 * wave.period).value, -expected, 1e-8);
}

TEST(WaveMaker, ASolitaryWavesPistonGoesWithTheWater) {
  WaveCase wave = sea(WaveKind::solitary);  // H/d = 0.3
  const SolitaryWave solitary(0.12, depth, gravity);
  EXPECT_NEAR(solitary.celerity(), std::sqrt(9.81 * 0.52), 1e-12);
  EXPECT_NEAR(solitary.stroke(), 2 * std::sqrt(4 * 0.12 * 0.52 / 3), 1e-12);
  const MotionTerm term = term_of(wave);
  const double middle = 0.5 * solitary.duration();
  EXPECT_NEAR(term.at(middle).rate, solitary.celerity() * 0.12 / 0.52, 1e-9);
  EXPECT_NEAR(term.at(middle).value, 0.5 * solitary.stroke(), 1e-3);
  EXPECT_NEAR(term.at(100).value, solitary.stroke(), 1e-3 * solitary.stroke());
  EXPECT_EQ(term.at(100).rate, 0.0);
  EXPECT_LT(term.at(1e-9).rate, 2e-3);
}

// Beside the crest's height: of a spectrum's components the short ones are the steep ones.
TEST(WaveFacts, TellWhereAFocusedWaveBreaks) {
  WaveCase wave = sea(WaveKind::focused);
  wave.peak_period = 1.2;
  wave.height = 0.04;
  EXPECT_EQ(wave_facts(wave, gravity, "", "body 'paddle'").breaking, "");
  wave.height = 0.1;
  double slope = 0;
  for (const WaveComponent& component : components_of(wave))
    slope += component.amplitude * wave_number(component.angular_frequency, depth, gravity);
  EXPECT_NEAR(slope, 0.45, 0.02);
  const std::string breaking = wave_facts(wave, gravity, "", "body 'paddle'").breaking;
  char together[40];
  std::snprintf(together, sizeof together, "are %.2f together, beyond 0.38", slope);
  EXPECT_NE(breaking.find(together), std::string::npos) << breaking;
}

TEST(WaveFacts, TellWhatComes) {
  const auto facts = [](const WaveCase& wave) { return wave_facts(wave, gravity, "", "body 'paddle'"); };
  const WaveFacts middle = facts(regular(0.1, 1.2));
  EXPECT_NEAR(middle.wavelength, 2 * M_PI / wave_number(2 * M_PI / 1.2, depth, gravity), 1e-12);
  EXPECT_NEAR(middle.celerity, middle.wavelength / 1.2, 1e-12);
  EXPECT_NEAR(middle.steepness, 0.1 / middle.wavelength, 1e-12);
  EXPECT_NEAR(middle.ursell, 0.1 * middle.wavelength * middle.wavelength / 0.064, 1e-12);
  EXPECT_NEAR(middle.stroke, 0.1 / wave_over_stroke(2 * M_PI / middle.wavelength, depth, std::nullopt), 1e-12);
  EXPECT_EQ(middle.regime, "intermediate");
  EXPECT_TRUE(middle.breaking.empty());
  EXPECT_EQ(facts(regular(0.05, 0.6)).regime, "deep");
  EXPECT_EQ(facts(regular(0.05, 6)).regime, "shallow");
  EXPECT_NE(facts(regular(0.1, 0.6)).breaking.find("Miche"), std::string::npos);
  EXPECT_NE(facts(regular(0.35, 6)).breaking.find("McCowan"), std::string::npos);
  EXPECT_NEAR(facts(sea(WaveKind::irregular)).height, 0.08, 1e-12);
  const WaveFacts solitary = facts(sea(WaveKind::solitary));
  EXPECT_NEAR(solitary.celerity, std::sqrt(9.81 * 0.52), 1e-12);
  EXPECT_EQ(solitary.period, 0);
}

}  // namespace
}  // namespace wavetank::wave_maker_test

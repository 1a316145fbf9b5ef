// Paddles that make waves by theory, and zones that take them away.
#include "simulation_fixture.h"
#include "wavetank/common/log.h"

namespace wavetank::waves_test {
namespace {

constexpr double depth = 0.4;

/// A flume with a piston at its left end.
Case flume(double length, double spacing) {
  Case scene = box_case(Vector3d(length, 0, 0.6), depth, spacing);
  scene.fluid.fill = {Box{Vector3d(0.2, 0, 0), Vector3d(length, 0, depth)}};
  scene.numerics.artificial_viscosity = 0.005;
  scene.numerics.walls.slip = Slip::free_slip;
  BodyCase piston;
  piston.name = "piston";
  piston.shape = Box{Vector3d(0.1, 0, 0), Vector3d(0.2, 0, 0.6)};
  piston.motion = Motion::prescribed;
  WaveCase wave;
  wave.depth = depth;
  wave.height = 0.1;
  wave.period = 1.2;
  piston.rigid.prescribed.waves = wave;
  scene.bodies = {piston};
  scene.duration = 10;
  return scene;
}

DampingCase zone(double from, double to, double strength) {
  DampingCase damping;
  damping.box = Box{Vector3d(from, 0, 0), Vector3d(to, 0, 1)};
  damping.strength = strength;
  return damping;
}

using Waves = SimulationTest;

/// k of linear waves in water of that depth, rad/m.
double wave_number(double omega) {
  double k = omega * omega / 9.81;
  for (int turn = 0; turn < 200; ++turn) k = 0.5 * (k + omega * omega / (9.81 * std::tanh(k * depth)));
  return k;
}

/// The horizontal velocity at a height over the floor by linear theory from the elevations at its place, of a wave that repeats itself
/// after `count` samples; one value a sample, of mean 0.
std::vector<double> velocity_under(const std::vector<double>& elevations, double rate, double height) {
  const std::size_t count = elevations.size();
  std::vector<double> velocity(count, 0.0);
  for (int cycles = 1; cycles <= 12; ++cycles) {  // in that time: the higher ones are noise, which deep down nothing is left of
    const double omega = 2 * M_PI * cycles * rate / static_cast<double>(count), k = wave_number(omega);
    const double transfer = omega * std::cosh(k * height) / std::sinh(k * depth);
    double cosine = 0, sine = 0;
    for (std::size_t n = 0; n < count; ++n) {
      cosine += 2.0 / static_cast<double>(count) * elevations[n] * std::cos(omega * static_cast<double>(n) / rate);
      sine += 2.0 / static_cast<double>(count) * elevations[n] * std::sin(omega * static_cast<double>(n) / rate);
    }
    for (std::size_t n = 0; n < count; ++n) {
      const double angle = omega * static_cast<double>(n) / rate;
      velocity[n] += transfer * (cosine * std::cos(angle) + sine * std::sin(angle));
    }
  }
  return velocity;
}

// Coarse: eight tenths of the height are to be there, whole wavelengths apart, and none where the zone ends.
TEST_F(Waves, ComeAsHighAndAsOftenAsTheoryHasIt) {
  Case scene = flume(6, 0.025);
  scene.fluid.damping = {zone(3.6, 6, 8)};
  scene.instruments.wave_gauges = {{"near", Vector3d(1.2, 0, 0)}, {"far", Vector3d(3.2, 0, 0)}, {"end", Vector3d(5.9, 0, 0)}};
  scene.instruments.velocity_probes = {{"under", Vector3d(1.2, 0, 0.5 * depth)}};
  scene.instruments.rate = 50;
  Simulation simulation(scene);
  const Samples samples = run_to(simulation, 7.2);
  double low[3] = {1, 1, 1}, high[3] = {};
  std::vector<double> crossings;  // of the still level upwards, at the first gauge
  for (std::size_t k = 1; k < samples.levels.size(); ++k) {
    if (samples.levels[k].time < 3.6) continue;
    for (int g = 0; g < 3; ++g) {
      low[g] = std::min(low[g], samples.levels[k].levels[g]);
      high[g] = std::max(high[g], samples.levels[k].levels[g]);
    }
    const double before = samples.levels[k - 1].levels[0] - depth, after = samples.levels[k].levels[0] - depth;
    if (before < 0 && after >= 0) crossings.push_back(samples.levels[k - 1].time - before / (after - before) * 0.02);
  }
  for (int g = 0; g < 3; ++g) std::printf("gauge %d: %.4f m high\n", g, high[g] - low[g]);
  // Of the last three periods, without their mean: a closed flume has the current that brings back what waves carry, of second order.
  const std::size_t begin = samples.levels.size() - 180;
  std::vector<double> elevations;
  double mean = 0;
  for (std::size_t n = 0; n < 180; ++n) {
    elevations.push_back(samples.levels[begin + n].levels[0]);
    mean += samples.velocities[begin + n].velocities[0].x() / 180;
  }
  const std::vector<double> theory = velocity_under(elevations, 50, 0.5 * depth);
  double squares = 0, differences = 0;
  for (std::size_t n = 0; n < 180; ++n) {
    squares += theory[n] * theory[n];
    differences += std::pow(samples.velocities[begin + n].velocities[0].x() - mean - theory[n], 2);
  }
  std::printf("velocity at mid-depth: rms %.4f m/s by theory from the gauge, off by %.1f %% rms, mean %+.4f m/s\n",
              std::sqrt(squares / 180), 100 * std::sqrt(differences / squares), mean);
  EXPECT_LT(std::sqrt(differences / squares), 0.1);
  EXPECT_NEAR(high[0] - low[0], 0.1, 0.025);  // the gauge reads to half a spacing
  EXPECT_LT(high[2] - low[2], 0.3 * (high[0] - low[0]));
  ASSERT_GE(crossings.size(), 2u);
  EXPECT_NEAR((crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1), 1.2, 0.04);
}

// A current beside itself in a zone decays as the zone's rate has it, and what it loses is on the tank.
TEST_F(Waves, ZonesTakeTheVelocityAndTellTheForce) {
  Case scene = box_case(Vector3d(1.6, 0, 0.4), 0.2, 0.04);
  scene.gravity = Vector3d::Zero();
  std::get<BoxTank>(scene.tank.shape).closed = true;
  scene.fluid.fill = {Box{Vector3d::Zero(), Vector3d(1.6, 0, 0.4)}};
  scene.fluid.sound_speed = 10;
  scene.fluid.viscosity = 0;
  scene.tank.periodic[0] = true;
  scene.numerics.walls.slip = Slip::free_slip;
  scene.numerics.artificial_viscosity = 0;
  scene.numerics.acoustic_damping = 0;
  scene.numerics.packing.iterations = 0;
  scene.fluid.current = Vector3d(0.5, 0, 0);
  scene.instruments.rate = 200;
  // as good as even: of a zone that begins a hundred metres off, the rate here is 3/s
  DampingCase damping = zone(-100, 1.7, 3);
  damping.velocity = Vector3d(0.1, 0, 0);
  scene.fluid.damping = {damping};
  Simulation simulation(scene);
  const Samples samples = run_to(simulation, 0.5);
  const ParticleCloud cloud = simulation.particles();
  const double time = simulation.state().time, expected = 0.1 + 0.4 * std::exp(-3 * time);
  for (std::size_t i = 0; i < cloud.id.size(); ++i) ASSERT_NEAR(cloud.velocity[i].x(), expected, 0.02 * 0.4);
  const double mass = simulation.energies().mass;
  const WrenchSample& last = samples.wrenches.back();
  EXPECT_NEAR(last.wrenches[0].pressure_force.x(), mass * 3 * 0.4 * std::exp(-3 * last.time), 0.04 * mass * 3 * 0.4);
}

TEST_F(Waves, StillWaterInAZoneIsAsStill) {
  Case scene = box_case(Vector3d(1.2, 0, 0.4), 0.2, 0.04);
  Simulation without(scene);
  scene.fluid.damping = {zone(0.6, 1.2, 8)};
  Simulation with(scene);
  run_to(without, 1);
  run_to(with, 1);
  EXPECT_LT(with.energies().kinetic, without.energies().kinetic);
  EXPECT_NEAR(with.energies().potential, without.energies().potential, 1e-3 * without.energies().potential);
}

// A short flume that reflects all: with what the paddle sends there stand waves of twice that height, and no more. (Without absorption
// they have 14.9 J/m.)
TEST_F(Waves, ThatComeBackAreTakenAwayByThePaddle) {
  const double height = 0.04, length = 2.7, end = 9;
  Case scene = flume(0.5 + length, 0.04);
  scene.fluid.fill = {Box{Vector3d(0.5, 0, 0), Vector3d(0.5 + length, 0, depth)}};
  scene.bodies[0].shape = Box{Vector3d(0.4, 0, 0), Vector3d(0.5, 0, 0.6)};
  scene.bodies[0].rigid.prescribed.waves->height = height;
  scene.bodies[0].rigid.prescribed.waves->absorption = WaveAbsorptionCase{"front", std::nullopt, std::nullopt};
  scene.instruments.wave_gauges = {{"front", Vector3d(0.7, 0, 0)}};
  scene.instruments.rate = 20;
  Simulation absorbs(scene);
  Samples samples = run_to(absorbs, 7);
  const std::string half_way = snapshot(absorbs);
  append(samples, run_to(absorbs, end));
  double kinetic = 0;
  for (const EnergySample& sample : samples.energies)
    if (sample.time > end - 1.2) kinetic = std::max(kinetic, sample.kinetic);
  const double expected = 0.25 * 1000 * 9.81 * height * height * length;  // of a standing wave, when it is level
  std::printf("kinetic energy at most %.3f J/m, %.3f J/m by linear theory\n", kinetic, expected);
  // A little less than theory was seen, 9.0 J/m, for waves this coarse lose some on their way: the bars part it from 14.9 J/m, which a
  // paddle that sends everything back has, and from waves that have died.
  EXPECT_LT(kinetic, 11.5);
  EXPECT_GT(kinetic, 7);
  // the paddle goes as it should plus what it absorbs, and says how fast
  double farthest = 0;
  const double stroke = 0.5 * height / 1.245;  // of linear theory for kd = 1.3
  for (std::size_t k = 1; k + 1 < samples.poses.size(); ++k) {
    const auto place = [&](std::size_t n) { return samples.poses[n].states[1].position.x(); };
    farthest = std::max(farthest, std::abs(place(k) - place(0)));
    EXPECT_NEAR((place(k + 1) - place(k - 1)) / 0.1, samples.poses[k].states[1].velocity.x(), 0.01);
  }
  EXPECT_GT(farthest, 1.1 * stroke);
  EXPECT_LT(farthest, 4 * stroke);
  // from its snapshot it goes on to the same bits
  Simulation again(scene);
  write(path("half_way"), half_way);
  again.restore(path("half_way"));
  run_to(again, end);
  EXPECT_TRUE(snapshot(again) == snapshot(absorbs)) << "the snapshots differ";
}

// In a tank as long as half the wave: it swings with the period of linear theory.
TEST_F(Waves, ThatStandAtTheStartSwingAsTheoryHasIt) {
  Case scene = box_case(Vector3d(1, 0, 0.6), depth, 0.025);
  scene.numerics.artificial_viscosity = 0.005;
  scene.numerics.walls.slip = Slip::free_slip;
  InitialWaveCase wave;
  wave.depth = depth;
  wave.height = 0.03;
  wave.wavelength = 2.0;
  wave.standing = true;
  scene.fluid.initial.waves = wave;
  scene.instruments.wave_gauges = {{"left", Vector3d(0.05, 0, 0)}, {"right", Vector3d(0.95, 0, 0)}};
  scene.instruments.rate = 100;
  Simulation simulation(scene);
  const Samples samples = run_to(simulation, 3);
  const auto swing = [&](std::size_t k) { return samples.levels[k].levels[0] - samples.levels[k].levels[1]; };
  EXPECT_NEAR(swing(0), 0.03 * std::cos(0.05 * M_PI), 0.05 * 0.03);
  std::vector<double> crossings;
  for (std::size_t k = 1; k < samples.levels.size(); ++k)
    if ((swing(k - 1) > 0) != (swing(k) > 0)) crossings.push_back(samples.levels[k].time - 0.01 * swing(k) / (swing(k) - swing(k - 1)));
  ASSERT_GE(crossings.size(), 4u);
  const double period = 2 * (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
  const double expected = 2 * M_PI / std::sqrt(9.81 * M_PI * std::tanh(M_PI * depth));
  std::printf("period %.4f s, %.4f s by linear theory\n", period, expected);
  EXPECT_NEAR(period / expected, 1, 0.02);
}

// Of a solitary wave the crest goes at √(g(d + H)) and keeps its height; the pressure at the floor is nearly that of what stands over it.
TEST_F(Waves, ThatAreAloneAtTheStartGoAsFastAsTheyShould) {
  Case scene = box_case(Vector3d(7, 0, 0.7), depth, 0.04);
  scene.numerics.artificial_viscosity = 0.005;
  scene.numerics.walls.slip = Slip::free_slip;
  InitialWaveCase wave;
  wave.kind = InitialWaveKind::solitary;
  wave.depth = depth;
  wave.height = 0.12;
  wave.crest = 2;
  scene.fluid.initial.waves = wave;
  scene.instruments.wave_gauges = {{"start", Vector3d(2, 0, 0)}, {"near", Vector3d(3, 0, 0)}, {"far", Vector3d(5, 0, 0)}};
  scene.instruments.rate = 100;
  Simulation simulation(scene);
  const Samples samples = run_to(simulation, 1.8);
  EXPECT_NEAR(samples.levels[0].levels[0] - depth, 0.12, 0.05 * 0.12);
  double highest[3] = {}, when[3] = {};
  for (const LevelSample& sample : samples.levels)
    for (int g = 1; g < 3; ++g)
      if (sample.levels[g] > highest[g]) highest[g] = sample.levels[g], when[g] = sample.time;
  const double celerity = 2 / (when[2] - when[1]);
  std::printf("crests %.4f m and %.4f m, %.3f m/s\n", highest[1] - depth, highest[2] - depth, celerity);
  EXPECT_NEAR(highest[2] - depth, 0.12, 0.1 * 0.12);  // three spacings high: it loses some on the way
  EXPECT_NEAR(celerity / std::sqrt(9.81 * (depth + 0.12)), 1, 0.03);
}

TEST_F(Waves, ThatCannotBeAreTold) {
  Case scene = flume(6, 0.05);
  scene.fluid.damping = {zone(0, 2, 8)};
  EXPECT_NE(error_of([&] { Simulation simulation(scene); }).find("fluid/damping/0/box lies over body 'piston'"), std::string::npos);
  scene.fluid.damping.clear();
  std::vector<std::string> told;
  set_log_sink([&](LogLevel, const std::string& text) { told.push_back(text); });
  const auto says = [&](const Case& it, const std::string& phrase) {
    told.clear();
    { Simulation simulation(it); }
    for (const std::string& text : told)
      if (text.find(phrase) != std::string::npos) return true;
    return false;
  };
  WaveCase& wave = *scene.bodies[0].rigid.prescribed.waves;
  EXPECT_TRUE(says(scene, "the waves of body piston are only 2 spacings high"));
  wave.height = 0.45;
  EXPECT_TRUE(says(scene, "the waves of body piston will break: they are 0.45 m high, higher than McCowan's"));
  EXPECT_TRUE(says(scene, "which carries the paddle out of the tank"));
  wave.height = 0.1;
  wave.depth = 0.3;
  EXPECT_TRUE(says(scene, "are made for a depth of 0.3 m, but the water is 0.4 m deep"));
  wave.depth = 0.4;
  wave.period = 5;
  EXPECT_TRUE(says(scene, "have an Ursell number of"));
  set_log_sink({});
}

}  // namespace
}  // namespace wavetank::waves_test

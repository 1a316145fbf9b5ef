// Openings: what comes in and leaves, at rest and in a current.
#include <cstring>
#include <functional>
#include <limits>
#include <map>
#include <numeric>

#include "../../src/simulation/snapshot.h"
#include "simulation_fixture.h"
#include "wavetank/scene/methods.h"

namespace wavetank::openings_test {
namespace {

constexpr double depth = 0.4, spacing = 0.04;

OpeningCase opening(const std::string& name, OpeningKind kind, const Vector3d& centre, const Vector3d& normal, double height) {
  OpeningCase result;
  result.name = name;
  result.kind = kind;
  result.centre = centre;
  result.normal = normal;
  result.size = std::array<double, 2>{1.0, height};
  return result;
}

/// A tank of 1.2 m × 0.6 m, with a hole over the whole height of its right end.
Case tank_with_outlet() {
  Case scene = box_case(Vector3d(1.2, 0, 0.6), depth, spacing);
  scene.duration = 4;
  scene.openings = {opening("end", OpeningKind::outlet, Vector3d(1.2, 0, 0.3), -Vector3d::UnitX(), 0.6)};
  scene.openings[0].level = depth;
  return scene;
}

/// The same, with water that comes in at the left and leaves at the right.
Case channel(const std::string& velocity) {
  Case scene = tank_with_outlet();
  scene.numerics.walls.slip = Slip::free_slip;
  OpeningCase inlet = opening("start", OpeningKind::inlet, Vector3d(0, 0, 0.3), Vector3d::UnitX(), 0.6);
  inlet.velocity = velocity;
  inlet.level = depth;
  scene.openings.insert(scene.openings.begin(), inlet);
  return scene;
}

double mass_of(const Simulation& simulation) { return simulation.energies().mass; }

struct Balance {
  double in = 0, out = 0;
};

Balance balance_of(const Simulation& simulation) {
  Balance balance;
  for (const OpeningState& state : simulation.openings()) {
    balance.in += state.mass_in;
    balance.out += state.mass_out;
  }
  return balance;
}

class Openings : public SimulationTest {
 protected:
  /// A run that goes on from a snapshot is, bit for bit, the one that it was saved from.
  void expect_to_go_on_from_a_snapshot(const Case& scene) {
    Simulation first(scene), second(scene);
    run_steps(first, 150);
    first.save(path("middle"));
    const Samples rest = run_steps(first, 100);
    second.restore(path("middle"));
    EXPECT_TRUE(same(rest, run_steps(second, 100)));
    EXPECT_EQ(snapshot(first), snapshot(second));
  }
};

/// By id.
std::map<std::uint32_t, Eigen::Vector3f> places_of(const Simulation& simulation) {
  const ParticleCloud cloud = simulation.particles();
  std::map<std::uint32_t, Eigen::Vector3f> places;
  for (std::size_t i = 0; i < cloud.id.size(); ++i) places[cloud.id[i]] = cloud.position[i];
  return places;
}

TEST_F(Openings, StillWaterAtItsOutletsLevelStaysStill) {
  Case closed = tank_with_outlet();
  closed.openings.clear();
  Simulation with(tank_with_outlet()), without(closed);
  double fastest_with = 0, fastest_without = 0;
  while (with.state().time < 1) {
    with.advance();
    without.advance();
    fastest_with = std::max(fastest_with, with.state().greatest_speed);
    fastest_without = std::max(fastest_without, without.state().greatest_speed);
  }
  EXPECT_LT(fastest_with, 1.2 * fastest_without);
  EXPECT_EQ(balance_of(with).in, 0);
  EXPECT_EQ(balance_of(with).out, 0);
}

TEST_F(Openings, AChannelKeepsItsDepthAndItsMass) {
  Case scene = channel("0.4");
  scene.fluid.current = Vector3d(0.4, 0, 0);
  scene.instruments.wave_gauges = {{"a", Vector3d(0.3, 0, 0)}, {"b", Vector3d(0.9, 0, 0)}};
  Simulation simulation(scene);
  const double mass = simulation.energies().mass;
  while (simulation.state().time < 4) simulation.advance();
  const Balance balance = balance_of(simulation);
  EXPECT_NEAR(balance.in, 4 * 0.4 * depth * 1000, 1.01 * 10 * spacing * spacing * 1000);  // a row of particles at the most
  EXPECT_NEAR(mass + balance.in - balance.out, simulation.energies().mass, 1e-6 * mass);
  for (const LevelSample& sample : simulation.take_samples().levels)
    for (const double level : sample.levels) ASSERT_NEAR(level, depth, spacing) << "at t = " << sample.time;
}

TEST_F(Openings, WaterComesInWithoutAGapWhateverItsVelocityDoes) {
  Simulation simulation(channel("t < 0.5 ? 0.5 + 0.4*sin(20*t) : t < 0.7 ? 0 : 0.8"));
  const std::size_t rows = static_cast<std::size_t>(depth / spacing + 0.5);
  std::size_t most = 0;
  while (simulation.state().time < 1.2) {
    simulation.advance();
    if (simulation.state().step % 10 != 0) continue;
    std::map<int, std::vector<double>> behind;  // along x, by row
    for (const auto& [id, place] : places_of(simulation))
      if (place.x() < -1e-3 * spacing && place.z() < depth) behind[static_cast<int>(place.z() / spacing)].push_back(place.x());
    ASSERT_EQ(behind.size(), rows);
    for (auto& [row, along] : behind) {
      std::sort(along.begin(), along.end());
      most = std::max(most, along.size());
      EXPECT_GE(along.size(), 4u);
      for (std::size_t k = 1; k < along.size(); ++k) ASSERT_NEAR(along[k] - along[k - 1], spacing, 1e-4 * spacing) << "in row " << row;
      ASSERT_GT(along.back(), -1.01 * spacing);  // up to the plane
    }
  }
  EXPECT_LE(most, 6u);
}

TEST_F(Openings, RepeatBitForBitAndFromASnapshot) {
  Case scene = channel("0.4 + 0.2*sin(9*t)");
  scene.duration = 2;
  const int steps = 300;
  Simulation first(scene), second(scene);
  run_steps(first, steps);
  first.save(path("middle"));
  const Samples rest = run_steps(first, steps);
  run_steps(second, steps);
  EXPECT_TRUE(same(rest, run_steps(second, steps)));
  EXPECT_EQ(snapshot(first), snapshot(second));
  Simulation third(scene);
  third.restore(path("middle"));
  EXPECT_TRUE(same(rest, run_steps(third, steps)));
  EXPECT_EQ(snapshot(first), snapshot(third));
  third.reset();
  run_steps(third, 2 * steps);
  EXPECT_EQ(snapshot(first), snapshot(third));
}

TEST_F(Openings, IdsNeverRepeat) {
  Simulation simulation(channel("0.8"));
  std::map<std::uint32_t, float> seen;  // where each was at last, along the channel
  while (simulation.state().time < 1) {
    simulation.advance();
    if (simulation.state().step % 20 != 0) continue;
    for (const auto& [id, place] : places_of(simulation)) {
      const auto [known, is_new] = seen.emplace(id, place.x());
      if (!is_new) ASSERT_LT(std::abs(known->second - place.x()), spacing) << "particle " << id;
      known->second = place.x();
    }
  }
  EXPECT_GT(seen.size(), 500u);
}

TEST_F(Openings, FillAnEmptyTankByWhatIsCommanded) {
  Case scene = box_case(Vector3d(0.6, 0, 0.5), 0.1, 0.02);
  scene.duration = 2;
  scene.fluid.fill.clear();
  scene.openings = {opening("tap", OpeningKind::inlet, Vector3d(0, 0, 0.2), Vector3d::UnitX(), 0.08)};
  scene.openings[0].command = FlowCommandCase{0.05, 0.1, 0.4};
  Simulation simulation(scene);
  const auto run_until = [&](double time) {
    while (simulation.state().time < time) simulation.advance();
  };
  run_until(0.1);
  EXPECT_EQ(simulation.openings()[0].discharge, 0);
  simulation.command_discharge(0, 0.08);
  run_until(0.3);
  EXPECT_NEAR(simulation.openings()[0].discharge, 0.02, 1e-3);  // 0.1 m²/s² for 0.2 s
  simulation.command_discharge(0, 0.08);
  run_until(0.65);
  EXPECT_NEAR(simulation.openings()[0].discharge, 0.05, 1e-6);  // the limit
  run_until(1.3);
  EXPECT_EQ(simulation.openings()[0].discharge, 0);  // nobody asked for more
  // 0.05²/(2·0.1) while it rises and again while it falls, and the rest of 0.6 s
  EXPECT_NEAR(simulation.openings()[0].volume, 0.05 * 0.1 + 0.0125 * 2, 4 * 0.02 * 0.02);
  EXPECT_NEAR(simulation.openings()[0].mass_in, 1000 * simulation.openings()[0].volume, 1e-6);
  EXPECT_NE(error_of([&] { simulation.command_discharge(0, -1); }).find("was commanded a discharge of -1"), std::string::npos);
  EXPECT_NO_THROW(simulation.command_discharge(0, 1e4));  // which is limited
}

TEST_F(Openings, FasterThanATenthOfTheSoundAreRefused) {
  Case scene = channel("3*t");
  scene.fluid.sound_speed = 28;
  EXPECT_NE(error_of([&] {
              Simulation simulation(scene);
            }).find("opening 'start': its water moves at up to 12 m/s; it must be at most a tenth of the speed of sound, 2.8 m/s"),
            std::string::npos);
  scene = channel("0.4 - t");
  EXPECT_NE(error_of([&] { Simulation simulation(scene); }).find("opening 'start': its velocity at t = 0.404 s is -0.004"),
            std::string::npos);
}

TEST_F(Openings, FollowARecord) {
  Case scene = channel("");
  FlowRecordCase record;
  record.file = path("flow.csv");
  write(record.file, "time,discharge\n0,0.1\n0.2,0.2\n0.4,0.2\n");
  scene.openings[0].record = record;
  Simulation simulation(scene);
  while (simulation.state().time < 0.1) simulation.advance();
  EXPECT_NEAR(simulation.openings()[0].discharge, 0.15, 2e-3);
  write(record.file, "time,discharge\n0,0.1\n0.2,0.2\n0.2,0.2\n");
  EXPECT_NE(error_of([&] { Simulation again(scene); }).find("line 4, column 'time': the time 0.2 s does not come after 0.2 s"),
            std::string::npos);
}

TEST_F(Openings, OfAFreeOutletLetNothingIn) {
  Case scene = tank_with_outlet();
  scene.openings[0].level.reset();
  scene.fluid.current = Vector3d(-0.1, 0, 0);
  Simulation simulation(scene);
  while (simulation.state().time < 0.5) simulation.advance();
  EXPECT_EQ(simulation.openings()[0].particles_in, 0u);
}

/// Of sound in a full duct, at a probe between where it starts and the far end: its pressures at the probe.
std::vector<double> pulse(double length, bool open) {
  constexpr double height = 0.2, sound_speed = 20, speed = 0.02, until = 0.14;
  Case scene = box_case(Vector3d(length, 0, height), height, 0.02);
  scene.gravity = Vector3d::Zero();
  scene.fluid.sound_speed = sound_speed;
  scene.fluid.viscosity = 0;
  std::get<BoxTank>(scene.tank.shape).closed = true;
  scene.numerics.walls.slip = Slip::free_slip;
  scene.numerics.negative_pressure = NegativePressure::allowed;
  scene.numerics.packing.iterations = 0;
  const std::string shape = "*exp(-((x-1)/0.2)^2)";
  scene.fluid.initial.u = std::to_string(speed) + shape;
  scene.fluid.initial.pressure = std::to_string(1000 * sound_speed * speed) + shape;
  if (open) scene.openings = {opening("end", OpeningKind::outlet, Vector3d(length, 0, height / 2), -Vector3d::UnitX(), height)};
  scene.instruments.pressure_probes = {{"middle", Vector3d(1.5, 0, height / 2), ""}};
  Simulation simulation(scene);
  while (simulation.state().time < until) simulation.advance();
  std::vector<double> pressures;
  for (const PressureSample& sample : simulation.take_samples().pressures) pressures.push_back(sample.pressures[0]);
  return pressures;
}

TEST_F(Openings, AFreeOutletSendsBackNoSound) {
  const std::vector<double> open = pulse(2, true), closed = pulse(2, false), long_one = pulse(3.6, false);
  double incident = 0, sent_back = 0, by_a_wall = 0;
  for (std::size_t k = 0; k < std::min({open.size(), closed.size(), long_one.size()}); ++k) {
    incident = std::max(incident, long_one[k]);
    sent_back = std::max(sent_back, std::abs(open[k] - long_one[k]));
    by_a_wall = std::max(by_a_wall, std::abs(closed[k] - long_one[k]));
  }
  RecordProperty("reflected", std::to_string(sent_back / incident));
  EXPECT_GT(by_a_wall, 0.3 * incident);
  EXPECT_LT(sent_back, 0.05 * by_a_wall);
  EXPECT_LT(sent_back, 0.05 * incident);
}

/// A round nozzle in a box that hangs over an empty tank, whose floor has a drain at each end.
Case fountain(Integrator integrator) {
  Case scene = box_case(Vector3d(0.8, 0.4, 0.6), 0.1, 0.025);
  scene.fluid.fill.clear();
  scene.fluid.sound_speed = 40;
  scene.duration = 1;
  BodyCase nozzle;
  nozzle.name = "nozzle";
  nozzle.shape = Box{Vector3d(0.05, 0.05, 0.3), Vector3d(0.35, 0.35, 0.5)};
  scene.bodies.push_back(nozzle);
  OpeningCase hose = opening("hose", OpeningKind::inlet, Vector3d(0.2, 0.2, 0.3), -Vector3d::UnitZ(), 0);
  hose.size.reset();
  hose.diameter = 0.12;
  hose.body = "nozzle";
  hose.velocity = "1.5";
  hose.profile = "parabolic";
  OpeningCase near = opening("near", OpeningKind::outlet, Vector3d(0.2, 0.2, 0), Vector3d::UnitZ(), 0.2);
  near.size = std::array<double, 2>{0.2, 0.2};
  OpeningCase far = near;
  far.name = "far";
  far.centre.x() = 0.6;
  scene.openings = {hose, near, far};
  scene.numerics.integrator = integrator;
  return scene;
}

/// What came in by each opening less what left by it, and all water's mass, kg.
void expect_account(const Case& scene, double duration, const std::vector<double>& least_in, const std::vector<double>& least_out) {
  Simulation simulation(scene);
  const double before = mass_of(simulation);
  run_to(simulation, duration);
  double change = 0;
  for (std::size_t o = 0; o < scene.openings.size(); ++o) {
    const OpeningState& state = simulation.openings()[o];
    std::printf("%s: %.4f kg in, %.4f kg out\n", scene.openings[o].name.c_str(), state.mass_in, state.mass_out);
    EXPECT_GE(state.mass_in, least_in[o]) << scene.openings[o].name;
    EXPECT_GE(state.mass_out, least_out[o]) << scene.openings[o].name;
    if (least_in[o] == 0) EXPECT_EQ(state.mass_in, 0) << scene.openings[o].name;
    if (least_out[o] == 0) EXPECT_EQ(state.mass_out, 0) << scene.openings[o].name;
    change += state.mass_in - state.mass_out;
  }
  EXPECT_NEAR(mass_of(simulation) - before, change, 1e-6 * mass_of(simulation));
}

// A disc in a body, in 3-D, a jet that falls into the drain below it and leaves the other dry.
TEST_F(Openings, AJetLeavesByTheDrainBelowIt) {
  const double discharge = 1000 * 1.5 * 0.25 * std::acos(-1.0) * 0.12 * 0.12;
  expect_account(fountain(Integrator::predictor_corrector), 0.5, {0.45 * discharge, 0, 0}, {0, 0.1 * discharge, 0});
}

// Heads on either side of a tank, and an outlet that asks for more than comes.
TEST_F(Openings, AHeadAndADischargeMeetTheirAccounts) {
  Case scene = tank_with_outlet();
  scene.openings.clear();
  OpeningCase head = opening("head", OpeningKind::pressure, Vector3d(0, 0, 0.12), Vector3d::UnitX(), 0.24);
  head.head = "0.55";
  OpeningCase outlet = opening("outlet", OpeningKind::outlet, Vector3d(1.2, 0, 0.3), -Vector3d::UnitX(), 0.6);
  outlet.discharge = "0.1";
  scene.openings = {head, outlet};
  scene.numerics.scheme = Scheme::riemann_parshikov;
  scene.numerics.shifting = Shifting::michel;
  scene.numerics.integrator = Integrator::runge_kutta_4;
  scene.numerics.density_diffusion = DensityDiffusion::none;
  expect_account(scene, 0.8, {5, 0}, {0, 60});
}

// Water that is asked for where hardly any is left: the speed stays within a tenth of the speed of sound, and the run goes on.
TEST_F(Openings, AnOutletThatRunsDryDoesNotEndTheRun) {
  Case scene = tank_with_outlet();
  scene.fluid.fill = {Box{Vector3d::Zero(), Vector3d(1.2, 0, 0.2)}};
  scene.openings[0].level.reset();
  scene.openings[0].discharge = "0.4";
  expect_account(scene, 1.5, {0}, {150});
}

TEST_F(Openings, AnInletBelowItsLevelIsRefused) {
  Case scene = channel("0.4");
  scene.openings[0].centre.z() = 0.4;
  scene.openings[0].size = std::array<double, 2>{1.0, 0.2};
  scene.openings[0].level = 0.25;
  EXPECT_NE(error_of([&scene] { Simulation simulation(scene); }).find("opening 'start'"), std::string::npos);
}

/// A nozzle in a body that swings and moves about over an empty tank, and blows.
Case swinging_nozzle(const std::string& velocity) {
  Case scene = box_case(Vector3d(1.6, 0, 1.2), 0.1, 0.02);
  scene.fluid.fill.clear();
  scene.fluid.sound_speed = 60;
  scene.duration = 2;
  BodyCase arm;
  arm.name = "arm";
  arm.shape = Box{Vector3d(0.6, 0, 0.7), Vector3d(0.8, 0, 0.9)};
  arm.motion = Motion::prescribed;
  arm.rigid.prescribed.harmonics = {{Direction::pitch, 0.7, 1.3, 0.0, 0.1}, {Direction::surge, 0.1, 1.1, 0.0, 0.1}};
  scene.bodies = {arm};
  OpeningCase nozzle = opening("nozzle", OpeningKind::inlet, Vector3d(0.8, 0, 0.8), Vector3d::UnitX(), 0.08);
  nozzle.body = "arm";
  nozzle.velocity = velocity;
  scene.openings = {nozzle};
  return scene;
}

// Seen from the body the water beyond stands on its lattice, however the body moves, and whether water flows or not.
TEST_F(Openings, OfABodyThatMovesCarryTheirLattice) {
  for (const std::string velocity : {"0", "0.8"}) {
    Simulation simulation(swinging_nozzle(velocity));
    const Vector3d reference = simulation.bodies().reference(1);
    std::size_t looked_at = 0;
    while (simulation.state().time < 0.8) {
      simulation.advance();
      if (simulation.state().step % 20 != 0) continue;
      const RigidState arm = simulation.bodies().state(1);
      std::map<int, std::vector<double>> behind;  // along x, by row
      for (const auto& [id, place] : places_of(simulation)) {
        const Vector3d home = reference + arm.orientation.conjugate() * (place.cast<double>() - arm.position);
        if (home.x() > 0.8 - 1e-3 * 0.02 || std::abs(home.z() - 0.8) > 0.04 || home.x() < 0.6) continue;
        const double row = (home.z() - 0.76) / 0.02 - 0.5;
        ASSERT_NEAR(row, std::round(row), 5e-3) << "at t = " << simulation.state().time;
        behind[static_cast<int>(std::lround(row))].push_back(home.x());
      }
      ASSERT_EQ(behind.size(), 4u);
      for (auto& [row, along] : behind) {
        std::sort(along.begin(), along.end());
        ASSERT_GE(along.size(), 4u);
        for (std::size_t k = 1; k < along.size(); ++k) ASSERT_NEAR(along[k] - along[k - 1], 0.02, 5e-3 * 0.02) << "in row " << row;
        ++looked_at;
      }
    }
    EXPECT_GT(looked_at, 40u);
    const OpeningState& state = simulation.openings()[0];
    EXPECT_EQ(state.mass_out, 0);
    EXPECT_NEAR(state.mass_in, 1000 * 0.08 * 0.8 * std::stod(velocity), 1000 * 0.08 * 0.02);
  }
}

TEST_F(Openings, OfABodyThatMovesRepeatFromASnapshot) { expect_to_go_on_from_a_snapshot(swinging_nozzle("0.8")); }

/// A round nozzle in a box that moves over an empty tank in 3-D, and blows at a floor that is a drain in part.
Case nozzle_on_an_arm(Motion motion) {
  Case scene = box_case(Vector3d(0.8, 0.6, 0.6), 0.1, 0.025);
  scene.fluid.fill.clear();
  scene.fluid.sound_speed = 40;
  scene.duration = 1;
  BodyCase arm;
  arm.name = "arm";
  arm.shape = Box{Vector3d(0.1, 0.2, 0.25), Vector3d(0.3, 0.4, 0.45)};
  arm.motion = motion;
  if (motion == Motion::prescribed)
    arm.rigid.prescribed.harmonics = {{Direction::yaw, 0.3, 1.3, 0.0, 0.1}, {Direction::pitch, -0.4, 0.9, 0.0, 0.1}};
  scene.bodies = {arm};
  OpeningCase nozzle = opening("nozzle", OpeningKind::inlet, Vector3d(0.3, 0.3, 0.35), Vector3d::UnitX(), 0);
  nozzle.size.reset();
  nozzle.diameter = 0.1;
  nozzle.body = "arm";
  nozzle.velocity = "0.8";
  OpeningCase drain = opening("drain", OpeningKind::outlet, Vector3d(0.5, 0.3, 0), Vector3d::UnitZ(), 0);
  drain.size = std::array<double, 2>{0.4, 0.5};
  scene.openings = {nozzle, drain};
  return scene;
}

// In 3-D, by a body that follows commands (as one that follows a law: above, in 2-D): rows a spacing apart along the nozzle, wherever that
// points, all water that the discharge relative to the nozzle makes, and an account that is even.
TEST_F(Openings, OfABodyThatMovesInThreeDimensionsCarryTheirLattice) {
  Simulation simulation(nozzle_on_an_arm(Motion::commanded));
  const Vector3d reference = simulation.bodies().reference(1);
  std::size_t looked_at = 0;
  while (simulation.state().time < 0.5) {
    simulation.command(1, Vector3d(0.1, 0.2, 0), Vector3d(0, 0.6, -0.8));
    simulation.advance();
    if (simulation.state().step % 20 != 0) continue;
    const RigidState arm = simulation.bodies().state(1);
    std::map<std::pair<long, long>, std::vector<double>> behind;  // along x, by column, in fifths of a spacing
    for (const auto& [id, place] : places_of(simulation)) {
      const Vector3d home = reference + arm.orientation.conjugate() * (place.cast<double>() - arm.position);
      if (home.x() > 0.3 - 1e-3 * 0.025 || (home.tail<2>() - Eigen::Vector2d(0.3, 0.35)).norm() > 0.06 || home.x() < 0.1) continue;
      behind[{std::lround(home.y() / 0.005), std::lround(home.z() / 0.005)}].push_back(home.x());
    }
    ASSERT_EQ(behind.size(), 12u) << "of the 16 cells of the disc's square, the corners' are given to their neighbours";
    for (auto& [column, along] : behind) {
      std::sort(along.begin(), along.end());
      ASSERT_GE(along.size(), 3u);
      for (std::size_t k = 1; k < along.size(); ++k) ASSERT_NEAR(along[k] - along[k - 1], 0.025, 5e-3 * 0.025) << simulation.state().time;
      ++looked_at;
    }
  }
  EXPECT_GT(looked_at, 100u);
  const RigidState arm = simulation.bodies().state(1);
  EXPECT_GT(arm.orientation.angularDistance(Quaterniond::Identity()), 0.1) << "it has turned";
  const Balance balance = balance_of(simulation);
  const double area = 0.25 * std::acos(-1.0) * 0.1 * 0.1;
  std::printf("%.4f kg in, %.4f kg out, of %.4f\n", balance.in, balance.out, 1000 * area * 0.8 * simulation.state().time);
  EXPECT_NEAR(balance.in, 1000 * area * 0.8 * simulation.state().time, 1000 * area * 0.025);
  EXPECT_GT(balance.out, 0);
  EXPECT_NEAR(mass_of(simulation) - 1000 * area * 0.1, balance.in - balance.out, 1e-6 * balance.in) << "0.1 m stand in the nozzle";
}

TEST_F(Openings, OfABodyThatMovesInThreeDimensionsRepeatFromASnapshot) {
  expect_to_go_on_from_a_snapshot(nozzle_on_an_arm(Motion::prescribed));
}

// A rectangle in a wall, in 3-D, by which a tank is filled to a head, and a disc that takes as much away.
TEST_F(Openings, OfThreeDimensionsMeetTheirAccounts) {
  Case scene = box_case(Vector3d(0.8, 0.4, 0.5), 0.2, 0.04);
  OpeningCase head = opening("head", OpeningKind::pressure, Vector3d(0, 0.2, 0.16), Vector3d::UnitX(), 0);
  head.size = std::array<double, 2>{0.24, 0.16};
  head.head = "0.35";
  OpeningCase outlet = opening("outlet", OpeningKind::outlet, Vector3d(0.8, 0.2, 0.12), -Vector3d::UnitX(), 0);
  outlet.size.reset();
  outlet.diameter = 0.16;
  outlet.discharge = "0.008";
  scene.openings = {head, outlet};
  scene.duration = 1;
  const double out = 1000 * 0.008 * 0.5, row = 1000 * 0.25 * std::acos(-1.0) * 0.16 * 0.16 * 0.04;
  expect_account(scene, 0.5, {0.2, 0}, {0, out - row});
}

// What leaves comes back: a channel that drives itself keeps its water, and what an outlet pumps the inlet brings.
TEST_F(Openings, BringBackWhatLeavesAtAnother) {
  Case scene = channel("");
  scene.fluid.current = Vector3d(0.4, 0, 0);
  scene.openings[1].level.reset();
  scene.openings[1].discharge = "0.1 + 0.06*sin(5*t)";
  scene.openings[1].returns_to = "start";
  Simulation simulation(scene);
  const double mass = mass_of(simulation);
  double farthest = 0;
  while (simulation.state().time < 3) {
    simulation.advance();
    farthest = std::max(farthest, std::abs(mass_of(simulation) - mass));
    if (simulation.state().time > 0.1)
      ASSERT_NEAR(simulation.openings()[0].discharge, -simulation.openings()[1].discharge, 0.1 * 0.16) << simulation.state().time;
  }
  EXPECT_GT(simulation.openings()[1].mass_out, 0.9 * 1000 * 0.1 * 3);
  EXPECT_LT(farthest, 2.1 * depth * spacing * 1000);  // a row of particles at either end
}

TEST_F(Openings, HaveTheProfileOfAnExpression) {
  Case shear = channel("0.4");
  shear.openings[0].profile = "2*z";
  Case by_place = channel("(0.4 + 0*t)*2*z/0.4");
  for (const Case& scene : {shear, by_place}) {
    Simulation simulation(scene);
    while (simulation.state().time < 0.3) simulation.advance();
    EXPECT_NEAR(simulation.openings()[0].discharge, 0.4 * depth, 1e-6);
    const ParticleCloud cloud = simulation.particles();
    int looked_at = 0;
    for (std::size_t i = 0; i < cloud.id.size(); ++i) {
      if (cloud.position[i].x() > -1e-3 || cloud.position[i].z() > depth) continue;
      const double row = (std::floor(cloud.position[i].z() / spacing) + 0.5) * spacing;
      EXPECT_NEAR(cloud.velocity[i].x(), 0.4 * 2 * row / depth, 1e-5);
      ++looked_at;
    }
    EXPECT_GT(looked_at, 40);
  }
  shear.openings[0].profile = "z - 0.1";
  EXPECT_NE(error_of([&] { Simulation simulation(shear); }).find("opening 'start': its profile at (0, 0, 0.02) m is -0.08; it must be"),
            std::string::npos);
  EXPECT_NE(error_of([&] { Simulation simulation(channel("z - 0.1")); }).find("opening 'start': its velocity at t = 0 s is -0.08"),
            std::string::npos);
}

// Snapshots whose checksums are right, but which no run of the case can have written: refused before anything is set.
TEST_F(Openings, AndBodiesAndClocksRefuseWhatCannotHaveBeenSaved) {
  Case scene = channel("0.2");
  BodyCase box;
  box.name = "box";
  box.shape = Box{Vector3d(0.5, -0.1, 0.3), Vector3d(0.7, 0.1, 0.5)};
  box.motion = Motion::free;
  box.rigid.density = 500;
  scene.bodies = {box};
  Simulation simulation(scene);
  run_steps(simulation, 20);
  simulation.save(path("good"));
  run_steps(simulation, 5);
  const std::string before = snapshot(simulation);
  const auto expect_refused = [&](const char* word, const std::function<void(Snapshot&)>& damage) {
    Snapshot damaged = read_snapshot(path("good"));
    damage(damaged);
    write_snapshot(path("damaged"), damaged);
    const std::string message = error_of([&] { simulation.restore(path("damaged")); });
    EXPECT_NE(message.find(path("damaged")), std::string::npos) << message;
    EXPECT_NE(message.find(word), std::string::npos) << message;
    EXPECT_TRUE(snapshot(simulation) == before) << "changed by: " << message;
  };
  const auto put = [](std::vector<char>& bytes, std::size_t place, double value) {
    ASSERT_LT((place + 1) * sizeof value, bytes.size());
    std::memcpy(bytes.data() + place * sizeof value, &value, sizeof value);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr std::size_t instants = 15;         // after as many columns, the number of instants that the first opening remembers
  constexpr std::size_t turn = 2 * 6 + 3 + 3;  // after what is felt, the world's head and the tank's place
  expect_refused("openings", [](Snapshot& of) { of.openings.resize(of.openings.size() - sizeof(double)); });
  expect_refused("openings", [](Snapshot& of) { of.openings.resize(of.openings.size() + sizeof(double)); });
  expect_refused("openings", [](Snapshot& of) { of.openings.clear(); });
  expect_refused("openings", [&](Snapshot& of) { put(of.openings, instants, 1e300); });
  expect_refused("openings", [&](Snapshot& of) { put(of.openings, instants, -1); });
  expect_refused("openings", [&](Snapshot& of) { put(of.openings, 0, nan); });
  expect_refused("openings", [&](Snapshot& of) { put(of.openings, 0, 5); });  // spacings and more at once
  expect_refused("turn", [&](Snapshot& of) { put(of.bodies, turn, 2); });
  expect_refused("velocity", [&](Snapshot& of) { put(of.bodies, turn + 4, nan); });
  expect_refused("acceleration", [&](Snapshot& of) { put(of.bodies, 0, nan); });
  expect_refused("time step is 0 s", [](Snapshot& of) { of.time_step = 0; });
  expect_refused("time step is 1e+300 s", [](Snapshot& of) { of.time_step = 1e300; });
  expect_refused("time is nan", [&](Snapshot& of) { of.time = nan; });
  expect_refused("instruments", [](Snapshot& of) {
    of.clocks[0] = 0;
    of.time += 1000;
  });
  expect_refused("instruments", [](Snapshot& of) { of.instruments = {1.0}; });
  simulation.restore(path("good"));
  EXPECT_EQ(simulation.state().step, 20u);
}

// A snapshot knows a law of time and place, which is in the case's text.
TEST_F(Openings, OfALawByPlaceRepeatFromASnapshot) {
  const Case scene = channel("(0.4 + 0.1*sin(9*t))*(z < 0.2 ? 1 : 0.5)");
  Simulation first(scene), second(scene);
  run_steps(first, 80);
  first.save(path("middle"));
  run_steps(first, 80);
  second.restore(path("middle"));
  run_steps(second, 80);
  EXPECT_EQ(snapshot(first), snapshot(second));
}

// A thin film falls through a hole in the floor by columns that are all but dry: what leaves there comes back all the same.
TEST_F(Openings, BringBackWhatFellThroughAHole) {
  Case scene = box_case(Vector3d(1.2, 0, 0.8), 0.04, 0.02);
  scene.fluid.fill.clear();
  scene.fluid.sound_speed = 40;
  scene.duration = 3;
  OpeningCase tap = opening("tap", OpeningKind::inlet, Vector3d(0, 0, 0.5), Vector3d::UnitX(), 0.06);
  OpeningCase hole = opening("hole", OpeningKind::outlet, Vector3d(0.8, 0, 0), Vector3d::UnitZ(), 0.6);
  hole.up = Vector3d::UnitX();
  hole.returns_to = "tap";
  OpeningCase hose = opening("hose", OpeningKind::inlet, Vector3d(0, 0, 0.3), Vector3d::UnitX(), 0.06);
  hose.discharge = "t < 0.6 ? 0.06 : 0";
  scene.openings = {tap, hole, hose};
  Simulation simulation(scene);
  run_to(simulation, 3);
  const OpeningState &in = simulation.openings()[0], &out = simulation.openings()[1];
  EXPECT_GT(out.mass_out, 15);
  // the rest is on its way: in the inlet's slowness, 1.7 s or so, and in the air
  EXPECT_GT(in.mass_in, 0.5 * out.mass_out);
  EXPECT_LE(in.mass_in, out.mass_out);
}

TEST_F(Openings, HaveAProfileWhereWaterComesIn) {
  Case scene = channel("0.4");
  scene.openings[0].profile = "z*(0.4 - z)";  // negative above the level, where nothing comes in
  Simulation simulation(scene);
  run_steps(simulation, 5);
  EXPECT_NEAR(simulation.openings()[0].discharge, 0.4 * depth, 1e-6);
  scene.openings[0].profile = "max(z - 0.4, 0)";
  EXPECT_NE(error_of([&] { Simulation again(scene); }).find("its profile is 0 wherever water passes"), std::string::npos);
}

TEST_F(Openings, CarriedOutOfTheTankEndTheRun) {
  Case scene = swinging_nozzle("0.5");
  scene.bodies[0].rigid.prescribed.harmonics = {{Direction::surge, -0.8, 0.5, 0.0, 0.1}};
  Simulation simulation(scene);
  const std::string message = error_of([&] { run_to(simulation, 1); });
  EXPECT_NE(message.find("opening 'nozzle' is carried out of the tank"), std::string::npos) << message;
}

TEST_F(Openings, ThatReturnTooMuchAreRefused) {
  Case scene = channel("");
  scene.fluid.sound_speed = 28;
  scene.openings[1].level.reset();
  scene.openings[1].discharge = "2";
  scene.openings[1].returns_to = "start";
  EXPECT_NE(error_of([&] { Simulation simulation(scene); }).find("opening 'start': its water moves at up to 5 m/s"), std::string::npos);
}

// ---------------------------------------------------------------- between ghosts

Case with_ghosts(Case scene) {
  scene.numerics.walls.method = WallMethod::ghost;
  return scene;
}

/// The channel in a current, whose ends are open up to `height`, between ghosts.
Case ghost_channel(double height, Scheme scheme = Scheme::delta_sph) {
  Case scene = with_ghosts(channel("0.4"));
  scene.fluid.current = Vector3d(0.4, 0, 0);
  for (OpeningCase& opening : scene.openings) {
    opening.size = std::array<double, 2>{1.0, height};
    opening.centre.z() = 0.5 * height;
  }
  scene.numerics.scheme = scheme;
  if (scheme != Scheme::delta_sph) {
    scene.numerics.density_diffusion = DensityDiffusion::none;
    scene.numerics.shifting = Shifting::michel;
  }
  return scene;
}

/// Greatest difference of the water's velocity from `current` at a depth of more than two spacings under `level`, m/s.
double farthest_from_current(const Simulation& simulation, double current, double level) {
  const ParticleCloud cloud = simulation.particles();
  double farthest = 0;
  for (std::size_t i = 0; i < cloud.id.size(); ++i)
    if (cloud.position[i].z() < level - 2 * spacing)
      farthest = std::max(farthest, static_cast<double>((cloud.velocity[i] - Eigen::Vector3f(current, 0, 0)).norm()));
  return farthest;
}

// The ends' planes go on over the openings, and must not mirror what is before those: the water is as uniform as in a channel without end
// walls, to what the first steps from rest stir up (the closed tank at rest has 0.06 m/s).
TEST_F(Openings, BetweenGhostsAChannelStaysUniform) {
  for (const Scheme scheme : {Scheme::delta_sph, Scheme::riemann_parshikov, Scheme::riemann_ale}) {
    double farthest[2] = {0, 0};
    for (const double height : {0.6, 0.5}) {
      if (height < 0.6 && scheme != Scheme::delta_sph) continue;  // how high the planes are matters to each alike
      const Case scene = ghost_channel(height, scheme);
      Simulation simulation(scene);
      const double mass = mass_of(simulation);
      double& most = farthest[height < 0.55 ? 1 : 0];
      while (simulation.state().time < 0.4) {
        simulation.advance();
        if (simulation.state().step % 20 == 0) most = std::max(most, farthest_from_current(simulation, 0.4, depth));
      }
      const Balance balance = balance_of(simulation);
      std::printf("%s, %.1f m: %.4f m/s off the current, in %.3f, out %.3f kg, of %.3f off by %.3g\n", word_of(scheme).c_str(), height,
                  most, balance.in, balance.out, mass, mass + balance.in - balance.out - mass_of(simulation));
      EXPECT_NEAR(balance.in, 0.4 * 0.4 * depth * 1000, 1.01 * 10 * spacing * spacing * 1000);  // a row of particles at the most
      EXPECT_NEAR(mass + balance.in - balance.out, mass_of(simulation), (scheme == Scheme::riemann_ale ? 1e-4 : 1e-6) * mass);
    }
    EXPECT_LT(farthest[0], 0.1);
    if (scheme == Scheme::delta_sph) EXPECT_LT(farthest[1], 1.1 * farthest[0]);
  }
}

// A hole in the wall and one in the floor, both under water and held at its level: the planes about them mirror, the water behind them
// stands in for the rest.
TEST_F(Openings, BetweenGhostsStillWaterStaysStillBeforeHoles) {
  Case scene = with_ghosts(tank_with_outlet());
  OpeningCase side = opening("side", OpeningKind::outlet, Vector3d(1.2, 0, 0.2), -Vector3d::UnitX(), 0.32);
  side.level = depth;
  OpeningCase floor = opening("floor", OpeningKind::pressure, Vector3d(0.5, 0, 0), Vector3d::UnitZ(), 0.32);
  floor.up = Vector3d::UnitX();
  floor.head = "0.4";
  Case closed = scene;
  closed.openings.clear();
  scene.openings = {side, floor};
  Simulation with(scene), without(closed);
  double fastest_with = 0, fastest_without = 0;
  while (with.state().time < 0.6) {
    with.advance();
    without.advance();
    fastest_with = std::max(fastest_with, with.state().greatest_speed);
    fastest_without = std::max(fastest_without, without.state().greatest_speed);
  }
  std::printf("%.4f with holes, %.4f m/s without; in %.3g, out %.3g\n", fastest_with, fastest_without, balance_of(with).in,
              balance_of(with).out);
  EXPECT_LT(fastest_with, 1.3 * fastest_without) << "1.25 was measured";
  EXPECT_EQ(balance_of(with).in, 0);
  EXPECT_EQ(balance_of(with).out, 0);
}

TEST_F(Openings, BetweenGhostsRepeatFromASnapshot) { expect_to_go_on_from_a_snapshot(ghost_channel(0.5)); }

// A slot in the floor, ten spacings wide, with air below it, lets as much out as between walls by integrals.
TEST_F(Openings, BetweenGhostsWaterLeavesByASlot) {
  Case scene = box_case(Vector3d(1.2, 0, 0.6), 0.4, spacing);
  OpeningCase slot = opening("slot", OpeningKind::outlet, Vector3d(0.6, 0, 0), Vector3d::UnitZ(), 0.4);
  slot.up = Vector3d::UnitX();
  slot.level = -1;
  scene.openings = {slot};
  double left[2] = {0, 0};
  for (const bool ghosts : {false, true}) {
    Simulation simulation(ghosts ? with_ghosts(scene) : scene);
    run_to(simulation, 0.4);
    left[ghosts ? 1 : 0] = balance_of(simulation).out;
  }
  EXPECT_GT(left[1], 40);
  EXPECT_NEAR(left[1], left[0], 1.01 * 10 * spacing * spacing * 1000);  // a row of particles
}

// A round hole in 3-D, and one that is too narrow for images beside it.
TEST_F(Openings, BetweenGhostsWaterLeavesByARoundHole) {
  Case scene = with_ghosts(box_case(Vector3d(0.6, 0.6, 0.4), 0.2, 0.04));
  OpeningCase hole = opening("hole", OpeningKind::outlet, Vector3d(0.3, 0.3, 0), Vector3d::UnitZ(), 0);
  hole.size.reset();
  hole.diameter = 0.32;
  hole.level = -1;
  scene.openings = {hole};
  expect_account(scene, 0.3, {0}, {1});
  scene.openings[0].diameter = 0.16;
  EXPECT_EQ(error_of([&] { Simulation simulation(scene); }),
            "opening 'hole' is a hole 4 spacings wide in a wall, and numerics/walls/method is ghost: half of what should leaves there; "
            "make it at "
            "least 8 spacings wide, give its discharge, or choose boundary_integral.");
  scene.openings[0].discharge = "0.01";
  scene.openings[0].level.reset();
  EXPECT_NO_THROW(Simulation simulation(scene)) << "what is given leaves";
}

}  // namespace
}  // namespace wavetank::openings_test

// Bodies in water: they float as deep as they are heavy, light ones too, take and give momentum, rest on the floor, and go on from a
// snapshot to the same bits.
#include <algorithm>

#include "simulation_fixture.h"

namespace wavetank {
namespace {

BodyCase free_box(const std::string& name, const Box& box, double density) {
  BodyCase body;
  body.name = name;
  body.shape = box;
  body.motion = Motion::free;
  body.rigid.density = density;
  return body;
}

/// Water of the given depth in a tank of 0.6 m × 0.5 m, 2-D.
Case pool(double depth, double spacing) {
  Case scene = box_case(Vector3d(0.6, 0, 0.5), depth, spacing);
  scene.numerics.packing.iterations = 200;
  scene.instruments.rate = 200;
  scene.instruments.pose_rate = 200;
  return scene;
}

double pitch_of(const RigidState& state) { return 2 * std::atan2(state.orientation.y(), state.orientation.w()); }

struct Statistics {
  double mean = 0, deviation = 0;
};

template <class Value>
Statistics statistics(const Samples& samples, double from, Value value) {
  double sum = 0, squares = 0;
  int count = 0;
  for (const WrenchSample& sample : samples.wrenches) {
    if (sample.time < from) continue;
    const double v = value(sample);
    sum += v;
    squares += v * v;
    ++count;
  }
  const double mean = sum / count;
  return {mean, std::sqrt(std::max(squares / count - mean * mean, 0.0))};
}

// ---- forces

// The issue of this: within 2 % in the mean, and below 5 % of it in the standard deviation.
TEST(Bodies, ACubeSevenParticlesAcrossIsPushedUpByItsWeightOfWater) {
  const double side = 0.14, density = 1000, gravity = 9.81;
  Case scene = box_case(Vector3d(0.4, 0.4, 0.4), 0.34, side / 7);
  scene.fluid.density = density;
  scene.bodies.push_back({"cube", Box{Vector3d(0.13, 0.13, 0.1), Vector3d(0.27, 0.27, 0.24)}});
  scene.numerics.packing.settling = 3;
  scene.instruments.rate = 200;
  Simulation simulation(scene);
  const Samples samples = run_to(simulation, 0.5);
  const Statistics force = statistics(samples, 0.1, [](const WrenchSample& sample) { return sample.wrenches[1].pressure_force.z(); });
  const double archimedes = density * gravity * std::pow(side, 3);
  std::printf("force %.3f N, Archimedes' %.3f N: %+.2f %%, standard deviation %.2f %%\n", force.mean, archimedes,
              100 * (force.mean / archimedes - 1), 100 * force.deviation / archimedes);
  EXPECT_NEAR(force.mean, archimedes, 0.02 * archimedes);
  EXPECT_LT(force.deviation, 0.05 * archimedes);
}

// A box flies into a block of water, far from the tank's walls and without gravity: what one gains the other loses, to rounding.
TEST(Bodies, GiveAndTakeMomentumWithTheWater) {
  for (const WallElements elements : {WallElements::facet, WallElements::numerical}) {
    Case scene = box_case(Vector3d(1, 0, 1), 0.3, 0.01);
    scene.fluid.fill = {Box{Vector3d(0.4, 0, 0.4), Vector3d(0.6, 0, 0.6)}};
    scene.fluid.sound_speed = 20;
    scene.gravity = Vector3d::Zero();
    scene.numerics.walls.elements = elements;
    scene.numerics.walls.guard_distance = 0;  // it takes momentum by itself
    scene.numerics.packing.iterations = 100;
    scene.bodies.push_back(free_box("box", Box{Vector3d(0.29, 0, 0.45), Vector3d(0.39, 0, 0.51)}, 700));
    scene.bodies[0].rigid.velocity = Vector3d(0.8, 0, 0.1);
    Simulation simulation(scene);
    const double mass = simulation.bodies().properties(1).mass;
    const Vector3d start = mass * scene.bodies[0].rigid.velocity;
    double error = 0, taken = 0;
    for (int k = 0; k < 30; ++k) {
      run_steps(simulation, 10);
      const ParticleCloud cloud = simulation.particles();
      Vector3d water = Vector3d::Zero();
      for (const Eigen::Vector3f& velocity : cloud.velocity) water += velocity.cast<double>();
      water *= scene.fluid.density * 1e-4;
      error = std::max(error, (water + mass * simulation.bodies().state(1).velocity - start).norm() / start.norm());
      taken = water.norm() / start.norm();
    }
    std::printf("t = %.3f s: the water has %.2f of the momentum; the whole of it is off by at most %.1e\n", simulation.state().time, taken,
                error);
    EXPECT_GT(taken, 0.2);
    EXPECT_LT(error, 1e-5);  // float32's 6e-8 of each velocity, a hundred times over in 300 steps of rounded kicks
  }
}

// ---- floating

// Let go at its draught, a box stays there: half a spacing is the bar. Wider than high, or it would not float upright.
TEST(Bodies, FloatAsDeepAsTheyAreHeavy) {
  for (const double ratio : {0.5, 0.68}) {
    Case scene = pool(0.25, 0.01);
    const double height = 0.1, bottom = 0.25 - ratio * height;
    scene.bodies.push_back(free_box("box", Box{Vector3d(0.2, 0, bottom), Vector3d(0.4, 0, bottom + height)}, ratio * scene.fluid.density));
    Simulation simulation(scene);
    const Samples samples = run_to(simulation, 2.5);
    double sum = 0;
    int count = 0;
    for (const PoseSample& sample : samples.poses) {
      if (sample.time < 1.5) continue;
      sum += sample.states[1].position.z();
      EXPECT_LT(std::abs(pitch_of(sample.states[1])), 0.05);
      ++count;
    }
    const double draught = 0.25 - (sum / count - 0.5 * height);
    std::printf("density ratio %.2f: draught %.4f m, %+.2f spacings from %.4f m\n", ratio, draught, (draught - ratio * height) / 0.01,
                ratio * height);
    EXPECT_NEAR(draught, ratio * height, 0.005);
  }
}

// Held under water and let go, bodies that are much lighter than their added mass rise and float. Without the relaxation of what the fluid
// is told of their acceleration, those of 0.02 burst within a tenth of a second.
TEST(Bodies, MuchLighterThanWaterRiseAndFloat) {
  for (const double ratio : {0.1, 0.02}) {
    Case scene = pool(0.3, 0.01);
    scene.bodies.push_back(free_box("box", Box{Vector3d(0.2, 0, 0.1), Vector3d(0.4, 0, 0.2)}, ratio * scene.fluid.density));
    Simulation simulation(scene);
    const Samples samples = run_to(simulation, 0.8);
    double fastest = 0;
    for (const PoseSample& sample : samples.poses) fastest = std::max(fastest, sample.states[1].velocity.norm());
    const double height = samples.poses.back().states[1].position.z();
    std::printf("density ratio %.2f: at z = %.3f m after 0.8 s, fastest %.2f m/s\n", ratio, height, fastest);
    EXPECT_GT(height, 0.27);
    EXPECT_LT(fastest, std::sqrt(2 * 9.81 * 0.2)) << "faster than it could fall from where it came to";
  }
}

TEST(Bodies, AsHeavyAsWaterHover) {
  const double side = 0.14;
  Case scene = box_case(Vector3d(0.4, 0.4, 0.4), 0.34, side / 7);
  scene.bodies.push_back(free_box("cube", Box{Vector3d(0.13, 0.13, 0.1), Vector3d(0.27, 0.27, 0.24)}, scene.fluid.density));
  scene.numerics.packing.settling = 3;
  scene.instruments.rate = 100;
  Simulation simulation(scene);
  const Samples samples = run_to(simulation, 1.0);
  double farthest = 0;
  for (const PoseSample& sample : samples.poses)
    farthest = std::max(farthest, (sample.states[1].position - samples.poses.front().states[1].position).norm());
  std::printf("a cube as heavy as water is at most %.2f spacings from where it was in 1 s\n", farthest / (side / 7));
  EXPECT_LT(farthest, 0.5 * side / 7);  // unbalanced by 1 %, it would be 2.5 spacings away
}

// ---- contact

// A heavy box stands on the floor under water: it neither sinks in nor trembles.
TEST(Bodies, RestOnTheFloorUnderWater) {
  Case scene = pool(0.25, 0.01);
  scene.bodies.push_back(free_box("box", Box{Vector3d(0.2, 0, 0), Vector3d(0.4, 0, 0.1)}, 2.0 * scene.fluid.density));
  Simulation simulation(scene);
  const Samples samples = run_to(simulation, 1.0);
  double deepest = 0, fastest = 0;
  for (const PoseSample& sample : samples.poses) {
    if (sample.time < 0.2) continue;
    deepest = std::max(deepest, std::abs(sample.states[1].position.z() - 0.05));
    fastest = std::max(fastest, sample.states[1].velocity.norm());
  }
  std::printf("on the floor: off it by at most %.3f spacings, fastest %.1e m/s\n", deepest / 0.01, fastest);
  EXPECT_LT(deepest, 0.001) << "a tenth of the spacing";
  EXPECT_LT(fastest, 1e-3);
}

// ---- motions

/// A wave maker, a box afloat, another on a hinge, in a tank that rolls.
Case busy_tank(WallElements elements) {
  Case scene = pool(0.2, 0.02);
  scene.numerics.walls.elements = elements;
  scene.numerics.packing.iterations = 50;
  scene.tank.motion = Motion::prescribed;
  scene.tank.rigid.prescribed.harmonics = {{Direction::pitch, 0.1, 1.0, 0.0, 0.2}};
  BodyCase piston;
  piston.name = "piston";
  piston.shape = Box{Vector3d(-0.06, 0, 0), Vector3d(0.04, 0, 0.4)};
  piston.motion = Motion::prescribed;
  piston.rigid.prescribed.harmonics = {{Direction::surge, 0.03, 2.0, 0.0, 0.1}};
  scene.bodies = {piston, free_box("afloat", Box{Vector3d(0.2, 0, 0.16), Vector3d(0.32, 0, 0.24)}, 500),
                  free_box("door", Box{Vector3d(0.44, 0, 0.1), Vector3d(0.5, 0, 0.3)}, 1500)};
  scene.fluid.fill = {Box{Vector3d(0.04, 0, 0), Vector3d(0.6, 0, 0.2)}};
  JointCase hinge;
  hinge.name = "hinge";
  hinge.type = JointType::hinge;
  hinge.parent = "tank";
  hinge.child = "door";
  hinge.point = Vector3d(0.47, 0, 0.3);
  scene.joints = {hinge};
  return scene;
}

bool same_poses(const Samples& a, const Samples& b) {
  if (a.poses.size() != b.poses.size()) return false;
  for (std::size_t k = 0; k < a.poses.size(); ++k)
    for (std::size_t o = 0; o < a.poses[k].states.size(); ++o) {
      const RigidState &p = a.poses[k].states[o], &q = b.poses[k].states[o];
      if (p.position != q.position || p.orientation.coeffs() != q.orientation.coeffs() || p.velocity != q.velocity ||
          p.angular_velocity != q.angular_velocity)
        return false;
    }
  return true;
}

using BodyBits = SimulationTest;

TEST_F(BodyBits, ResetAndSnapshotGoOnToTheSameBits) {
  constexpr int half = 120;
  for (const WallElements elements : {WallElements::facet, WallElements::numerical, WallElements::semi_analytical}) {
    const Case scene = busy_tank(elements);
    Simulation whole(scene);
    const std::string at_start = snapshot(whole);
    const Samples first = run_steps(whole, half);
    whole.save(path("middle"));
    const Samples second = run_steps(whole, half);
    const std::string at_end = snapshot(whole);
    ASSERT_GT(second.poses.size(), 10u);

    Simulation continued(scene);
    run_steps(continued, 7);  // wherever it was
    continued.restore(path("middle"));
    const Samples again = run_steps(continued, half);
    EXPECT_TRUE(same(again, second)) << "the samples differ";
    EXPECT_TRUE(same_poses(again, second)) << "the poses differ";
    EXPECT_TRUE(snapshot(continued) == at_end) << "the snapshots differ";

    whole.reset();
    EXPECT_TRUE(snapshot(whole) == at_start);
    EXPECT_TRUE(same_poses(run_steps(whole, half), first));
  }
}

// The water is solved in the tank's frame: a tank that is pushed along with a constant acceleration has its water as if gravity were
// tilted. Smooth motions begin gently, so the comparison is of where both have come to rest: the slope of the level between the ends.
TEST(MovingTank, AConstantAccelerationTiltsTheLevel) {
  const double acceleration = 1.5, slope = acceleration / 9.81;
  Case tilted = pool(0.2, 0.01);
  tilted.gravity = Vector3d(-acceleration, 0, -9.81);
  tilted.fluid.viscosity = 0.5;  // comes to rest soon
  tilted.fluid.sound_speed = 25;
  tilted.instruments.wave_gauges = {{"left", Vector3d(0.1, 0, 0)}, {"right", Vector3d(0.5, 0, 0)}};
  Case pushed = tilted;
  pushed.gravity = Vector3d(0, 0, -9.81);
  pushed.tank.motion = Motion::prescribed;
  // a sine so slow that its acceleration, after a quarter of its period, is that within 0.2 % for the last half second
  const double frequency = 0.004, omega = 2 * M_PI * frequency;
  pushed.tank.rigid.prescribed.harmonics = {{Direction::surge, acceleration / (omega * omega), frequency, -M_PI / 2, 0.0}};
  double found[2];
  int k = 0;
  for (const Case& scene : {tilted, pushed}) {
    Simulation simulation(scene);
    const Samples samples = run_to(simulation, 2.5);
    double sum = 0;
    int count = 0;
    for (const LevelSample& sample : samples.levels) {
      if (sample.time < 2.0) continue;
      sum += (sample.levels[0] - sample.levels[1]) / 0.4;
      ++count;
    }
    found[k++] = sum / count;
  }
  std::printf("slope of the level: %.4f under tilted gravity, %.4f in a tank that is pushed, %.4f expected\n", found[0], found[1], slope);
  EXPECT_NEAR(found[0], slope, 0.05 * slope);
  EXPECT_NEAR(found[1], found[0], 0.01 * slope);
}

// ---- what is refused

TEST(Bodies, RefuseWhatCannotAct) {
  Case scene = pool(0.2, 0.02);
  scene.bodies.push_back(free_box("afloat", Box{Vector3d(0.2, 0, 0.16), Vector3d(0.32, 0, 0.24)}, 500));
  scene.bodies.push_back({"pier", Box{Vector3d(0.4, 0, 0), Vector3d(0.48, 0, 0.1)}});
  Simulation simulation(scene);
  OutsideWrench push;
  push.force = Vector3d(1, 0, 0);
  simulation.set_outside_wrench(1, push);
  EXPECT_NE(error_of([&] { simulation.set_outside_wrench(2, push); }).find("pier"), std::string::npos);
  EXPECT_NE(error_of([&] { simulation.command(1, Vector3d::Zero(), Vector3d::Zero()); }).find("afloat"), std::string::npos);
  push.torque.y() = std::nan("");
  EXPECT_NE(error_of([&] { simulation.set_outside_wrench(1, push); }).find("afloat"), std::string::npos);
  run_steps(simulation, 3);
}

}  // namespace
}  // namespace wavetank

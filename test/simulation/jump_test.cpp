// No point of a body moves by more than a fifth of the spacing in a step, jumps of its velocity included: from the very step that they
// happen in.
#include <Eigen/Geometry>

#include "simulation_fixture.h"

namespace wavetank::jump_test {
namespace {

constexpr double spacing = 0.02, sound_speed = 20, most = 0.2 * spacing * (1 + 1e-6);

/// A bar in the air over a pool, with steps so long that it could move by 0.4 spacings in one.
Case bar_over_pool() {
  Case scene = box_case(Vector3d(2, 0, 1), 0.1, spacing);
  scene.fluid.sound_speed = sound_speed;
  scene.numerics.courant = 1;
  scene.numerics.packing.iterations = 20;
  BodyCase bar;
  bar.name = "bar";
  bar.shape = Box{Vector3d(0.4, 0, 0.5), Vector3d(0.8, 0, 0.6)};
  scene.bodies.push_back(bar);
  return scene;
}

Case commanded_bar() {
  Case scene = bar_over_pool();
  scene.bodies[0].motion = Motion::commanded;
  CommandCase& limits = scene.bodies[0].rigid.command;
  limits.greatest_acceleration = limits.greatest_angular_acceleration = {};
  limits.timeout = 0;
  return scene;
}

/// The farthest that a corner of the bar moves in any of the next steps, m.
double farthest(Simulation& simulation, int steps) {
  double farthest = 0;
  const Vector3d reference = simulation.bodies().reference(1);
  for (int step = 0; step < steps; ++step) {
    const RigidState before = simulation.bodies().state(1);
    simulation.advance();
    const RigidState after = simulation.bodies().state(1);
    for (const double x : {0.4, 0.8})
      for (const double z : {0.5, 0.6})
        farthest = std::max(farthest, (after.moved(Vector3d(x, 0, z), reference) - before.moved(Vector3d(x, 0, z), reference)).norm());
  }
  return farthest;
}

class Jump : public SimulationTest {
 protected:
  /// At rest, and from 20 ms on at a speed, m/s.
  Case bar_with_record(double speed) const {
    Case scene = bar_over_pool();
    scene.bodies[0].motion = Motion::prescribed;
    std::string record = "time,surge\n";
    for (int k = 0; k <= 400; ++k) {
      const double time = 1e-4 * k;
      record += std::to_string(time) + "," + std::to_string(std::max(time - 0.02, 0.0) * speed) + "\n";
    }
    write(path("jump.csv"), record);
    scene.bodies[0].rigid.prescribed.records = {RecordCase{path("jump.csv"), "time", "surge", {}, 1, 0}};
    return scene;
  }
};

TEST_F(Jump, OfACommandedVelocity) {
  Simulation simulation(commanded_bar());
  simulation.advance();
  const double long_step = simulation.state().time_step;
  simulation.command(1, Vector3d(8, 0, 0), Vector3d::Zero());
  EXPECT_LT(farthest(simulation, 5), most);
  simulation.command(1, Vector3d(-8, 0, 0), Vector3d::Zero());
  EXPECT_LT(farthest(simulation, 5), most);
  simulation.command(1, Vector3d::Zero(), Vector3d(0, 30, 0));
  EXPECT_LT(farthest(simulation, 5), most);
  simulation.command(1, Vector3d::Zero(), Vector3d::Zero());
  farthest(simulation, 3);
  EXPECT_GT(simulation.state().time_step, 0.9 * long_step) << "it stays short";
}

TEST_F(Jump, OfACommandThatASnapshotHas) {
  const Case scene = commanded_bar();
  {
    Simulation simulation(scene);
    simulation.advance();
    simulation.command(1, Vector3d(8, 0, 0), Vector3d::Zero());
    simulation.save(path("before"));
  }
  Simulation simulation(scene);
  simulation.restore(path("before"));
  EXPECT_LT(farthest(simulation, 5), most);
  Simulation again(scene);
  again.restore(path("before"));
  farthest(again, 5);
  EXPECT_TRUE(snapshot(simulation) == snapshot(again));
}

TEST_F(Jump, InARecord) {
  Simulation simulation(bar_with_record(8));
  double most_moved = 0;
  while (simulation.state().time < 0.03) most_moved = std::max(most_moved, farthest(simulation, 1));
  EXPECT_LT(most_moved, most);
  EXPECT_GT(most_moved, 0.9 * 0.2 * spacing) << "it did not jump";
}

// One so fast that the step would have no length.
TEST_F(Jump, BeyondAllReasonStopsTheRun) {
  Case scene = bar_over_pool();
  scene.bodies[0].motion = Motion::prescribed;
  RampCase ramp;
  ramp.direction = Direction::surge;
  ramp.change = 1000;
  ramp.from = 0.02;
  ramp.to = 0.02001;
  scene.bodies[0].rigid.prescribed.ramps = {ramp};
  Simulation simulation(scene);
  std::string message;
  try {
    while (simulation.state().time < 0.03) simulation.advance();
  } catch (const Violation& violation) {
    message = violation.what();
  }
  std::printf("%s\n", message.c_str());
  EXPECT_NE(message.find("a body jumps"), std::string::npos);
  EXPECT_NE(message.find(": the simulation stops"), std::string::npos);
}

TEST_F(Jump, ACommandBeyondReasonIsIgnoredAndTheOneBeforeStays) {
  Simulation simulation(commanded_bar());
  simulation.command(1, Vector3d(3, 0, 0), Vector3d::Zero());
  simulation.advance();
  for (const double speed : {1e308, 1e6, 0.5 * sound_speed}) {
    EXPECT_NE(error_of([&] { simulation.command(1, Vector3d(speed, 0, 0), Vector3d::Zero()); }).find("below half the speed of sound"),
              std::string::npos);
    EXPECT_NE(error_of([&] { simulation.command(1, Vector3d::Zero(), Vector3d(0, speed / 0.2, 0)); }).find("body 'bar'"),
              std::string::npos);
  }
  simulation.advance();
  EXPECT_EQ(simulation.bodies().state(1).velocity, Vector3d(3, 0, 0));
  simulation.command(1, Vector3d(3, 1e6, 0), Vector3d(1e6, 0, 1e6));  // in two dimensions these do not count
}

TEST_F(Jump, ATanksSpeedIsBoundedWhereNoLimitEasesIt) {
  Case scene = commanded_bar();
  scene.tank.motion = Motion::commanded;
  CommandCase& limits = scene.tank.rigid.command;
  limits.greatest_acceleration = 50;
  limits.greatest_angular_acceleration = {};
  limits.timeout = 0;
  const double fast = 0.6 * sound_speed;
  {
    Simulation simulation(scene);
    simulation.command(0, Vector3d(fast, 0, 0), Vector3d::Zero());
    EXPECT_NE(error_of([&] { simulation.command(0, Vector3d::Zero(), Vector3d(0, 1e4, 0)); }).find("the tank"), std::string::npos);
    while (simulation.bodies().state(0).velocity.x() < 0.12 * sound_speed) simulation.advance();
    // beside the tank the one is slower than half the speed of sound, and the other faster
    simulation.command(1, Vector3d(fast, 0, 0), Vector3d::Zero());
    EXPECT_NE(error_of([&] { simulation.command(1, Vector3d(-0.45 * sound_speed, 0, 0), Vector3d::Zero()); }).find("body 'bar'"),
              std::string::npos);
  }
  scene.tank.rigid.command.greatest_acceleration = {};
  scene.tank.rigid.command.greatest_angular_acceleration = 1;
  Simulation simulation(scene);
  EXPECT_NE(error_of([&] { simulation.command(0, Vector3d(fast, 0, 0), Vector3d::Zero()); }).find("the tank"), std::string::npos);
  simulation.command(0, Vector3d::Zero(), Vector3d(0, 1e4, 0));
}

}  // namespace
}  // namespace wavetank::jump_test

// A simulation on several devices: its samples and snapshots are the same for any number of them, and water that is too short is refused.
#include "simulation_fixture.h"

namespace wavetank::parts_test {
namespace {

using Parts = SimulationTest;

Case on(const std::string& devices) {
  Case scene = dam_break(0.02);
  scene.numerics.packing.iterations = 10;
  scene.device = devices;
  return scene;
}

TEST_F(Parts, HaveTheSameSamplesAndSnapshots) {
  Simulation two(on("auto,auto")), three(on("auto,auto,auto"));
  const Samples samples = run_steps(two, 100);
  EXPECT_GT(samples.pressures.size(), 20u);
  EXPECT_TRUE(same(samples, run_steps(three, 100)));
  EXPECT_TRUE(snapshot(two) == snapshot(three));
  EXPECT_EQ(two.device_description().rfind("2 parts on ", 0), 0u) << two.device_description();
}

TEST_F(Parts, GoOnFromASnapshotOfOthers) {
  Simulation two(on("auto,auto"));
  run_steps(two, 50);
  two.save(path("half"));
  run_steps(two, 50);
  Simulation three(on("auto,auto,auto"));
  three.restore(path("half"));
  run_steps(three, 50);
  EXPECT_TRUE(snapshot(two) == snapshot(three));
  three.reset();
  run_steps(three, 100);
  EXPECT_TRUE(snapshot(two) == snapshot(three));
}

/// A box that the water takes along, over the cut at first.
Case with_box(const std::string& devices) {
  Case scene = on(devices);
  BodyCase box;
  box.name = "box";
  box.shape = Box{Vector3d(0.2, 0, 0.3), Vector3d(0.44, 0, 0.44)};
  box.motion = Motion::free;
  box.rigid.density = 500;
  scene.bodies = {box};
  return scene;
}

TEST_F(Parts, HaveTheSameBodies) {
  Simulation two(with_box("auto,auto")), three(with_box("auto,auto,auto"));
  const Samples samples = run_steps(two, 60);
  EXPECT_GT((two.bodies().state(1).position - Simulation(with_box("auto")).bodies().state(1).position).norm(), 1e-3);
  EXPECT_TRUE(same(samples, run_steps(three, 60)));
  EXPECT_TRUE(snapshot(two) == snapshot(three));
  two.save(path("half"));
  run_steps(two, 40);
  three.reset();
  three.restore(path("half"));
  run_steps(three, 40);
  EXPECT_TRUE(snapshot(two) == snapshot(three)) << "restored";
}

/// A channel between openings, and a tank that is dry until a hose fills it.
TEST_F(Parts, HaveTheSameFlows) {
  const auto opening = [](const std::string& name, OpeningKind kind, const Vector3d& centre, const Vector3d& normal) {
    OpeningCase made;
    made.name = name;
    made.kind = kind;
    made.centre = centre;
    made.normal = normal;
    made.size = std::array<double, 2>{0.3, 0.3};
    made.velocity = kind == OpeningKind::inlet ? "0.5" : "";
    return made;
  };
  for (const bool dry : {false, true}) {
    Case scene = on("auto,auto");
    scene.tank.shape = BoxTank{Vector3d(1.6, 0, 0.6), Vector3d::Zero(), false};
    scene.bodies.clear();
    scene.instruments = {};
    scene.fluid.sound_speed = 30;
    scene.fluid.fill = {Box{Vector3d::Zero(), Vector3d(1.6, 0, 0.2)}};
    if (dry) scene.fluid.fill.clear();
    scene.openings = {opening("in", OpeningKind::inlet, Vector3d(0, 0, 0.15), Vector3d::UnitX())};
    if (!dry) scene.openings.push_back(opening("out", OpeningKind::outlet, Vector3d(1.6, 0, 0.15), -Vector3d::UnitX()));
    if (!dry) scene.openings[0].level = scene.openings[1].level = 0.2;
    Simulation two(scene);
    run_steps(two, 150);
    scene.device = "auto,auto,auto";
    Simulation three(scene);
    run_steps(three, 150);
    EXPECT_GT(two.openings()[0].mass_in, 1);
    EXPECT_TRUE(snapshot(two) == snapshot(three)) << (dry ? "dry" : "channel");
  }
}

/// What --check tells of parts is what they have.
TEST_F(Parts, NeedWhatIsToldBefore) {
  const Case scene = on("auto");
  const PartsEstimate one = estimate_parts(scene, 1), two = estimate_parts(scene, 2);
  EXPECT_EQ(one.need.own, one.particles);
  EXPECT_EQ(one.need.others, 0u);
  EXPECT_GE(2 * two.need.own, two.particles);
  EXPECT_LT(two.need.own, 0.7 * static_cast<double>(two.particles));
  EXPECT_GT(two.need.others, 0u);
  EXPECT_LT(two.need.others, 0.5 * static_cast<double>(two.particles));
  EXPECT_GT(one.need.memory, 0);
  Simulation run(on("auto,auto"));
  run_steps(run, 5);
  const auto had = static_cast<double>(run.device_memory());
  EXPECT_GT(2 * two.need.memory, 0.85 * had) << "messages and instruments come on top, of little water";
  EXPECT_LT(2 * two.need.memory, 1.3 * had) << "of parts of about one size";
  EXPECT_NE(error_of([&] { estimate_parts(scene, 100); }).find("too short"), std::string::npos);
}

TEST_F(Parts, AreRefusedWhereTheWaterIsTooShort) {
  Case scene = on("auto,auto,auto,auto,auto,auto,auto,auto,auto,auto,auto,auto");
  const std::string sentence = error_of([&] { Simulation simulation(scene); });
  EXPECT_EQ(sentence.rfind("the water is to be cut into 12 parts, but it is too short for that: of its ", 0), 0u) << sentence;
}

}  // namespace
}  // namespace wavetank::parts_test

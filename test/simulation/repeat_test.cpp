// The same case gives the same bits; a snapshot continues to the same bits; what is no snapshot of the case is refused.
#include "../../src/simulation/snapshot.h"
#include "simulation_fixture.h"

namespace wavetank::repeat_test {
namespace {

using Repeat = SimulationTest;
using Restore = SimulationTest;

/// Coarse, and past the water's arrival at the far wall.
constexpr double coarse = 0.04;
constexpr int steps = 300;

TEST_F(Repeat, TheSameCaseGivesTheSameBits) {
  Simulation first(dam_break(coarse)), second(dam_break(coarse));
  const Samples a = run_steps(first, steps), b = run_steps(second, steps);
  EXPECT_EQ(first.state().time, second.state().time);
  EXPECT_GT(a.pressures.size(), 100u);
  EXPECT_TRUE(same(a, b));
  EXPECT_TRUE(snapshot(first) == snapshot(second)) << "the snapshots differ";
}

TEST_F(Repeat, AlsoIn3D) {
  Case scene = box_case(Vector3d(0.8, 0.4, 0.6), 0.3, 0.05);
  scene.fluid.fill = {Box{Vector3d::Zero(), Vector3d(0.3, 0.4, 0.3)}};
  scene.numerics.packing.iterations = 20;
  Simulation first(scene), second(scene);
  EXPECT_TRUE(same(run_steps(first, 40), run_steps(second, 40)));
  EXPECT_TRUE(snapshot(first) == snapshot(second));
}

TEST_F(Repeat, AResetGivesTheBitsOfTheStart) {
  Simulation simulation(dam_break(coarse));
  const std::string at_start = snapshot(simulation);
  const Samples first = run_steps(simulation, steps);
  const std::string at_end = snapshot(simulation);
  simulation.reset();
  EXPECT_EQ(simulation.state().time, 0);
  EXPECT_EQ(simulation.state().step, 0u);
  EXPECT_TRUE(snapshot(simulation) == at_start);
  EXPECT_TRUE(same(run_steps(simulation, steps), first));
  EXPECT_TRUE(snapshot(simulation) == at_end);
}

TEST_F(Repeat, InstrumentsDoNotChangeTheFlow) {
  Case busy = dam_break(coarse), idle = busy;
  busy.instruments.rate = 5000;
  idle.instruments.rate = 1;
  idle.instruments.pressure_probes.clear();
  Simulation first(busy), second(idle);
  for (int k = 0; k < 5; ++k) {
    run_steps(first, steps / 5);
    run_steps(second, steps / 5);
    first.particles();
    first.energies();
  }
  EXPECT_EQ(first.state().time, second.state().time);
  const ParticleCloud a = first.particles(), b = second.particles();
  EXPECT_TRUE(a.id == b.id);
  EXPECT_TRUE(a.position == b.position);
  EXPECT_TRUE(a.velocity == b.velocity);
  EXPECT_TRUE(a.pressure == b.pressure);
}

TEST_F(Restore, ContinuesToTheSameBits) {
  Simulation whole(dam_break(coarse));
  Samples before = run_steps(whole, steps / 2);
  whole.save(path("middle"));
  const Samples after = run_steps(whole, steps / 2);
  ASSERT_GT(after.pressures.size(), 50u);

  Case scene = dam_break(coarse);
  scene.title = "another title is no other case";
  scene.duration = 7;
  Simulation continued(scene);
  run_steps(continued, 11);  // wherever it was
  continued.restore(path("middle"));
  EXPECT_EQ(continued.state().step, static_cast<std::uint64_t>(steps / 2));
  EXPECT_TRUE(same(run_steps(continued, steps / 2), after)) << "the samples differ";
  EXPECT_EQ(continued.state().time, whole.state().time);
  EXPECT_EQ(continued.state().guard_hits, whole.state().guard_hits);
  EXPECT_TRUE(snapshot(continued) == snapshot(whole)) << "the snapshots differ";
  // and once more, in the simulation that wrote it
  whole.restore(path("middle"));
  EXPECT_TRUE(same(run_steps(whole, steps / 2), after));
}

TEST_F(Restore, ContinuesAlsoWithAntuonosDiffusion) {
  Case scene = dam_break(coarse);
  scene.numerics.density_diffusion = DensityDiffusion::antuono;
  scene.numerics.packing.iterations = 20;
  Simulation whole(scene);
  run_steps(whole, 20);
  whole.save(path("middle"));
  run_steps(whole, 30);
  Simulation continued(scene);
  continued.restore(path("middle"));
  run_steps(continued, 30);
  EXPECT_TRUE(snapshot(continued) == snapshot(whole));
}

TEST_F(Restore, RefusesWhatIsNoSnapshotOfTheCase) {
  Simulation simulation(dam_break(coarse));
  run_steps(simulation, 20);
  simulation.save(path("good"));
  const std::string good = read(path("good"));

  Case finer = dam_break(0.05), thicker = dam_break(coarse);
  thicker.fluid.viscosity *= 2;
  Simulation(finer).save(path("finer"));
  Simulation(thicker).save(path("thicker"));
  write(path("empty"), "");
  write(path("foreign"), "#ROSBAG V2.0\n and so on");
  write(path("beginning"), good.substr(0, 10));
  write(path("magic"), good.substr(0, 20));
  write(path("half"), good.substr(0, good.size() / 2));
  write(path("short"), good.substr(0, good.size() - 1));
  write(path("long"), good + "x");
  std::string damaged = good;
  damaged[damaged.size() / 2] ^= 0x10;
  write(path("damaged"), damaged);

  Snapshot of_other_size = read_snapshot(path("good"));  // as of a case whose mesh was changed
  of_other_size.fluid.resize(of_other_size.fluid.size() - 64);
  write_snapshot(path("size"), of_other_size);

  run_steps(simulation, 5);
  const std::string before = snapshot(simulation);
  for (const char* name :
       {"missing", "empty", "foreign", "beginning", "magic", "half", "short", "long", "damaged", "finer", "thicker", "size"}) {
    const std::string message = error_of([&] { simulation.restore(path(name)); });
    EXPECT_NE(message.find(path(name)), std::string::npos) << name << ": " << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
    EXPECT_TRUE(snapshot(simulation) == before) << name << " changed the simulation";
  }
  EXPECT_NE(error_of([&] { simulation.restore(path("thicker")); }).find("another case"), std::string::npos);
  EXPECT_NE(error_of([&] { simulation.restore(directory.string()); }).find(directory.string()), std::string::npos);

  simulation.restore(path("good"));  // it still takes a good one
  EXPECT_EQ(simulation.state().step, 20u);
}

TEST_F(Restore, AFailedSaveLeavesNothingAndNamesTheFile) {
  Simulation simulation(dam_break(0.05));
  const std::string nowhere = path("no/such/directory/snapshot");
  EXPECT_NE(error_of([&] { simulation.save(nowhere); }).find(nowhere), std::string::npos);
  simulation.save(path("kept"));
  const std::string kept = read(path("kept"));
  std::filesystem::create_symlink(path("kept"), path("link"));  // what is no plain file is not written
  run_steps(simulation, 1);
  EXPECT_NE(error_of([&] { simulation.save(path("link")); }).find(path("link")), std::string::npos);
  EXPECT_TRUE(read(path("kept")) == kept) << "the old snapshot is damaged";
}

}  // namespace
}  // namespace wavetank::repeat_test

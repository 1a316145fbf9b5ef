// A solver's snapshot: blocks by name and by particle's id, refused as a whole.
#include "../common/error_of.h"
#include "sph_fixture.h"

namespace wavetank::snapshot_test {
namespace {

std::vector<char> cut(const std::vector<char>& bytes, std::size_t less) { return {bytes.begin(), bytes.end() - less}; }

class SolverSnapshot : public ::testing::Test {
 protected:
  SolverSnapshot() : tank(box_case(Vector3d(0.5, 0, 0.4), 0.25, 0.025)) { tank.pack_and_start(10); }

  void step(int count) {
    for (int k = 0; k < count; ++k) ASSERT_TRUE(tank.solver->advance().valid());
  }
  void expect_refused(const std::vector<char>& bytes, const std::string& words) {
    const std::vector<char> before = tank.solver->save();
    const std::string message = error_of([&] { tank.solver->restore(bytes); });
    EXPECT_NE(message.find(words), std::string::npos) << message;
    EXPECT_EQ(tank.solver->save(), before) << words;
  }

  Tank tank;
};

TEST_F(SolverSnapshot, IsTakenUpAgainToTheBit) {
  step(5);
  const std::vector<char> saved = tank.solver->save();
  step(20);
  const std::vector<char> later = tank.solver->save();
  tank.solver->restore(saved);
  EXPECT_EQ(tank.solver->save(), saved);
  step(20);
  EXPECT_EQ(tank.solver->save(), later);
}

/// The middle of a symplectic step goes by the gradients of its start, which nothing but the snapshot tells afterwards.
TEST(SnapshotOfRiemannSchemes, IsTakenUpAgainToTheBit) {
  for (const Scheme scheme : {Scheme::riemann_parshikov, Scheme::riemann_ale}) {
    SCOPED_TRACE(word_of(scheme));
    Case scene = box_case(Vector3d(0.5, 0, 0.4), 0.25, 0.025);
    scene.numerics.scheme = scheme;
    scene.numerics.density_diffusion = DensityDiffusion::none;
    scene.numerics.artificial_viscosity = 0;
    if (scheme == Scheme::riemann_parshikov) scene.numerics.shifting = Shifting::michel;  // of the other, steps would begin with new ones
    Tank tank(scene);
    tank.pack_and_start(10);
    for (int k = 0; k < 5; ++k) ASSERT_TRUE(tank.solver->advance().valid());
    const std::vector<char> saved = tank.solver->save();
    for (int k = 0; k < 20; ++k) {
      tank.solver->wrenches();  // which a reading may ask for at any time
      tank.solver->find_surface();
      ASSERT_TRUE(tank.solver->advance().valid());
    }
    const std::vector<char> later = tank.solver->save();
    tank.solver->restore(saved);
    EXPECT_EQ(tank.solver->save(), saved);
    for (int k = 0; k < 20; ++k) ASSERT_TRUE(tank.solver->advance().valid());
    EXPECT_EQ(tank.solver->save(), later);
    SnapshotBlocks older(saved);  // of when these were found anew
    remove_components(older, "particles: surroundings ");
    tank.solver->restore(older.bytes());
    SnapshotBlocks without(saved);
    remove_gradients(without);
    tank.solver->restore(without.bytes());
    for (int k = 0; k < 20; ++k) ASSERT_TRUE(tank.solver->advance().valid());
    EXPECT_NE(tank.solver->save(), later) << "gradients make no difference: nothing is shown";
  }
}

TEST_F(SolverSnapshot, DoesNotDependOnWhereTheDeviceKeepsAParticle) {
  step(5);
  StateBytes<float> state(*tank.solver);
  const FluidState fluid = tank.solver->download();
  bool moved = false;
  for (std::size_t i = 0; i < fluid.id.size(); ++i) {
    moved = moved || fluid.id[i] != i;
    EXPECT_EQ(static_cast<float>(fluid.velocity[i].z()), state.get("w", fluid.id[i])) << i;
    EXPECT_EQ(static_cast<float>(fluid.pressure[i]), state.get("pressure", fluid.id[i])) << i;
  }
  EXPECT_TRUE(moved) << "the device keeps all particles in the order of their ids: nothing is shown";
}

TEST_F(SolverSnapshot, IsRefusedAsAWhole) {
  step(3);
  const std::vector<char> saved = tank.solver->save();
  step(3);
  expect_refused(cut(saved, 1), "cut short");
  std::vector<char> damaged = saved;
  damaged.back() ^= 1;
  expect_refused(damaged, "damaged");
  SnapshotBlocks foreign(saved);
  foreign.put("particles: salt", std::vector<float>{1});
  expect_refused(foreign.bytes(), "\"particles: salt\", which this case does not know");
  expect_refused(SnapshotBlocks().bytes(), "has no \"particles: id\"");
  SnapshotBlocks other_size(saved);
  other_size.put("particles: mass", std::vector<double>(tank.solver->particle_count()));
  expect_refused(other_size.bytes(), "values of 8 bytes");
}

}  // namespace
}  // namespace wavetank::snapshot_test

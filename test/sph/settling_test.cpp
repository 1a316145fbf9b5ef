// Settling before the start: the water comes to rest in what the particles make of hydrostatics, held where it has a free side.
#include <algorithm>

#include "../common/error_of.h"
#include "sph_fixture.h"

namespace wavetank::settling_test {
namespace {

constexpr int packing_iterations = 100;
constexpr double periods = 3;

/// How far the particles' mean pressure swings, Pa: the sound in the tank.
double swing(Tank& tank, double duration) {
  double least = 1e30, most = -1e30, step = 0;
  for (double time = 0; time < duration; time += step) {
    step = tank.solver->advance().time_step;
    const double mean = total(tank.solver->download().pressure) / static_cast<double>(tank.solver->particle_count());
    least = std::min(least, mean);
    most = std::max(most, mean);
  }
  return most - least;
}

class Settling : public ::testing::TestWithParam<WallElements> {
 protected:
  static Case basin() {
    Case scene = box_case(Vector3d(0.4, 0, 0.3), 0.2, 0.01);
    scene.numerics.walls.elements = GetParam();
    return scene;
  }
};

// An unsettled tank swings by a few per cent of its mean pressure. The sound itself dies by e^(−6π); what is left comes from the particles'
// slower rearrangement.
TEST_P(Settling, QuietensATankAtRest) {
  Tank loud(basin()), quiet(basin());
  loud.pack_and_start(packing_iterations);
  quiet.solver->pack(packing_iterations, {});
  double last_fraction = 0;
  const StepReport report = quiet.solver->settle(periods, [&](double fraction) { last_fraction = fraction; });
  EXPECT_TRUE(report.valid());
  EXPECT_EQ(last_fraction, 1.0);
  EXPECT_EQ(quiet.solver->energies().kinetic, 0.0);
  const double period = 4 * 0.2 / loud.discretisation.sound_speed;
  const double before = swing(loud, 2 * period), after = swing(quiet, 2 * period);
  std::printf("the mean pressure swings by %.2f Pa without settling, by %.2f Pa after it\n", before, after);
  EXPECT_LT(after, 0.4 * before);
}

// A column that is free on one side and on top: held at the side, free on top, so that it starts as the case says.
TEST_P(Settling, HoldsAColumn) {
  Case scene = basin();
  scene.fluid.fill = {Box{Vector3d::Zero(), Vector3d(0.2, 0, 0.2)}};
  Tank tank(scene);
  tank.solver->pack(packing_iterations, {});
  EXPECT_TRUE(tank.solver->settle(periods, {}).valid());
  const FluidState held = tank.solver->download();
  double right = 0, top = 0;
  for (std::size_t i = 0; i < held.id.size(); ++i) {
    right = std::max(right, held.position[i].x());
    top = std::max(top, held.position[i].z());
    EXPECT_EQ(held.velocity[i].norm(), 0.0);
  }
  EXPECT_LT(right, 0.2) << "behind the lid";
  // the uppermost row lies half a spacing, 0.005 m, inside; weakly compressible water sinks by ρ g H² / 2 ρ c₀² = H/400
  EXPECT_NEAR(top, 0.195, 0.002);
  const double start = tank.solver->energies().potential;
  for (int step = 0; step < 200; ++step) tank.solver->advance();
  const FluidState free = tank.solver->download();
  double front = 0;
  for (const Eigen::Vector3d& position : free.position) front = std::max(front, position.x());
  EXPECT_GT(front, right + 0.01) << "the lid stayed";
  EXPECT_LT(tank.solver->energies().potential, start);
}

std::string name_of(const ::testing::TestParamInfo<WallElements>& info) {
  return info.param == WallElements::numerical ? "Numerical" : info.param == WallElements::facet ? "Facet" : "SemiAnalytical";
}

INSTANTIATE_TEST_SUITE_P(Elements, Settling, ::testing::Values(WallElements::numerical, WallElements::semi_analytical, WallElements::facet),
                         name_of);

TEST(SettlingWithGhosts, NeedsWallsAllRound) {
  Case scene = box_case(Vector3d(0.4, 0, 0.3), 0.2, 0.02);
  scene.numerics.walls.method = WallMethod::ghost;
  Tank whole(scene);
  EXPECT_TRUE(whole.solver->settle(periods, {}).valid());
  scene.fluid.fill = {Box{Vector3d::Zero(), Vector3d(0.2, 0, 0.2)}};
  Tank column(scene);
  EXPECT_NE(error_of([&] { column.solver->settle(periods, {}); }).find("numerics/packing/settling needs the tank's walls on all sides"),
            std::string::npos);
}

TEST(SettlingWithoutGravity, DoesNothing) {
  Case scene = box_case(Vector3d(0.4, 0, 0.3), 0.2, 0.02);
  scene.gravity = Vector3d::Zero();
  scene.fluid.sound_speed = 10;
  Tank tank(scene);
  tank.solver->settle(periods, [](double) { ADD_FAILURE() << "a step was made"; });
}

}  // namespace
}  // namespace wavetank::settling_test

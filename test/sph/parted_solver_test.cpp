// Water in parts on several devices has the bits of water in one part, whatever the cuts.
#include "wavetank/sph/parted_solver.h"

#include "../common/error_of.h"
#include "sph_fixture.h"

namespace wavetank::parted_solver_test {
namespace {

/// Water that runs out along a tank, over a step.
Case running_out(int dimensions) {
  const double across = dimensions == 3 ? 0.36 : 0;
  Case scene = box_case(Vector3d(1.2, across, 0.8), 0.4, dimensions == 3 ? 0.04 : 0.02);
  scene.dimensions = dimensions;
  scene.fluid.fill = {Box{Vector3d::Zero(), Vector3d(0.5, across, 0.4)}};
  scene.numerics.artificial_viscosity = 0.05;
  return scene;
}

struct PartedTank {
  PartedTank(const Case& checked, int parts, const PartedSolverOptions& options = {})
      : layout(lay_out(checked)), scene(settled(checked, layout)), discretisation(discretise(scene, layout)) {
    for (int k = 0; k < parts; ++k) devices.emplace_back(test_device().info());
    const std::vector<Vector3d> centres(1 + scene.bodies.size(), Vector3d::Zero());
    solver = make_parted_solver(devices, scene, layout, discretisation, centres, options);
    solver->pack(10, {});
    solver->start();
  }
  /// False when a step is in violation.
  bool run(int steps) {
    for (int k = 0; k < steps; ++k)
      if (!solver->advance().valid()) return false;
    return true;
  }

  Layout layout;
  Case scene;
  Discretisation discretisation;
  std::vector<compute::Device> devices;
  std::unique_ptr<Solver> solver;
};

std::vector<char> state_after(const Case& scene, int parts, int steps, const PartedSolverOptions& options = {}) {
  PartedTank tank(scene, parts, options);
  EXPECT_TRUE(tank.run(steps));
  return tank.solver->save();
}

PartedSolverOptions spoiled() {
  PartedSolverOptions options;
  options.spoils = true;
  return options;
}

/// After so many steps in one part and in others, whose halos are no numbers until they are sent.
void expect_same_bits(const Case& scene, int steps, const std::vector<int>& parts = {2, 3}) {
  const std::vector<char> one = state_after(scene, 1, steps);
  for (const int count : parts) EXPECT_TRUE(state_after(scene, count, steps, spoiled()) == one) << count << " parts";
}

TEST(PartedSolver, HasTheSameBitsForAnyNumberOfParts) { expect_same_bits(running_out(2), 200); }

/// Longest along y, across which rows are cut.
TEST(PartedSolver, AlsoIn3D) {
  Case scene = running_out(3);
  scene.fluid.fill = {Box{Vector3d::Zero(), Vector3d(0.36, 0.5, 0.4)}};
  scene.tank.shape = BoxTank{Vector3d(0.36, 1.2, 0.8), Vector3d::Zero(), false};
  expect_same_bits(scene, 30, {3});
}

/// A thin plate in the water's way, a belt, and water that is damped.
TEST(PartedSolver, AlsoWithBodies) {
  Case scene = running_out(2);
  scene.fluid.spacing = 0.04;
  scene.bodies.resize(2);
  scene.bodies[0].name = "plate";
  scene.bodies[0].shape = Box{Vector3d(0.7, 0, 0), Vector3d(0.72, 0, 0.2)};
  scene.bodies[1].name = "belt";
  scene.bodies[1].shape = Box{Vector3d(0.9, 0, 0.1), Vector3d(1.1, 0, 0.2)};
  scene.bodies[1].surface_velocity = Vector3d(0.5, 0, 0);
  DampingCase damping;
  damping.box = Box{Vector3d(0, 0, 0), Vector3d(0.6, 0, 0.8)};
  damping.strength = 10;
  scene.fluid.damping = {damping};
  expect_same_bits(scene, 150, {2});
}

/// What sweeps ask of each other's results is exchanged, whatever the case has chosen.
TEST(PartedSolver, AlsoByOtherMethods) {
  Case scene = running_out(2);
  scene.fluid.spacing = 0.04;
  scene.numerics.integrator = Integrator::runge_kutta_4;
  scene.numerics.density_diffusion = DensityDiffusion::antuono;
  scene.numerics.shifting = Shifting::sun;
  expect_same_bits(scene, 60, {2});
}

TEST(PartedSolver, AlsoByRiemannProblemsInDoublePrecision) {
  Case scene = running_out(2);
  scene.fluid.spacing = 0.04;
  scene.numerics.integrator = Integrator::predictor_corrector;
  scene.numerics.scheme = Scheme::riemann_parshikov;
  if (has_precision(Precision::double_)) scene.numerics.precision = Precision::double_;
  expect_same_bits(scene, 60, {2});
}

TEST(PartedSolver, CutsDoNotMatter) {
  Case scene = running_out(2);
  scene.fluid.spacing = 0.04;
  const std::vector<char> one = state_after(scene, 1, 100);
  PartedSolverOptions options = spoiled();
  options.cut_every = 5;
  EXPECT_TRUE(state_after(scene, 2, 100, options) == one);
  options.uneven = 1;
  EXPECT_TRUE(state_after(scene, 2, 100, options) == one);
}

TEST(PartedSolver, AHaloOneSlotTooNarrowHasOtherBits) {
  const Case scene = running_out(2);
  PartedSolverOptions narrow;
  narrow.halo_less = 1;
  EXPECT_FALSE(state_after(scene, 2, 50, narrow) == state_after(scene, 2, 50));
}

TEST(PartedSolver, OnlyLastBitsDifferFromOneDevice) {
  const Case scene = running_out(2);
  PartedTank parted(scene, 2);
  Tank one(scene);
  one.pack_and_start(10);
  ASSERT_TRUE(parted.run(20));
  for (int k = 0; k < 20; ++k) one.solver->advance();
  const FluidState a = parted.solver->download(), b = one.solver->download();
  std::map<std::uint32_t, Vector3d> places;
  for (std::size_t i = 0; i < b.id.size(); ++i) places[b.id[i]] = b.position[i];
  ASSERT_EQ(a.id.size(), b.id.size());
  for (std::size_t i = 0; i < a.id.size(); ++i) EXPECT_LT((a.position[i] - places[a.id[i]]).norm(), 1e-5 * scene.fluid.spacing.value());
}

TEST(PartedSolver, StopsInTheSameStepWithTheSameReport) {
  Case scene = running_out(2);
  scene.fluid.spacing = 0.04;
  scene.fluid.sound_speed = 4.0;  // of which the water soon has half
  const auto stop = [&](int parts) {
    PartedTank tank(scene, parts);
    int steps = 0;
    StepReport report = tank.solver->advance();
    for (; report.valid() && steps < 2000; ++steps) report = tank.solver->advance();
    EXPECT_FALSE(report.valid());
    return std::make_tuple(steps, report.offender_id, report.too_fast, report.offender_velocity.x(), report.time_step, report.guard_hits);
  };
  EXPECT_EQ(stop(1), stop(2));
}

TEST(PartedSolver, RefusesWhatPartsCannotDoYet) {
  const auto refusal = [](const Case& scene) { return error_of([&] { PartedTank(scene, 2); }); };
  Case scene = running_out(2);
  scene.numerics.walls.method = WallMethod::ghost;
  EXPECT_NE(refusal(scene).find("numerics/walls/method is ghost, which several devices cannot do together yet"), std::string::npos);
  scene = running_out(2);
  scene.tank.motion = Motion::free;
  EXPECT_NE(refusal(scene).find("but the tank moves, which"), std::string::npos);
  scene = running_out(2);
  EXPECT_NE(error_of([&] { PartedTank(scene, 30); }).find("choose fewer devices"), std::string::npos);
}

}  // namespace
}  // namespace wavetank::parted_solver_test

// Whatever the device's class makes the neighbour loop take at a time, the sums are the same.
#include "../../src/sph/tiling.h"

#include <algorithm>
#include <random>

#include "sph_fixture.h"

namespace wavetank::tiling_test {
namespace {

constexpr unsigned seed = 2024;

/// A device of another class than it is.
compute::Device disguised(unsigned vector_width, bool is_gpu) {
  compute::DeviceInfo info = test_device().info();
  info.vector_width = vector_width;
  info.is_gpu = is_gpu;
  return compute::Device(info);
}

/// What a few steps of disordered water beside a box give, with spray far above it in no order.
struct Outcome {
  PairCount pairs;
  std::vector<Vector3d> positions, velocities;  // by particle id
  std::vector<double> pressures;
  std::vector<PointValue> points;
  std::vector<WallWrench> wrenches;
};

Case column(int dimensions, Precision precision, bool periodic) {
  const double across = dimensions == 3 ? 0.4 : 0.0;
  Case scene;
  scene.dimensions = dimensions;
  scene.fluid.spacing = dimensions == 3 ? 0.04 : 0.02;
  scene.fluid.fill = {Box{Vector3d::Zero(), Vector3d(periodic ? 0.8 : 0.4, across, 0.32)}};
  scene.tank.shape = BoxTank{Vector3d(0.8, across, 0.5), Vector3d::Zero(), false};
  scene.tank.periodic = {periodic, false, false};
  scene.bodies.push_back({"box", Box{Vector3d(0.48, 0.12, 0.0), Vector3d(0.6, 0.28, 0.12)}, Motion::fixed});
  if (periodic) scene.bodies.clear();
  scene.numerics.precision = precision;
  scene.numerics.support = 3.3;
  return scene;
}

Layout with_spray(Layout layout, int dimensions) {
  std::mt19937 random(seed);
  const auto between = [&random](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  for (Vector3d& particle : layout.particles)
    for (int axis = 0; axis < 3; ++axis)
      if (axis != 1 || dimensions == 3) particle[axis] += between(-0.15, 0.15) * layout.spacing;
  for (int k = 0; k < 60; ++k) {
    layout.particles.emplace_back(between(0.02, 0.78), dimensions == 3 ? between(0.02, 0.38) : 0.0, between(0.33, 1.2));
    layout.volumes.push_back(layout.volumes.front());
    layout.levels.push_back(0.32);
  }
  return layout;
}

Outcome outcome(const compute::Device& device, const Case& checked) {
  const Layout layout = with_spray(lay_out(checked), checked.dimensions);
  const Case scene = settled(checked, layout);
  const auto solver = make_solver(device, scene, layout, discretise(scene, layout), {1 + scene.bodies.size(), Vector3d::Zero()});
  EXPECT_TRUE(solver->start().valid());
  Outcome result;
  result.pairs = solver->count_pairs();
  for (int step = 0; step < 3; ++step) EXPECT_TRUE(solver->advance().valid());
  const FluidState fluid = solver->download();
  result.positions.resize(fluid.id.size());
  result.velocities.resize(fluid.id.size());
  result.pressures.resize(fluid.id.size());
  for (std::size_t i = 0; i < fluid.id.size(); ++i) {
    result.positions[fluid.id[i]] = fluid.position[i];
    result.velocities[fluid.id[i]] = fluid.velocity[i];
    result.pressures[fluid.id[i]] = fluid.pressure[i];
  }
  result.points = solver->evaluate(*solver->make_points({Vector3d(0.1, 0.1, 0.1), Vector3d(0.0, 0.2, 0.2), Vector3d(0.7, 0.1, 0.4)}));
  result.wrenches = solver->wrenches();
  return result;
}

/// Within what the order of the sums may change: `rounding` of the scale of each, which is that of the water's depth.
void expect_same(const Outcome& one, const Outcome& other, double rounding) {
  const double pressure = 1000 * 9.81 * 0.32, speed = std::sqrt(9.81 * 0.32);
  EXPECT_EQ(one.pairs.pairs, other.pairs.pairs);
  double place_error = 0, speed_error = 0, pressure_error = 0;
  for (std::size_t i = 0; i < one.positions.size(); ++i) {
    place_error = std::max(place_error, (one.positions[i] - other.positions[i]).norm());
    speed_error = std::max(speed_error, (one.velocities[i] - other.velocities[i]).norm());
    pressure_error = std::max(pressure_error, std::abs(one.pressures[i] - other.pressures[i]));
  }
  EXPECT_LT(place_error, rounding * 0.32);
  EXPECT_LT(speed_error, 10 * rounding * speed);
  EXPECT_LT(pressure_error, 1000 * rounding * pressure);  // ρ c² is 200 times the water's pressure
  for (std::size_t k = 0; k < one.points.size(); ++k) {
    EXPECT_NEAR(one.points[k].pressure, other.points[k].pressure, 1000 * rounding * pressure);
    EXPECT_NEAR(one.points[k].filling, other.points[k].filling, 10 * rounding);
    EXPECT_NEAR(one.points[k].shepard, other.points[k].shepard, 10 * rounding);
  }
  for (std::size_t o = 0; o < one.wrenches.size(); ++o)
    for (int part = 0; part < 4; ++part)
      EXPECT_LT((one.wrenches[o][part] - other.wrenches[o][part]).norm(), 1000 * rounding * pressure) << "owner " << o << ", part " << part;
}

void compare(const Case& scene, const std::vector<unsigned>& widths, double rounding) {
  if (!has_precision(scene.numerics.precision)) GTEST_SKIP() << "the device has no double precision";
  const Outcome scalar = outcome(disguised(1, false), scene);
  for (const unsigned width : widths) {
    SCOPED_TRACE(std::to_string(width) + " lanes");
    expect_same(scalar, outcome(disguised(width, false), scene), rounding);
  }
}

// Each width at least once: a driver's compiler takes ten seconds for the kernels of each.
TEST(Tiling, DoesNotChangeTheSumsIn2D) { compare(column(2, Precision::single, false), {4}, 2e-6); }
TEST(Tiling, DoesNotChangeTheSumsIn3D) { compare(column(3, Precision::single, false), {8}, 2e-6); }
TEST(Tiling, DoesNotChangeTheSumsInAPeriodicTank) { compare(column(2, Precision::single, true), {16}, 2e-6); }
TEST(Tiling, DoesNotChangeTheSumsInDoublePrecision) { compare(column(2, Precision::double_, false), {16}, 1e-13); }

// Whose sweeps go by a list of blocks that have a pair where tiles are wide; and what shifting laws ask of the surface.
TEST(Tiling, DoesNotChangeTheSumsOfARiemannScheme) {
  for (const bool periodic : {false, true}) {
    SCOPED_TRACE(periodic ? "periodic" : "");
    Case scene = column(2, Precision::single, periodic);
    scene.bodies.clear();  // with thin walls there is no list
    scene.numerics.scheme = Scheme::riemann_parshikov;
    scene.numerics.shifting = Shifting::michel;
    compare(scene, {16}, 2e-6);
  }
}

// Whose gradients are those of the middle of a step alone: a list that is of that state would be wrong at its end.
TEST(Tiling, DoesNotChangeTheSumsWithEddies) {
  Case scene = column(2, Precision::single, false);
  scene.bodies.clear();
  scene.numerics.turbulence = Turbulence::smagorinsky;
  scene.fluid.initial.w = "3 * sin(40 * x)";  // so that rows get and lose particles within a step
  compare(scene, {16}, 2e-6);
}

/// With a plate thinner than the support in the water, two of its edges free.
Case column_about_plate(int dimensions) {
  Case scene = column(dimensions, Precision::single, false);
  scene.bodies[0] = {"plate", Box{Vector3d(0.19, 0.12, 0.1), Vector3d(dimensions == 3 ? 0.23 : 0.21, 0.28, 0.4)}, Motion::fixed};
  return scene;
}

TEST(Tiling, DoesNotChangeWhatIsSeenPastAThinPlateIn2D) { compare(column_about_plate(2), {16}, 2e-6); }
TEST(Tiling, DoesNotChangeWhatIsSeenPastAThinPlateIn3D) { compare(column_about_plate(3), {16}, 2e-6); }

/// A sheet three particles thick along a wall: rows of slots end within a tile's width.
Case sheet_of_least_squares(int dimensions, Gradients gradients) {
  Case scene = column(dimensions, Precision::single, false);
  scene.bodies.clear();
  scene.fluid.fill = {Box{Vector3d::Zero(), Vector3d(3 * *scene.fluid.spacing, dimensions == 3 ? 0.4 : 0.0, 0.32)}};
  scene.numerics.support = 4;
  scene.numerics.gradients = gradients;
  scene.numerics.artificial_viscosity = 0.1;
  return scene;
}

TEST(Tiling, DoesNotChangeTheFitsOfASheetAtAWallIn2D) { compare(sheet_of_least_squares(2, Gradients::mls_corrected), {16}, 1e-5); }
TEST(Tiling, DoesNotChangeTheFitsOfASheetAtAWallIn3D) { compare(sheet_of_least_squares(3, Gradients::mls_corrected), {16}, 1e-5); }
TEST(Tiling, DoesNotChangeDerivativesByTheFit) { compare(sheet_of_least_squares(2, Gradients::mls), {16}, 1e-5); }

TEST(Tiling, DoesNotChangeTheSumsAsOnAGpu) {
  const Case scene = column(3, Precision::single, false);
  expect_same(outcome(disguised(1, false), scene), outcome(disguised(1, true), scene), 2e-6);
}

TEST(Tiling, GoesByTheDevicesClass) {
  compute::DeviceInfo device;
  device.vector_width = 16;
  EXPECT_EQ(tiling_for(device, Precision::single, false).particles.own, 4);
  EXPECT_EQ(tiling_for(device, Precision::double_, false).particles.own, 2);
  EXPECT_EQ(tiling_for(device, Precision::single, true).particles.near, 1);
  device.is_gpu = true;
  EXPECT_EQ(tiling_for(device, Precision::single, false).particles.near, 1);
}

}  // namespace
}  // namespace wavetank::tiling_test

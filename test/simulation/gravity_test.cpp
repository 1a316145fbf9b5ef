// Gravity along any axis, and between them: water starts at rest, and levels, gauges, energies and an open tank's top follow it.
#include <Eigen/Geometry>

#include "simulation_fixture.h"
#include "wavetank/scene/case_reader.h"

namespace wavetank::gravity_test {
namespace {

constexpr double depth = 0.4, density = 1000, strength = 9.81;
constexpr double bottom_pressure = density * strength * depth;

struct Along {
  const char* name;
  int dimensions;
  int axis;   ///< of gravity
  int way;    ///< of the tank's top along it
  bool open;  ///< the tank
};

std::string name_of(const ::testing::TestParamInfo<Along>& info) { return info.param.name; }

class GravityAlong : public ::testing::TestWithParam<Along> {
 protected:
  /// Still water in a box whose side along gravity is 1 m and whose others are 0.5 m, with a probe and a gauge at the bottom.
  static Case still_water(double spacing) {
    const Along& along = GetParam();
    Vector3d size = Vector3d::Constant(0.5), middle = 0.5 * size;
    size[along.axis] = 1;
    Box water{Vector3d::Zero(), size};
    middle[along.axis] = along.way > 0 ? 0 : 1;
    (along.way > 0 ? water.max : water.min)[along.axis] = along.way > 0 ? depth : 1 - depth;
    if (along.dimensions == 2) size.y() = water.max.y() = middle.y() = 0;
    Case scene = box_case(size, 0.4, spacing);
    std::get<BoxTank>(scene.tank.shape).closed = !along.open;
    scene.fluid.fill = {water};
    scene.gravity = -strength * along.way * Vector3d::Unit(along.axis);
    scene.instruments.rate = 200;
    scene.instruments.pressure_probes = {{"bottom", middle}};
    scene.instruments.wave_gauges = {{"level", middle}};
    return scene;
  }
};

INSTANTIATE_TEST_SUITE_P(Directions, GravityAlong,
                         ::testing::Values(Along{"DownY", 3, 1, 1, false}, Along{"DownX", 3, 0, 1, false}, Along{"UpZ", 3, 2, -1, false},
                                           Along{"UpYOpen", 3, 1, -1, true}, Along{"DownX2D", 2, 0, 1, false},
                                           Along{"UpX2DOpen", 2, 0, -1, true}, Along{"UpZ2D", 2, 2, -1, false},
                                           Along{"DownZ", 3, 2, 1, true}),
                         name_of);

TEST_P(GravityAlong, WaterStartsAtRest) {
  const Along& along = GetParam();
  Simulation simulation(still_water(0.05));
  const double surface = along.way > 0 ? depth : 1 - depth;
  const Samples samples = run_to(simulation, 0.2);
  for (const PressureSample& sample : samples.pressures)
    EXPECT_NEAR(sample.pressures[0], bottom_pressure, 0.05 * bottom_pressure) << sample.time;
  for (const LevelSample& sample : samples.levels) EXPECT_NEAR(sample.levels[0], surface, 0.015) << sample.time;
  const EnergySample& last = samples.energies.back();
  const double potential = last.mass * strength * 0.5 * depth;
  EXPECT_NEAR(last.potential, potential, 0.02 * potential);
  EXPECT_LT(last.kinetic, 1e-3 * potential);
}

// The same water by a seed and a level: the same particles, the same pressure.
TEST_P(GravityAlong, ALevelIsACoordinateAlongIt) {
  const Along& along = GetParam();
  Case scene = still_water(0.05);
  const Layout by_box = lay_out(scene);
  Vector3d seed = scene.instruments.pressure_probes[0].position;
  seed[along.axis] += 0.1 * along.way;
  scene.fluid.fill = {FloodFill{seed, along.way > 0 ? depth : 1 - depth}};
  const Layout by_seed = lay_out(scene);
  ASSERT_EQ(by_seed.particles.size(), by_box.particles.size());
  for (std::size_t i = 0; i < by_box.particles.size(); ++i) {
    EXPECT_LT((by_seed.particles[i] - by_box.particles[i]).norm(), 1e-9);
    EXPECT_NEAR(by_seed.levels[i], by_box.levels[i], 1e-12);
  }
}

// A settled start, for which the lid must not hold the water down.
TEST_P(GravityAlong, WaterSettles) {
  Case scene = still_water(0.05);
  scene.numerics.packing.settling = 2;
  Simulation simulation(scene);
  for (const PressureSample& sample : run_to(simulation, 0.05).pressures)
    EXPECT_NEAR(sample.pressures[0], bottom_pressure, 0.03 * bottom_pressure) << sample.time;
}

Vector3d tilted(double degrees) {
  const double angle = degrees * M_PI / 180;
  return strength * Vector3d(std::sin(angle), 0, -std::cos(angle));
}

// A closed tank full of water has no free surface that gravity could tilt.
TEST(ObliqueGravity, AFullTankStartsAtRest) {
  for (const int dimensions : {2, 3}) {
    Case scene = box_case(Vector3d(0.8, dimensions == 2 ? 0 : 0.4, 0.4), 0.4, 0.04);
    std::get<BoxTank>(scene.tank.shape).closed = true;
    scene.gravity = tilted(30);
    const double y = dimensions == 2 ? 0 : 0.2;
    const std::vector<Vector3d> places = {{0.4, y, 0}, {0.8, y, 0.2}, {0, y, 0.2}};
    for (const Vector3d& place : places)
      scene.instruments.pressure_probes.push_back({"p" + std::to_string(scene.instruments.pressure_probes.size()), place});
    scene.instruments.rate = 200;
    Simulation simulation(scene);
    const double deepest = density * scene.gravity.dot(Vector3d(0.8, 0, -0.4));
    for (const PressureSample& sample : run_to(simulation, 0.1).pressures)
      for (std::size_t k = 0; k < places.size(); ++k)
        EXPECT_NEAR(sample.pressures[k], density * scene.gravity.dot(places[k] - Vector3d(0, y, 0.4)), 0.05 * deepest)
            << dimensions << "-D, probe " << k << " at " << sample.time << " s";
  }
}

// From a seed the free surface is at right angles to gravity, and the level is where it lies over the seed.
TEST(ObliqueGravity, ALevelSurfaceStartsAtRest) {
  Case scene = box_case(Vector3d(0.8, 0, 0.8), 0.4, 0.02);
  scene.gravity = tilted(30);
  scene.fluid.fill = {FloodFill{Vector3d(0.4, 0, 0.1), 0.4}};
  const std::vector<Vector3d> places = {{0.4, 0, 0}, {0.8, 0, 0.3}, {0.1, 0, 0}};
  for (const Vector3d& place : places)
    scene.instruments.pressure_probes.push_back({"p" + std::to_string(scene.instruments.pressure_probes.size()), place});
  scene.instruments.rate = 200;
  Simulation simulation(scene);
  const double deepest = density * scene.gravity.dot(Vector3d(0.4, 0, -0.4));
  const Samples samples = run_to(simulation, 0.3);
  for (const PressureSample& sample : samples.pressures)
    for (std::size_t k = 0; k < places.size(); ++k)
      EXPECT_NEAR(sample.pressures[k], density * scene.gravity.dot(places[k] - Vector3d(0.4, 0, 0.4)), 0.05 * deepest)
          << "probe " << k << " at " << sample.time << " s";
  EXPECT_LT(samples.energies.back().kinetic, 2e-3 * samples.energies.front().potential);
}

// Gauges are given by the coordinates across gravity, or by a point.
TEST(GaugePosition, FollowsGravity) {
  const auto read = [](const std::string& gravity, const std::string& position) {
    const Case read = read_case_text(
        "{duration: 1, gravity: " + gravity +
            ", fluid: {spacing: 0.1, fill: [{box: {min: [0, 0, 0], max: [1, 1, 1]}}]}, tank: {box: {size: [2, 3, 4], closed: true}}, "
            "instruments: {wave_gauges: [{name: g, position: " +
            position + "}]}}",
        "case.yaml");
    return Vector3d(read_case_text(write_case(read), "written").instruments.wave_gauges[0].position);
  };
  EXPECT_EQ(read("[0, 0, -9.81]", "[0.5, 0.25]"), Vector3d(0.5, 0.25, 0));
  EXPECT_EQ(read("[0, 0, 9.81]", "[0.5, 0.25, 7]"), Vector3d(0.5, 0.25, 0));
  EXPECT_EQ(read("[0, -9.81, 0]", "[0.5, 0.25]"), Vector3d(0.5, 0, 0.25));
  EXPECT_EQ(read("[0, -9.81, 1]", "[0.5, 7, 0.25]"), Vector3d(0.5, 0, 0.25));
  EXPECT_EQ(read("[9.81, 0, 0]", "[0.5, 0.25]"), Vector3d(0, 0.5, 0.25));
  EXPECT_EQ(read("[9.81, 0, 0]", "[0.5, 0]"), Vector3d(0, 0.5, 0));
}

}  // namespace
}  // namespace wavetank::gravity_test

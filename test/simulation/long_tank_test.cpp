// Water 20 000 spacings from its tank's corner behaves as water beside it, whichever axis the tank is long along.
#include <algorithm>
#include <cstdlib>
#include <map>

#include "simulation_fixture.h"

namespace wavetank::long_tank_test {
namespace {

constexpr double spacing = 0.01, density = 1000, gravity = 9.81;
constexpr double near_by = 25 * spacing, far_away = 20000 * spacing;  // from the tank's corner to the water

/// Still water between two bodies that stand in a tank along one axis.
struct Pool {
  int dimensions = 2;
  int along = 0, up = 2;
  double depth = 0, width = 0;

  Box box(double from, double to, double height) const {
    Box result{Vector3d::Zero(), Vector3d::Zero()};
    if (dimensions == 3) result.max.setConstant(width);
    result.min[along] = from;
    result.max[along] = to;
    result.min[up] = 0;
    result.max[up] = height;
    return result;
  }
  Case at(double place) const {
    const double height = 1.5 * depth, side = 20 * spacing, length = place + width + side + 5 * spacing;
    Case scene = box_case(box(0, length, height).max, depth, spacing);
    scene.dimensions = dimensions;
    scene.gravity = Vector3d::Zero();
    scene.gravity[up] = -gravity;
    scene.fluid.density = density;
    scene.fluid.sound_speed = 20 * std::sqrt(gravity * depth);
    scene.fluid.fill = {box(place, place + width, depth)};
    scene.bodies.push_back({"before", box(place - side, place, height), Motion::fixed});
    scene.bodies.push_back({"beyond", box(place + width, place + width + side, height), Motion::fixed});
    scene.numerics.artificial_viscosity = 0.02;
    scene.numerics.packing.iterations = 50;
    return scene;
  }
};

struct Rest {
  std::map<std::uint32_t, double> pressures;  ///< by particle, of ρ g H
  double error = 0;                           ///< L2, from hydrostatics
  double speed = 0;                           ///< the greatest, of √(g H)
};

Rest rest_of(const Pool& pool, double place) {
  Simulation simulation(pool.at(place));
  run_to(simulation, std::sqrt(pool.depth / gravity));
  const ParticleCloud cloud = simulation.particles();
  Rest rest;
  for (std::size_t i = 0; i < cloud.id.size(); ++i) {
    const double pressure = cloud.pressure[i] / (density * gravity * pool.depth);
    rest.pressures[cloud.id[i]] = pressure;
    rest.error += std::pow(pressure - (1 - cloud.position[i][pool.up] / pool.depth), 2);
    rest.speed = std::max(rest.speed, cloud.velocity[i].norm() / std::sqrt(gravity * pool.depth));
  }
  rest.error = std::sqrt(rest.error / static_cast<double>(cloud.id.size()));
  return rest;
}

void is_as_still_far_away(const Pool& pool) {
  const Rest here = rest_of(pool, near_by), there = rest_of(pool, far_away);
  ASSERT_EQ(here.pressures.size(), there.pressures.size());
  ASSERT_GT(here.pressures.size(), 300u);
  double difference = 0;
  for (const auto& [id, pressure] : here.pressures) difference += std::pow(there.pressures.at(id) - pressure, 2);
  difference = std::sqrt(difference / static_cast<double>(here.pressures.size()));
  std::printf("%zu particles: L2 error of the pressure %.5f rho g H here, %.5f there; they differ by %.1e; greatest speed %.5f and %.5f\n",
              here.pressures.size(), here.error, there.error, difference, here.speed, there.speed);
  EXPECT_LT(here.error, 0.03);
  EXPECT_NEAR(there.error, here.error, 0.01 * here.error);
  EXPECT_LT(difference, 1e-4);
  EXPECT_NEAR(there.speed, here.speed, 0.03 * here.speed);
}

TEST(LongTank, IsAsStillFarAlongX) { is_as_still_far_away({2, 0, 2, 20 * spacing, 30 * spacing}); }

TEST(LongTank, IsAsStillFarAlongY) {
  if (std::getenv("WAVETANK_LONG_TESTS") == nullptr) GTEST_SKIP() << "its kernels take long to compile: set WAVETANK_LONG_TESTS=1";
  is_as_still_far_away({3, 1, 2, 8 * spacing, 8 * spacing});
}

TEST(LongTank, IsAsStillFarAlongZ) { is_as_still_far_away({2, 2, 0, 20 * spacing, 30 * spacing}); }

}  // namespace
}  // namespace wavetank::long_tank_test

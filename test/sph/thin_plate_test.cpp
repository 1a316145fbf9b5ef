// Plates much thinner than the kernel's support with water on both sides: neither side may feel the other.
#include <algorithm>

#include "sph_fixture.h"

namespace wavetank::thin_plate_test {
namespace {

constexpr double spacing = 0.02, gravity = 9.81, density = 1000;

struct Kind {
  const char* name;
  WallElements elements;
};
constexpr Kind every_kind[] = {
    {"numerical", WallElements::numerical}, {"semi_analytical", WallElements::semi_analytical}, {"facet", WallElements::facet}};

/// A tank with a plate across it at x = 0.4 to 0.4 + `thickness`, filled to a depth on either side.
Case parted_tank(int dimensions, double thickness, double left, double right, double gap) {
  const double width = dimensions == 3 ? 0.2 : 0.0;
  Case scene = box_case(Vector3d(0.8, width, 0.4), left, dimensions == 3 ? 0.025 : spacing);
  scene.fluid.density = density;
  const bool one_depth = left == right;
  scene.fluid.fill = {Box{Vector3d::Zero(), Vector3d(one_depth ? 0.8 : 0.4, width, left)}};
  if (right > 0 && !one_depth) scene.fluid.fill.push_back(Box{Vector3d(0.4 + thickness, 0, 0), Vector3d(0.8, width, right)});
  scene.bodies.push_back({"plate", Box{Vector3d(0.4, 0, gap), Vector3d(0.4 + thickness, width, 0.36)}, Motion::fixed});
  return scene;
}

/// Root mean square of the pressure's difference from hydrostatics in the part of the tank between two x, over ρ g depth.
double pressure_error(const FluidState& fluid, double from, double to, double depth) {
  double sum = 0, members = 0;
  for (std::size_t i = 0; i < fluid.id.size(); ++i) {
    if (fluid.position[i].x() < from || fluid.position[i].x() > to) continue;
    sum += std::pow(fluid.pressure[i] - density * gravity * (depth - fluid.position[i].z()), 2);
    ++members;
  }
  return std::sqrt(sum / std::max(members, 1.0)) / (density * gravity * depth);
}

std::size_t members(const FluidState& fluid, double from, double to) {
  return static_cast<std::size_t>(
      std::count_if(fluid.position.begin(), fluid.position.end(), [&](const Vector3d& p) { return p.x() >= from && p.x() <= to; }));
}

double greatest_speed(const FluidState& fluid) {
  double fastest = 0;
  for (const Vector3d& velocity : fluid.velocity) fastest = std::max(fastest, velocity.norm());
  return fastest;
}

void rest(Tank& tank, double duration, int packing) {
  tank.pack_and_start(packing);
  double time = 0, step = tank.discretisation.acoustic_time;
  while (time < duration) {
    const StepReport report = tank.solver->advance();
    if (report.offender >= 0) throw Error("a particle is lost at t = " + std::to_string(time) + " s.");
    time += step;
    step = report.time_step;
  }
}

TEST(ThinPlate, PartsWaterOfTwoDepths) {
  for (const int dimensions : {2, 3})
    for (const auto& [name, elements] : every_kind) {
      const double left = 0.3, right = dimensions == 3 ? 0.15 : 0.16, thickness = 0.004;
      Case scene = parted_tank(dimensions, thickness, left, right, 0);
      scene.numerics.walls.elements = elements;
      Tank tank(scene);
      const FluidState before = tank.solver->download();
      const std::size_t on_left = members(before, 0, 0.4), on_right = before.id.size() - on_left;
      rest(tank, dimensions == 2 ? 0.5 : 0.25, dimensions == 2 ? 200 : 100);
      const FluidState fluid = tank.solver->download();
      const double error_left = pressure_error(fluid, 0, 0.4, left), error_right = pressure_error(fluid, 0.4, 0.8, right);
      double force = 0;
      constexpr int samples = 40;  // over some periods of the tank's own sound
      for (int k = 0; k < samples; ++k) {
        for (int step = 0; step < 5; ++step) tank.solver->advance();
        force += tank.solver->wrenches()[1][0].x() / samples;
      }
      const double exact = 0.5 * density * gravity * (left * left - right * right) * (dimensions == 3 ? 0.2 : 1.0);
      std::printf(
          "%d-D, %-16s pressure error %.4f and %.4f of rho g depth, force on the plate %.1f N (%+.1f %%), greatest speed %.4f m/s\n",
          dimensions, name, error_left, error_right, force, 100 * (force / exact - 1), greatest_speed(fluid));
      EXPECT_EQ(members(fluid, 0, 0.4), on_left) << name;
      EXPECT_EQ(members(fluid, 0.4 + thickness, 0.8), on_right) << name;
      EXPECT_LT(error_left, 0.02) << name << ", " << dimensions << "-D";
      EXPECT_LT(error_right, 0.03) << name << ", " << dimensions << "-D";
      // twice what is measured: 0.05 m/s, and 0.10 m/s in 3-D, which has rested for half the time from half the packing
      EXPECT_LT(greatest_speed(fluid), dimensions == 2 ? 0.1 : 0.2) << name << ", " << dimensions << "-D";
      EXPECT_NEAR(force, exact, 0.05 * exact) << name << ", " << dimensions << "-D";
    }
}

TEST(ThinPlate, KeepsTheOtherSideDry) {
  for (const auto& [name, elements] : every_kind) {
    Case scene = parted_tank(2, 0.002, 0.3, 0, 0);
    scene.numerics.walls.elements = elements;
    Tank tank(scene);
    rest(tank, 0.6, 200);
    const FluidState fluid = tank.solver->download();
    EXPECT_EQ(members(fluid, 0, 0.4), fluid.id.size()) << name;
    std::printf("dry side, %-16s greatest speed %.4f m/s\n", name, greatest_speed(fluid));
    EXPECT_LT(pressure_error(fluid, 0, 0.4, 0.3), 0.02) << name;
    EXPECT_LT(greatest_speed(fluid), 0.05) << name << ", twice what is measured";
  }
}

/// The same, without what is nearer to a point than `clear`.
double pressure_error_beyond(const FluidState& fluid, const Vector3d& point, double clear, double depth) {
  FluidState rest;
  for (std::size_t i = 0; i < fluid.id.size(); ++i) {
    if ((fluid.position[i] - point).norm() < clear) continue;
    rest.id.push_back(fluid.id[i]);
    rest.position.push_back(fluid.position[i]);
    rest.pressure.push_back(fluid.pressure[i]);
  }
  return pressure_error(rest, -1e9, 1e9, depth);
}

TEST(ThinPlate, WaterAtRestStaysSoAboutItsLowerEdge) {
  for (const auto& [name, elements] : every_kind) {
    Case scene = parted_tank(2, 0.004, 0.3, 0.3, 0.1);
    scene.numerics.walls.elements = elements;
    Tank tank(scene);
    rest(tank, 0.6, 200);
    const FluidState fluid = tank.solver->download();
    const double all = pressure_error(fluid, 0, 0.8, 0.3), beyond = pressure_error_beyond(fluid, Vector3d(0.402, 0, 0.1), 5 * spacing, 0.3);
    const double fastest = greatest_speed(fluid);
    std::printf("lower edge, %-16s pressure error %.4f of rho g depth, five spacings from the edge %.4f; greatest speed %.3f m/s\n", name,
                all, beyond, fastest);
    EXPECT_LT(all, 0.02) << name;
    EXPECT_LT(beyond, 0.02) << name;
    EXPECT_LT(fastest, 0.1) << name;
  }
}

}  // namespace
}  // namespace wavetank::thin_plate_test

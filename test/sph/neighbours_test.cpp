// The neighbour grid and the kernel: sums over the device's neighbours against sums over all particles on the host.
#include <random>

#include "sph_fixture.h"

namespace wavetank::neighbours_test {
namespace {

constexpr unsigned seed = 20251;

double wendland(int dimensions, double h, double r) {
  const double pi = std::acos(-1.0), q = r / h;
  if (q >= 2) return 0;
  const double scale = dimensions == 2 ? 7.0 / (4.0 * pi * h * h) : 21.0 / (16.0 * pi * h * h * h);
  return scale * std::pow(1 - 0.5 * q, 4) * (1 + 2 * q);
}

/// By all particles, without a grid.
PointValue summed(const Tank& tank, const FluidState& fluid, const Vector3d& point) {
  PointValue value;
  const double density = tank.scene.fluid.density;
  for (std::size_t j = 0; j < fluid.id.size(); ++j) {
    const Vector3d r = fluid.position[j] - point;
    const double local = density * (1 + fluid.compression[j]);
    const double weight = wendland(tank.scene.dimensions, tank.discretisation.smoothing_length, r.norm()) * fluid.mass[j] / local;
    value.filling += weight;
    value.pressure += weight * (fluid.pressure[j] - local * tank.scene.gravity.dot(r));
  }
  value.pressure /= std::max(value.filling, 0.5);  // there are no walls, so γ is 1
  return value;
}

void compare_with_all_pairs(int dimensions, Precision precision, double tolerance) {
  if (!has_precision(precision)) GTEST_SKIP() << "the device has no double precision";
  std::mt19937 random(seed);
  const double spacing = 0.05;
  const Box domain{Vector3d(-0.3, dimensions == 3 ? 0.2 : 0.0, 0.4), Vector3d(0.6, dimensions == 3 ? 0.8 : 0.0, 1.1)};
  const auto anywhere = [&](double beyond) {
    Vector3d point = Vector3d::Zero();
    for (int axis = 0; axis < 3; ++axis)
      if (axis != 1 || dimensions == 3)
        point[axis] = std::uniform_real_distribution<double>(domain.min[axis] - beyond, domain.max[axis] + beyond)(random);
    return point;
  };
  Case scene;
  scene.dimensions = dimensions;
  scene.fluid.sound_speed = 12;
  scene.numerics.precision = precision;
  scene.numerics.support = 3;
  // neither a lattice nor of one density: clumps and holes
  std::vector<Vector3d> particles(dimensions == 2 ? 250 : 1800);
  for (Vector3d& particle : particles) particle = anywhere(0);
  Layout layout = loose_particles(domain, spacing, particles, dimensions);
  for (double& level : layout.levels) level = std::uniform_real_distribution<double>(1.0, 2.0)(random);
  Tank tank(scene, layout);
  tank.solver->start();

  std::vector<Vector3d> points;
  for (int k = 0; k < 300; ++k) points.push_back(anywhere(0));
  for (int k = 0; k < 100; ++k) points.push_back(anywhere(0.4 * spacing));  // and outside the tank's walls
  for (int corner = 0; corner < 8; ++corner)
    points.emplace_back(corner & 1 ? domain.max.x() : domain.min.x(), corner & 2 ? domain.max.y() : domain.min.y(),
                        corner & 4 ? domain.max.z() : domain.min.z());
  const std::vector<PointValue> values = tank.solver->evaluate(*tank.solver->make_points(points));
  const FluidState fluid = tank.solver->download();
  ASSERT_EQ(fluid.id.size(), particles.size());

  double filling_error = 0, pressure_error = 0;
  int wet = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const PointValue expected = summed(tank, fluid, points[k]);
    filling_error = std::max(filling_error, std::abs(values[k].filling - expected.filling) / std::max(expected.filling, 0.1));
    pressure_error = std::max(pressure_error, std::abs(values[k].pressure - expected.pressure) / 1e4);
    wet += expected.filling > 0.1;
  }
  std::printf("%d-D, %s, seed %u: greatest relative error of the filling %.1e, of the pressure %.1e\n", dimensions,
              precision == Precision::single ? "single" : "double", seed, filling_error, pressure_error);
  EXPECT_GT(wet, 300);
  EXPECT_LT(filling_error, tolerance);
  EXPECT_LT(pressure_error, tolerance);
}

TEST(Neighbours, SumsAreThoseOfAllPairsIn2D) {
  compare_with_all_pairs(2, Precision::single, 1e-5);
  compare_with_all_pairs(2, Precision::double_, 1e-12);
}

TEST(Neighbours, SumsAreThoseOfAllPairsIn3D) {
  compare_with_all_pairs(3, Precision::single, 1e-5);
  compare_with_all_pairs(3, Precision::double_, 1e-12);
}

TEST(Neighbours, SortingKeepsEveryParticle) {
  Tank tank(box_case(Vector3d(0.4, 0, 0.4), 0.3, 0.02));
  tank.pack_and_start(20);
  std::vector<bool> seen(tank.layout.particles.size(), false);
  for (const std::uint32_t id : tank.solver->download().id) {
    ASSERT_LT(id, seen.size());
    EXPECT_FALSE(seen[id]) << "particle " << id << " twice";
    seen[id] = true;
  }
}

TEST(Kernel, IntegratesToOne) {
  for (const int dimensions : {2, 3}) {
    const double spacing = 0.1, side = 0.02;
    const double half = dimensions == 3 ? 0.5 : 0.0;
    Case scene;
    scene.dimensions = dimensions;
    scene.fluid.sound_speed = 10;
    Tank tank(scene, loose_particles({Vector3d(-0.5, -half, -0.5), Vector3d(0.5, half, 0.5)}, spacing, {Vector3d::Zero()}, dimensions));
    std::vector<Vector3d> points;
    for (double x = -0.41; x < 0.41; x += side)
      for (double y = dimensions == 3 ? -0.41 : 0.0; y < 0.41; y += dimensions == 3 ? side : 1.0)
        for (double z = -0.41; z < 0.41; z += side) points.emplace_back(x, y, z);
    double integral = 0;
    for (const PointValue& value : tank.solver->evaluate(*tank.solver->make_points(points))) integral += value.filling;
    integral *= std::pow(side / spacing, dimensions);
    std::printf("%d-D: the kernel's integral is %.6f\n", dimensions, integral);
    EXPECT_NEAR(integral, 1.0, 1e-4);
  }
}

TEST(Kernel, FillsAPackedLattice) {
  for (const int dimensions : {2, 3}) {
    const double spacing = 0.05, side = dimensions == 2 ? 1.0 : 0.6;
    Tank tank(box_case(Vector3d(side, dimensions == 3 ? side : 0.0, side + 0.2), side, spacing));
    tank.pack_and_start(100);
    std::vector<Vector3d> points;
    const double margin = tank.discretisation.support;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> inside(margin, side - margin);
    for (int k = 0; k < 200; ++k) points.emplace_back(inside(random), dimensions == 3 ? inside(random) : 0.0, inside(random));
    double greatest = 0;
    for (const PointValue& value : tank.solver->evaluate(*tank.solver->make_points(points)))
      greatest = std::max(greatest, std::abs(value.filling - 1));
    std::printf("%d-D: Σ W V of a packed lattice is 1 to %.1e\n", dimensions, greatest);
    EXPECT_LT(greatest, 0.01);
  }
}

}  // namespace
}  // namespace wavetank::neighbours_test

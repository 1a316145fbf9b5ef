// The surface of the water as a mesh: closed, in its place, of the right volume; and what is beside it.
#include "wavetank/surface/surface_finder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <map>

#include "../../src/simulation/snapshot.h"
#include "../common/box_case.h"
#include "../common/scratch_directory.h"
#include "../sph/state_bytes.h"

namespace wavetank::surface_finder_test {
namespace {

class SurfaceFinderTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!can_find_surface()) GTEST_SKIP() << why_no_surface;
  }
};

WaterSurface surface_of(const Simulation& simulation, std::size_t most_triangles = 75000) {
  const SurfaceFinder finder(simulation, most_triangles);
  return finder.find(finder.look_at(simulation));
}

/// By the divergence theorem; positive where triangles are anticlockwise seen from outside.
double volume_of(const WaterSurface& surface) {
  double volume = 0;
  for (const std::array<int, 3>& t : surface.triangles) {
    const Vector3d a = surface.vertices[t[0]].cast<double>(), b = surface.vertices[t[1]].cast<double>(),
                   c = surface.vertices[t[2]].cast<double>();
    volume += a.dot(b.cross(c)) / 6;
  }
  return volume;
}

/// Every edge belongs to two triangles, which go along it in opposite directions.
void expect_closed(const WaterSurface& surface) {
  ASSERT_FALSE(surface.triangles.empty());
  std::map<std::pair<int, int>, int> edges;
  for (const std::array<int, 3>& t : surface.triangles)
    for (int k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
  std::size_t faulty = 0;
  for (const auto& [edge, count] : edges) {
    const auto back = edges.find({edge.second, edge.first});
    if (count != 1 || back == edges.end() || back->second != 1) ++faulty;
  }
  EXPECT_EQ(faulty, 0u) << "of " << edges.size() << " sides of triangles";
}

Case still_tank() {
  Case scene = box_case(Vector3d(0.6, 0.4, 0.4), 0.2, 0.02);
  scene.numerics.packing.iterations = 50;
  return scene;
}

TEST_F(SurfaceFinderTest, still_tank_is_flat_and_closed) {
  const double depth = 0.2, spacing = 0.02;
  Simulation simulation(still_tank());
  for (int step = 0; step < 20; ++step) simulation.advance();
  const WaterSurface surface = surface_of(simulation);
  expect_closed(surface);
  const double cut_off = 0.25 * spacing * spacing * 4 * (0.6 + 0.4 + depth);  // of a cell at edges of the tank
  EXPECT_NEAR(volume_of(surface), 0.6 * 0.4 * depth - cut_off, 0.01 * 0.6 * 0.4 * depth);
  double least = 1, most = 0, outside = 0;
  for (const Eigen::Vector3f& v : surface.vertices) {
    const double beside = std::min({v.x() - 0.0, 0.6 - v.x(), v.y() - 0.0, 0.4 - v.y()});
    outside = std::max({outside, -beside, -static_cast<double>(v.z())});
    most = std::max<double>(most, v.z());  // also at walls, which the water does not climb
    if (beside > 0.5 * spacing && v.z() > 0.5 * depth) least = std::min<double>(least, v.z());
  }
  std::printf("surface from %.5f to %.5f m; %zu triangles; volume %.5f of %.5f m3; %.2e m outside\n", least, most, surface.triangles.size(),
              volume_of(surface), 0.6 * 0.4 * depth, outside);
  EXPECT_NEAR(least, depth, 0.1 * spacing);
  EXPECT_NEAR(most, depth, 0.1 * spacing);
  EXPECT_LT(outside, 1e-3 * spacing);
  EXPECT_TRUE(surface.spray.empty());
}

TEST_F(SurfaceFinderTest, height_map_has_the_level_and_no_water_where_there_is_none) {
  Case scene = still_tank();
  scene.fluid.fill = {Box{Vector3d::Zero(), Vector3d(0.3, 0.4, 0.2)}};
  scene.numerics.packing.iterations = 0;
  const Simulation simulation(scene);
  const HeightMap map = surface_of(simulation).heights;
  ASSERT_EQ(map.rows, 30);
  ASSERT_EQ(map.columns, 20);
  EXPECT_DOUBLE_EQ(map.resolution, 0.02);
  EXPECT_TRUE(map.first.isApprox(Vector3d(0.59, 0.39, 0), 1e-9)) << map.first.transpose();
  for (int row = 0; row < map.rows; ++row)
    for (int column = 0; column < map.columns; ++column) {
      const double x = map.first.x() - row * map.resolution;
      const float height = map.heights[row * map.columns + column];
      if (x < 0.26) EXPECT_NEAR(height, 0.2, 0.1 * 0.02) << x;
      if (x > 0.34) EXPECT_TRUE(std::isnan(height)) << x;
    }
}

/// Columns of particles of a lattice that make a ball.
Case ball_of_water(double radius, double spacing) {
  const double middle = radius + 3 * spacing;
  Case scene = box_case(Vector3d::Constant(2 * middle), 2 * middle, spacing);
  scene.fluid.fill.clear();
  const int most = static_cast<int>(radius / spacing) + 1;
  const auto half_column = [&](int i, int j) {
    const double beside = std::hypot(i + 0.5, j + 0.5) * spacing;
    return beside < radius ? static_cast<int>(std::lround(std::sqrt(radius * radius - beside * beside) / spacing)) : 0;
  };
  for (int i = -most; i < most; ++i)
    for (int j = -most; j < most;) {
      const int half = half_column(i, j), first = j;
      while (j < most && half_column(i, j) == half) ++j;  // columns of one height are one box
      if (half == 0) continue;
      const Vector3d least = Vector3d::Constant(middle) + spacing * Vector3d(i, first, -half);
      scene.fluid.fill.push_back(Box{least, least + spacing * Vector3d(1, j - first, 2 * half)});
    }
  scene.gravity.setZero();
  scene.fluid.sound_speed = 10;
  scene.numerics.packing.iterations = 0;
  return scene;
}

TEST_F(SurfaceFinderTest, ball_has_its_volume) {
  const double spacing = 0.01, radius = 12 * spacing;
  const Simulation simulation(ball_of_water(radius, spacing));
  const WaterSurface surface = surface_of(simulation);
  expect_closed(surface);
  const double volume = static_cast<double>(simulation.state().particles) * std::pow(spacing, 3);
  std::printf("volume %.6f of %.6f m3: %.2f %%\n", volume_of(surface), volume, 100 * (volume_of(surface) / volume - 1));
  EXPECT_NEAR(volume_of(surface), volume, 0.01 * volume);
}

/// A cube of `cells`³ full of water but for the cells that are air, without gravity.
Case water_with_air(int cells, double spacing, const std::function<bool(int, int, int)>& is_air) {
  Case scene = box_case(Vector3d::Constant(cells * spacing), cells * spacing, spacing);
  scene.fluid.fill.clear();
  const auto runs = [&](int i, int j) {  // of water, in a column
    std::vector<std::pair<int, int>> found;
    for (int k = 0; k < cells; ++k) {
      if (is_air(i, j, k)) continue;
      if (found.empty() || found.back().second != k) found.emplace_back(k, k);
      ++found.back().second;
    }
    return found;
  };
  for (int i = 0; i < cells; ++i)
    for (int j = 0; j < cells;) {
      const auto water = runs(i, j);
      const int first = j;
      while (j < cells && runs(i, j) == water) ++j;  // columns of the same are one box each
      for (const auto& [from, to] : water)
        scene.fluid.fill.push_back(Box{spacing * Vector3d(i, first, from), spacing * Vector3d(i + 1, j, to)});
    }
  scene.gravity.setZero();
  scene.fluid.sound_speed = 10;
  scene.numerics.packing.iterations = 0;
  return scene;
}

/// The finder's nodes come in blocks of two: where a cavity begins between them tells whether it leaves all blocks half full.
TEST_F(SurfaceFinderTest, cavities_of_two_spacings_are_found_wherever_they_begin) {
  const double spacing = 0.02;
  for (const int first : {6, 7}) {
    const Simulation sheet(water_with_air(15, spacing, [&](int, int, int k) { return k == first || k == first + 1; }));
    const WaterSurface about_sheet = surface_of(sheet);
    expect_closed(about_sheet);
    const double volume = static_cast<double>(sheet.state().particles) * std::pow(spacing, 3);
    EXPECT_NEAR(volume_of(about_sheet), volume, 0.06 * volume) << "sheet from " << first;  // the tank's edges; the sheet is 0.15 of it

    const Eigen::Vector3f middle = Eigen::Vector3f::Constant(static_cast<float>((first + 1) * spacing));
    const Simulation bubble(water_with_air(
        15, spacing, [&](int i, int j, int k) { return (Vector3d(i + 0.5, j + 0.5, k + 0.5).array() - (first + 1)).matrix().norm() < 2; }));
    double sum = 0;
    int count = 0;
    for (const Eigen::Vector3f& vertex : surface_of(bubble).vertices) {
      const double distance = (vertex - middle).norm() / spacing;
      if (distance > 4) continue;
      sum += distance;
      ++count;
    }
    ASSERT_GT(count, 0) << "bubble about " << first + 1;
    std::printf("sheet: volume %.2f %%; bubble: mean radius %.3f spacings, %d vertices\n", 100 * (volume_of(about_sheet) / volume - 1),
                sum / count, count);
    EXPECT_NEAR(sum / count, 2, 0.5);
  }
}

TEST_F(SurfaceFinderTest, floating_box_bears_no_skin) {
  const double spacing = 0.025;
  Case scene = box_case(Vector3d(0.6, 0.5, 0.5), 0.3, spacing);
  BodyCase body;
  body.name = "box";
  const Box hull{Vector3d(0.2, 0.15, 0.25), Vector3d(0.4, 0.35, 0.4)};
  body.shape = hull;
  body.motion = Motion::free;
  body.rigid.density = 400;
  scene.bodies = {body};
  scene.numerics.packing.iterations = 20;
  Simulation simulation(scene);
  for (int step = 0; step < 60; ++step) simulation.advance();
  const WaterSurface surface = surface_of(simulation);
  expect_closed(surface);
  const RigidState state = simulation.bodies().state_in_tank(1);
  double deepest = -1, highest = 0;
  for (const Eigen::Vector3f& v : surface.vertices) {
    const Vector3d given = state.orientation.conjugate() * (v.cast<double>() - state.position) + simulation.bodies().reference(1);
    deepest = std::max(deepest, std::min((given - hull.min).minCoeff(), (hull.max - given).minCoeff()));
    highest = std::max<double>(highest, v.z());
  }
  const double displaced = (0.3 - 0.25) * 0.2 * 0.2;
  std::printf("deepest vertex in the hull %.4f, highest %.4f m; volume %.5f of %.5f m3\n", deepest, highest, volume_of(surface),
              0.6 * 0.5 * 0.3 - displaced);
  EXPECT_LT(deepest, 0.5 * spacing);
  EXPECT_LT(highest, 0.3 + 1.5 * spacing) << "water hangs on the hull or a wall";
  EXPECT_NEAR(volume_of(surface), 0.6 * 0.5 * 0.3 - displaced, 0.01 * 0.6 * 0.5 * 0.3);
}

TEST_F(SurfaceFinderTest, drop_of_one_particle_is_spray) {
  Case scene = still_tank();
  const Vector3d drop(0.3, 0.2, 0.32);
  scene.fluid.fill.push_back(Box{drop, drop + Vector3d::Constant(0.02)});
  scene.numerics.packing.iterations = 0;
  const Simulation simulation(scene);
  const WaterSurface surface = surface_of(simulation);
  ASSERT_EQ(surface.spray.size(), 1u);
  EXPECT_TRUE(surface.spray[0].isApprox(Eigen::Vector3f(0.31F, 0.21F, 0.33F), 1e-4F)) << surface.spray[0].transpose();
  for (const Eigen::Vector3f& v : surface.vertices) ASSERT_LT(v.z(), 0.25F);
}

/// How often the surface goes round a point: 1 in the water, 0 outside.
double turns_about(const WaterSurface& surface, const Vector3d& point) {
  double angle = 0;
  for (const std::array<int, 3>& t : surface.triangles) {
    const Vector3d a = surface.vertices[t[0]].cast<double>() - point, b = surface.vertices[t[1]].cast<double>() - point,
                   c = surface.vertices[t[2]].cast<double>() - point;
    const double p = a.norm(), q = b.norm(), r = c.norm();
    angle += 2 * std::atan2(a.dot(b.cross(c)), p * q * r + a.dot(b) * r + b.dot(c) * p + c.dot(a) * q);
  }
  return angle / (4 * M_PI);
}

TEST_F(SurfaceFinderTest, particle_of_a_small_drop_is_in_the_mesh_or_spray) {
  Case scene = still_tank();
  const Vector3d drop(0.28, 0.18, 0.28);
  scene.fluid.fill.push_back(Box{drop, drop + Vector3d::Constant(3 * 0.02)});
  scene.numerics.packing.iterations = 0;
  const Simulation simulation(scene);
  const WaterSurface surface = surface_of(simulation);
  expect_closed(surface);
  int in_mesh = 0;
  for (const Eigen::Vector3f& particle : simulation.places()) {
    if (particle.z() < 0.27F) continue;
    const bool is_within = turns_about(surface, particle.cast<double>()) > 0.5;
    const bool is_spray = std::find(surface.spray.begin(), surface.spray.end(), particle) != surface.spray.end();
    EXPECT_NE(is_within, is_spray) << particle.transpose();
    if (is_within) ++in_mesh;
  }
  std::printf("%d of 27 particles in the mesh\n", in_mesh);
  EXPECT_GT(in_mesh, 0);
}

TEST_F(SurfaceFinderTest, two_dimensions_are_a_slab_of_one_spacing) {
  const double spacing = 0.02;
  Case scene = box_case(Vector3d(0.6, 0, 0.4), 0.2, spacing);
  Simulation simulation(scene);
  for (int step = 0; step < 20; ++step) simulation.advance();
  const WaterSurface surface = surface_of(simulation);
  expect_closed(surface);
  std::printf("volume %.6f of %.6f m3\n", volume_of(surface), 0.6 * 0.2 * spacing);
  EXPECT_NEAR(volume_of(surface), 0.6 * 0.2 * spacing, 0.03 * 0.6 * 0.2 * spacing);
  for (const Eigen::Vector3f& v : surface.vertices) {
    EXPECT_LE(std::abs(v.y()), 0.501 * spacing);
    EXPECT_LE(v.z(), 0.2 + 0.1 * spacing);
  }
  EXPECT_EQ(surface.heights.columns, 1);
  ASSERT_EQ(surface.heights.rows, 30);
  for (const float height : surface.heights.heights) EXPECT_NEAR(height, 0.2, 0.1 * spacing);  // at walls as well
}

TEST_F(SurfaceFinderTest, body_in_two_dimensions_cuts_the_water_off_where_it_has_turned_to) {
  const double spacing = 0.02;
  Case scene = box_case(Vector3d(0.8, 0, 0.5), 0.3, spacing);
  BodyCase body;
  body.name = "box";
  const Box hull{Vector3d(0.3, 0, 0.2), Vector3d(0.5, 0, 0.36)};
  body.shape = hull;
  body.motion = Motion::free;
  body.rigid.density = 500;
  body.rigid.angular_velocity = Vector3d(0, 3, 0);
  scene.bodies = {body};
  Simulation simulation(scene);
  while (simulation.state().time < 0.06) simulation.advance();
  const RigidState state = simulation.bodies().state_in_tank(1);
  ASSERT_GT(std::abs(state.orientation.y()), 0.03);
  const WaterSurface surface = surface_of(simulation);
  expect_closed(surface);
  double deepest = -1;
  int about = 0;
  for (const Eigen::Vector3f& v : surface.vertices) {
    const Vector3d given = state.orientation.conjugate() * (v.cast<double>() - state.position) + simulation.bodies().reference(1);
    const double depth = std::min({given.x() - hull.min.x(), hull.max.x() - given.x(), given.z() - hull.min.z(), hull.max.z() - given.z()});
    deepest = std::max(deepest, depth);
    if (std::abs(depth) < 0.5 * spacing) ++about;
  }
  std::printf("deepest vertex in the hull %.2f spacings, %d about it\n", deepest / spacing, about);
  EXPECT_LT(deepest, 0.5 * spacing);
  EXPECT_GT(about, 0);
}

TEST_F(SurfaceFinderTest, openings_cut_off_the_water_beyond_them) {
  const double spacing = 0.02, depth = 0.2;
  for (const int dimensions : {2, 3}) {
    Case scene = box_case(Vector3d(0.6, dimensions == 2 ? 0 : 0.3, 0.4), depth, spacing);
    OpeningCase inlet;
    inlet.name = "in";
    inlet.kind = OpeningKind::inlet;
    inlet.centre = Vector3d(0, dimensions == 2 ? 0 : 0.15, 0.15);
    inlet.normal = Vector3d::UnitX();
    inlet.size = std::array<double, 2>{0.16, 0.3};
    inlet.velocity = "0.1";
    inlet.level = depth;
    scene.openings = {inlet};
    Simulation simulation(scene);
    for (int step = 0; step < 5; ++step) simulation.advance();
    ASSERT_GT(simulation.layout().beyond, 0u);
    const WaterSurface surface = surface_of(simulation);
    expect_closed(surface);
    double least = 1;
    for (const Eigen::Vector3f& v : surface.vertices) least = std::min<double>(least, v.x());
    std::printf("from x = %.5f m, %zu of spray, volume %.5f m3\n", least, surface.spray.size(), volume_of(surface));
    EXPECT_NEAR(least, 0, 0.05 * spacing);
    EXPECT_TRUE(surface.spray.empty());
    const double volume = 0.6 * (dimensions == 2 ? spacing : 0.3) * depth;
    EXPECT_NEAR(volume_of(surface), volume, 0.03 * volume);
  }
}

TEST_F(SurfaceFinderTest, many_triangles_are_made_fewer) {
  const Simulation simulation(still_tank());
  const WaterSurface fine = surface_of(simulation), flat = surface_of(simulation, fine.triangles.size() / 2),
                     coarse = surface_of(simulation, 300);
  EXPECT_LE(flat.triangles.size(), fine.triangles.size() / 2);
  EXPECT_LE(coarse.triangles.size(), 300u);
  expect_closed(flat);
  expect_closed(coarse);
  EXPECT_NEAR(volume_of(flat), volume_of(fine), 0.03 * volume_of(fine));  // the tank's edges are cut off
  EXPECT_NEAR(volume_of(coarse), volume_of(fine), 0.15 * volume_of(fine));
}

/// As a run leaves them that the watchdog stops.
TEST_F(SurfaceFinderTest, particles_that_are_lost_are_left_out) {
  const ScratchDirectory scratch;
  Simulation simulation(still_tank());
  const WaterSurface before = surface_of(simulation);
  simulation.save(scratch.file("sound"));
  Snapshot snapshot = read_snapshot(scratch.file("sound"));
  StateBytes<float> state(snapshot.fluid, simulation.state().particles);
  state.set("x", 12, std::numeric_limits<float>::quiet_NaN());
  state.set("y", 13, std::numeric_limits<float>::infinity());
  state.set("z", 14, 1e30);
  state.set("x", 15, -1e4);
  snapshot.fluid = state.bytes();
  write_snapshot(scratch.file("lost"), snapshot);
  simulation.restore(scratch.file("lost"));
  const SurfaceFinder finder(simulation);
  const WaterField field = finder.look_at(simulation);
  EXPECT_EQ(field.particles.size(), simulation.state().particles - 4);
  const WaterSurface surface = finder.find(field);
  expect_closed(surface);
  EXPECT_NEAR(volume_of(surface), volume_of(before), 0.01 * volume_of(before));
}

TEST_F(SurfaceFinderTest, run_is_the_same_to_the_last_bit) {
  const ScratchDirectory scratch;
  const auto bits_after = [&](bool looked_at) {
    Simulation simulation(still_tank());
    std::optional<SurfaceFinder> finder;
    if (looked_at) finder.emplace(simulation);
    for (int step = 0; step < 6; ++step) {
      if (finder) EXPECT_FALSE(finder->find(finder->look_at(simulation)).triangles.empty());
      simulation.advance();
    }
    simulation.save(scratch.file("bits"));
    std::ifstream stream(scratch.file("bits"), std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(stream), {});
  };
  EXPECT_TRUE(bits_after(true) == bits_after(false));
}

}  // namespace
}  // namespace wavetank::surface_finder_test

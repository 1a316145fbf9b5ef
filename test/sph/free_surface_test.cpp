// Which particles are on the free surface, where that is known.
#include <random>

#include "sph_fixture.h"

namespace wavetank::free_surface_test {
namespace {

/// By id, of water that has not moved.
std::vector<bool> surface_of(Case scene, const Layout& layout) {
  scene = settled(scene, layout);
  const auto solver = make_solver(test_device(), scene, layout, discretise(scene, layout), {Vector3d::Zero()});
  solver->start();
  const FluidState fluid = solver->download();
  const FluidSurface found = solver->find_surface();
  std::vector<bool> surface(fluid.id.size());
  for (std::size_t i = 0; i < fluid.id.size(); ++i) surface[fluid.id[i]] = found.on_surface[i] != 0;
  return surface;
}

TEST(FreeSurface, OfStillWaterIsItsUppermostRow) {
  for (const auto elements : {WallElements::numerical, WallElements::semi_analytical, WallElements::facet})
    for (const int dimensions : {2, 3}) {
      const double width = dimensions == 3 ? 0.4 : 0;
      Case scene = box_case(Vector3d(0.4, width, 0.6), 0.4, 0.04);
      scene.numerics.walls.elements = elements;
      const Layout layout = lay_out(scene);
      const std::vector<bool> surface = surface_of(scene, layout);
      int wrong = 0, of_surface = 0;
      for (std::size_t i = 0; i < surface.size(); ++i) {
        const bool uppermost = layout.particles[i].z() > 0.36;
        of_surface += uppermost;
        wrong += surface[i] != uppermost;
      }
      std::printf("%d-D, elements %d: %d of %zu particles are told wrongly, %d are on the surface\n", dimensions,
                  static_cast<int>(elements), wrong, surface.size(), of_surface);
      EXPECT_EQ(wrong, 0);
    }
}

TEST(FreeSurface, IsFoundAroundHolesOfThreeSpacings) {
  constexpr unsigned seed = 3;
  std::mt19937 random(seed);
  const double spacing = 0.025;
  for (const int dimensions : {2, 3}) {
    std::uniform_real_distribution<double> any(-0.1 * spacing, 0.1 * spacing);
    const double radius = dimensions == 2 ? 20 * spacing : 10 * spacing, hole = 1.5 * spacing;
    const Vector3d centre = Vector3d(0.6, dimensions == 3 ? 0.6 : 0, 0.6);
    std::vector<Vector3d> particles;
    const int reach = static_cast<int>(radius / spacing) + 1;
    for (int i = -reach; i <= reach; ++i)
      for (int j = dimensions == 3 ? -reach : 0; j <= (dimensions == 3 ? reach : 0); ++j)
        for (int k = -reach; k <= reach; ++k) {
          const Vector3d way = spacing * Vector3d(i, j, k);
          const Vector3d off(any(random), dimensions == 3 ? any(random) : 0, any(random));
          if (way.norm() < radius && way.norm() > hole) particles.push_back(centre + way + off);
        }
    Case scene = box_case(Vector3d(1.2, dimensions == 3 ? 1.2 : 0, 1.2), 1, spacing);
    scene.gravity = Vector3d::Zero();
    scene.fluid.sound_speed = 10;
    const Layout layout =
        loose_particles({Vector3d::Zero(), Vector3d(1.2, dimensions == 3 ? 1.2 : 0, 1.2)}, spacing, particles, dimensions);
    const std::vector<bool> surface = surface_of(scene, layout);
    int rim = 0, at_hole = 0, elsewhere = 0, missed = 0;
    for (std::size_t i = 0; i < surface.size(); ++i) {
      const double distance = (particles[i] - centre).norm();
      if (surface[i] && distance < hole + 1.5 * spacing)
        ++at_hole;
      else if (surface[i] && distance > radius - 2 * spacing)
        ++rim;
      else if (surface[i])
        ++elsewhere;
      if (!surface[i] && distance > radius - 0.4 * spacing) ++missed;
    }
    std::printf("%d-D, seed %u: %d on the rim and %d of it missed, %d around the hole, %d elsewhere\n", dimensions, seed, rim, missed,
                at_hole, elsewhere);
    EXPECT_EQ(elsewhere, 0);
    EXPECT_EQ(missed, 0);
    EXPECT_GE(at_hole, dimensions == 2 ? 8 : 20);
  }
}

/// A surface z = 0.3 + 0.04 sin(2π x/0.5) over disordered water: of its length what has no particle of the surface within a spacing, and
/// particles of the surface farther under it than the second row.
TEST(FreeSurface, IsFoundAlongWaves) {
  constexpr unsigned seed = 5;
  std::mt19937 random(seed);
  const double spacing = 0.0125;
  std::uniform_real_distribution<double> any(-0.15 * spacing, 0.15 * spacing);
  const auto level = [](double x) { return 0.3 + 0.04 * std::sin(2 * M_PI * x / 0.5); };
  Case scene = box_case(Vector3d(1, 0, 0.5), 0.3, spacing);
  scene.tank.periodic = {true, false, false};
  Layout layout = lay_out(scene);
  layout.particles.clear();
  for (double x = 0.5 * spacing; x < 1; x += spacing)
    for (double z = 0.5 * spacing; z < 0.5; z += spacing)
      if (z < level(x)) layout.particles.emplace_back(x + any(random), 0, z + any(random));
  layout.volumes.assign(layout.particles.size(), spacing * spacing);
  layout.levels.clear();
  for (const Vector3d& place : layout.particles) layout.levels.push_back(level(place.x()));
  const std::vector<bool> surface = surface_of(scene, layout);
  int points = 0, missed = 0, wrong = 0, found = 0;
  for (double x = 0.5 * spacing; x < 1; x += 0.1 * spacing) {
    const Vector3d at(x, 0, level(x));
    double nearest = 1;
    for (std::size_t i = 0; i < surface.size(); ++i)
      if (surface[i]) nearest = std::min(nearest, (layout.particles[i] - at).norm());
    ++points;
    missed += nearest > 1.3 * spacing;
  }
  for (std::size_t i = 0; i < surface.size(); ++i) {
    found += surface[i];
    double depth = 1;
    for (double x = 0; x < 1; x += 0.1 * spacing) depth = std::min(depth, (layout.particles[i] - Vector3d(x, 0, level(x))).norm());
    wrong += surface[i] && depth > 1.7 * spacing;
  }
  std::printf("seed %u: %d particles of the surface; %.2f %% of its length missed, %d particles told wrongly\n", seed, found,
              100.0 * missed / points, wrong);
  EXPECT_LT(missed, 0.01 * points);
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace wavetank::free_surface_test

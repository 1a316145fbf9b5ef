// Gauges whose lines pass through several surfaces, one over another: they read the upper one.
#include <sstream>

#include "../common/scratch_directory.h"
#include "../sph/sph_fixture.h"
#include "wavetank/instruments/recorder.h"

namespace wavetank::upper_surface_test {
namespace {

constexpr double spacing = 0.02;

std::vector<double> levels_of(const Case& scene, int steps = 40) {
  Tank tank(scene);
  tank.pack_and_start(50);
  const RigidWorld world(tank.scene, tank.layout);
  Recorder recorder(tank.scene, tank.layout, *tank.solver, world);
  for (int step = 0; step < steps; ++step) tank.solver->advance();
  recorder.start(*tank.solver);
  return recorder.take().levels[0].levels;
}

Case two_pools() {
  Case scene = box_case(Vector3d(1, 0, 0.8), 0.1, spacing);
  scene.fluid.sound_speed = 30;
  scene.fluid.fill = {Box{{0, 0, 0}, {1, 0, 0.1}}, Box{{0, 0, 0.4}, {0.5, 0, 0.52}}};
  scene.instruments.wave_gauges = {{"both", {0.25, 0, 0}}, {"lower", {0.8, 0, 0}}};
  return scene;
}

/// A basin on a shelf over another basin.
Case basin_over_basin(double shelf_thickness, Motion motion = Motion::fixed) {
  Case scene = two_pools();
  scene.bodies.push_back({"shelf", Box{{0, 0, 0.4 - shelf_thickness}, {0.5, 0, 0.4}}, motion});
  scene.bodies.push_back({"lip", Box{{0.5, 0, 0.3}, {0.6, 0, 0.6}}, Motion::fixed});
  return scene;
}

void expect_upper_surface(const Case& scene, double upper = 0.52, double lower = 0.1) {
  const std::vector<double> levels = levels_of(scene);
  std::printf("through both %.4f m, beside %.4f m\n", levels[0], levels[1]);
  EXPECT_NEAR(levels[0], upper, 0.4 * spacing);
  EXPECT_NEAR(levels[1], lower, 0.4 * spacing);
}

TEST(UpperSurface, OfABasinOnAShelf) { expect_upper_surface(basin_over_basin(0.1)); }

TEST(UpperSurface, OfABasinOnAShelfThatMayMove) { expect_upper_surface(basin_over_basin(0.1, Motion::commanded)); }

TEST(UpperSurface, OfABasinOnAThinShelf) { expect_upper_surface(basin_over_basin(1.5 * spacing)); }

TEST(UpperSurface, OfABasinOnTwoShelvesWithNothingBetween) {
  Case scene = basin_over_basin(0.05);
  scene.bodies.push_back({"second", Box{{0, 0, 0.2}, {0.5, 0, 0.26}}, Motion::fixed});
  expect_upper_surface(scene);
}

/// Of a line in the x–z plane, drawn out along y.
void draw_out(std::ostringstream& obj, int& vertices, const std::vector<Vector3d>& line) {
  for (std::size_t k = 0; k + 1 < line.size(); ++k) {
    for (const auto& [end, y] : {std::pair{k, -0.1}, std::pair{k + 1, -0.1}, std::pair{k + 1, 0.1}, std::pair{k, 0.1}})
      obj << "v " << line[end].x() << " " << y << " " << line[end].z() << "\n";
    obj << "f " << vertices + 1 << " " << vertices + 2 << " " << vertices + 3 << "\nf " << vertices + 1 << " " << vertices + 3 << " "
        << vertices + 4 << "\n";
    vertices += 4;
  }
}

Case in_mesh_tank(const ScratchDirectory& scratch, const std::vector<std::vector<Vector3d>>& lines) {
  std::ostringstream obj;
  int vertices = 0;
  for (const std::vector<Vector3d>& line : lines) draw_out(obj, vertices, line);
  Case scene = two_pools();
  MeshSource mesh;
  mesh.uri = scratch.write("tank.obj", obj.str());
  scene.tank.shape = mesh;
  return scene;
}

TEST(UpperSurface, OfABasinOnAShelfOfTheTank) {
  const ScratchDirectory scratch;
  expect_upper_surface(in_mesh_tank(scratch, {{{0, 0, 0.8},
                                               {0, 0, 0.4},
                                               {0.5, 0, 0.4},
                                               {0.5, 0, 0.6},
                                               {0.6, 0, 0.6},
                                               {0.6, 0, 0.3},
                                               {0, 0, 0.3},
                                               {0, 0, 0},
                                               {1, 0, 0},
                                               {1, 0, 0.8}}}));
}

TEST(UpperSurface, OfABasinOnASheetOfTheTank) {
  const ScratchDirectory scratch;
  expect_upper_surface(
      in_mesh_tank(scratch, {{{0, 0, 0.8}, {0, 0, 0}, {1, 0, 0}, {1, 0, 0.8}}, {{0, 0, 0.4}, {0.5, 0, 0.4}, {0.5, 0, 0.6}}}));
}

TEST(UpperSurface, IsNotThatOfADryShelf) {
  Case scene = basin_over_basin(0.1);
  scene.fluid.fill.pop_back();
  expect_upper_surface(scene, 0.1);
  const ScratchDirectory scratch;
  scene = in_mesh_tank(scratch, {{{0, 0, 0.8}, {0, 0, 0.4}, {0.5, 0, 0.4}, {0.5, 0, 0.3}, {0, 0, 0.3}, {0, 0, 0}, {1, 0, 0}, {1, 0, 0.8}}});
  scene.fluid.fill.pop_back();
  expect_upper_surface(scene, 0.1);
}

TEST(UpperSurface, OfDropsIsOnlyTheirWater) {
  Case scene = two_pools();
  scene.fluid.fill = {Box{{0, 0, 0}, {1, 0, 0.1}}, Box{{0.15, 0, 0.5}, {0.35, 0, 0.56}}};  // a lump in free fall
  const std::vector<double> levels = levels_of(scene, 0);
  std::printf("under the lump %.4f m\n", levels[0]);
  EXPECT_NEAR(levels[0], 0.16, 0.4 * spacing);
}

TEST(UpperSurface, OfAFilmOnTheFloorIsItsThickness) {
  Case scene = box_case(Vector3d(1, 0, 0.4), 0.01, spacing);
  scene.fluid.sound_speed = 30;
  scene.fluid.fill = {Box{{0, 0, 0}, {1, 0, 0.01}}};
  scene.instruments.wave_gauges = {{"film", {0.5, 0, 0}}};
  const double level = levels_of(scene, 0)[0];
  std::printf("film of 0.01 m: %.4f m\n", level);
  EXPECT_NEAR(level, 0.01, 0.003);
}

}  // namespace
}  // namespace wavetank::upper_surface_test

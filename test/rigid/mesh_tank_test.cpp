#include <algorithm>
#include <random>

#include "rigid_fixture.h"

namespace wavetank::mesh_tank_test {
namespace {

constexpr double spacing = 0.05;

/// A tank with a floor at z = 0 and one box on it.
Case on_floor(double tilt, double friction) {
  Case scene = dry_case({8, 2, 2}, spacing);
  scene.gravity = gravity * Vector3d(std::sin(tilt), 0, -std::cos(tilt));
  scene.bodies = {free_box("brick", {2, 1, 0.1}, {0.4, 0.3, 0.2})};
  scene.bodies[0].rigid.friction = scene.tank.rigid.friction = friction;
  return scene;
}

class MeshTank : public ::testing::Test {
 protected:
  /// An open box whose floor is cut into many uneven triangles, not quite flat ones if `bumps` is given.
  MeshSource tank(const Vector3d& size, int cells, double bumps) const {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> part(-0.3, 0.3);
    TriangleMesh result;
    for (int j = 0; j <= cells; ++j)
      for (int i = 0; i <= cells; ++i) {
        const bool inner = i > 0 && j > 0 && i < cells && j < cells;
        const Vector3d shift = inner ? Vector3d(part(random), part(random), 0) : Vector3d(Vector3d::Zero());
        result.vertices.emplace_back((i + shift.x()) / cells * size.x(), (j + shift.y()) / cells * size.y(),
                                     inner ? bumps * part(random) : 0.0);
      }
    const auto at = [&](int i, int j) { return i + j * (cells + 1); };
    for (int j = 0; j < cells; ++j)
      for (int i = 0; i < cells; ++i) {
        result.triangles.emplace_back(at(i, j), at(i + 1, j), at(i + 1, j + 1));
        result.triangles.emplace_back(at(i, j), at(i + 1, j + 1), at(i, j + 1));
      }
    const auto wall = [&](int from, int to) {
      const int base = static_cast<int>(result.vertices.size());
      for (const int v : {from, to}) result.vertices.push_back(result.vertices[v] + Vector3d(0, 0, size.z()));
      result.triangles.emplace_back(from, to, base + 1);
      result.triangles.emplace_back(from, base + 1, base);
    };
    for (int k = 0; k < cells; ++k) {
      wall(at(k, 0), at(k + 1, 0));
      wall(at(k + 1, cells), at(k, cells));
      wall(at(0, k + 1), at(0, k));
      wall(at(cells, k), at(cells, k + 1));
    }
    MeshSource source;
    source.uri = scratch.write("tank.obj", obj_text(result));
    return source;
  }
  const ScratchDirectory scratch;
};

TEST_F(MeshTank, ABoxSlidesOverItsTrianglesWithoutCatching) {
  const double tilt = 0.5, friction = 0.3;
  Case scene = on_floor(tilt, friction);
  scene.tank.shape = tank({8, 2, 2}, 24, 0);
  Trial run(scene, 2e-4);
  run.until(1);
  const double speed = gravity * (std::sin(tilt) - friction * std::cos(tilt));
  EXPECT_NEAR(run.world.state(1).velocity.x(), speed, 1e-4 * speed);
  EXPECT_LT(std::abs(run.world.state(1).velocity.z()) + run.world.state(1).angular_velocity.norm(), 1e-4);
  EXPECT_NEAR(run.world.state(1).position.z(), 0.1, 0.02 * spacing);
}

TEST_F(MeshTank, ABoxOnABumpyFloorStaysOnIt) {
  Case scene = on_floor(0.3, 0.05);
  scene.tank.shape = tank({8, 2, 2}, 24, 0.01);
  scene.bodies[0] = free_box("brick", {2, 1, 0.15}, {0.4, 0.3, 0.2});
  scene.bodies[0].rigid.friction = 0.05;
  Trial run(scene, 2e-4);
  double lowest = 1, highest = 0;
  run.until(1, [&] {
    lowest = std::min(lowest, run.world.state(1).position.z());
    highest = std::max(highest, run.world.state(1).position.z());
  });
  // On a flat floor it would go 1.2 m; up and down 3 mm of bumps costs little.
  EXPECT_NEAR(run.world.state(1).position.x(), 2 + 0.5 * gravity * (std::sin(0.3) - 0.05 * std::cos(0.3)), 0.1);
  EXPECT_GT(lowest, 0.1 - 0.003 - 0.1 * spacing);
  EXPECT_LT(highest, 0.16);
}

}  // namespace
}  // namespace wavetank::mesh_tank_test

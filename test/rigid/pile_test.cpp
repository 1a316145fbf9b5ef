#include <algorithm>
#include <chrono>
#include <iostream>
#include <random>

#include "rigid_fixture.h"

namespace wavetank::pile_test {
namespace {

constexpr double spacing = 0.05;

/// Boxes and eight-cornered hulls dropped into a box tank.
Case pile(unsigned seed, const ScratchDirectory& scratch) {
  std::cout << "seed " << seed << "\n";
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> part(0, 1);
  Case scene = dry_case({1.2, 1.2, 2}, spacing);
  for (int k = 0; k < 10; ++k) {
    const Vector3d centre(0.3 + 0.3 * (k % 3) + 0.02 * part(random), 0.35 + 0.4 * (k / 3 % 2) + 0.02 * part(random), 0.3 + 0.35 * (k / 3));
    const Vector3d size = Vector3d::Constant(0.12) + 0.12 * Vector3d(part(random), part(random), part(random));
    BodyCase body = free_box("piece" + std::to_string(k), centre, size);
    if (k % 2 == 1) {
      TriangleMesh mesh = box_mesh({-0.5 * size, 0.5 * size}, false, "piece");
      for (Vector3d& vertex : mesh.vertices) vertex *= 0.8 + 0.2 * part(random);
      const Eigen::Quaterniond turn = Eigen::Quaterniond(1, part(random), part(random), part(random)).normalized();
      for (Vector3d& vertex : mesh.vertices) vertex = turn * vertex + centre;
      MeshSource source;
      source.uri = scratch.write(body.name + ".obj", obj_text(mesh));
      body.shape = source;
      body.rigid.collision = CollisionShape::convex_hull;
    }
    body.rigid.velocity = Vector3d(part(random) - 0.5, part(random) - 0.5, 0);
    body.rigid.angular_velocity = 5 * Vector3d(part(random), part(random), part(random));
    body.rigid.restitution = 0.2;
    scene.bodies.push_back(body);
  }
  return scene;
}

class Pile : public ::testing::Test {
 protected:
  const ScratchDirectory scratch;
  const Logged logged;
};

TEST_F(Pile, StaysInTheTankAndComesToRest) {
  Trial run(pile(7, scratch), 2e-4);
  std::vector<int> steps_held(run.world.count());  // of the last 0.1 s: a piece that nothing holds falls with g
  std::chrono::duration<double> spent{0};
  run.until(1.5, [&] {
    for (std::size_t o = 1; o < run.world.count(); ++o) {
      const Vector3d place = run.world.state(o).position;
      ASSERT_TRUE(place.allFinite() && (place.array() > 0.03).all() && place.x() < 1.17 && place.y() < 1.17) << o << " at " << run.time;
      steps_held[o] += run.time > 1.4 && run.world.state(o).acceleration.norm() < 0.1 * gravity;
    }
  });
  const double energy = run.world.kinetic_energy();
  const auto begin = std::chrono::steady_clock::now();
  run.steps(1000);
  spent = std::chrono::steady_clock::now() - begin;
  std::cout << "10 bodies in a heap: " << 1e3 * spent.count() << " µs a step\n";
  for (std::size_t o = 1; o < run.world.count(); ++o) EXPECT_GT(steps_held[o], 450) << "of 500 steps nothing holds piece " << o;
  double mass = 0;
  for (std::size_t o = 1; o < run.world.count(); ++o) mass += run.world.properties(o).mass;
  EXPECT_LT(energy, 0.5 * mass * 0.05 * 0.05) << "after 1.5 s the heap still moves";
  // No corner is deeper in a wall than a tenth of the spacing.
  for (std::size_t o = 1; o < run.world.count(); ++o)
    for (const Vector3d& vertex : run.layout.meshes[o].vertices) {
      const Vector3d place = run.world.state(o).moved(vertex, run.world.reference(o));
      EXPECT_GT(std::min({place.x(), place.y(), place.z(), 1.2 - place.x(), 1.2 - place.y()}), -0.1 * spacing) << o;
    }
}

TEST_F(Pile, GoesOnFromSavedBytesBitForBit) {
  const Case scene = pile(11, scratch);
  Trial whole(scene, 1e-3);
  whole.steps(150);
  const std::vector<char> saved = whole.world.save();
  whole.steps(450);
  Trial rest(scene, 1e-3);
  rest.world.restore(saved);
  rest.taken = 150;
  rest.time = 150 * 1e-3;
  rest.steps(450);
  const std::vector<char> expected = whole.world.save(), found = rest.world.save();
  ASSERT_EQ(found.size(), expected.size());
  EXPECT_EQ(std::memcmp(found.data(), expected.data(), expected.size()), 0);
  EXPECT_LT(whole.world.state(1).position.z(), 0.25) << "nothing has reached the floor, so that the test says little";
}

}  // namespace
}  // namespace wavetank::pile_test

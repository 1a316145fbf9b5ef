#include <iostream>

#include "rigid_fixture.h"

namespace wavetank::collision_shapes_test {
namespace {

constexpr double spacing = 0.05;

class Notch : public ::testing::Test {
 protected:
  /// An L of legs 0.8 m long and 0.3 m thick, its hollow upwards, at the place of a body.
  BodyCase angle() const {
    const std::vector<Vector3d> corners{{0.3, 0, 0.3}, {0.3, 0, 0.8}, {0, 0, 0.8}, {0, 0, 0}, {0.8, 0, 0}, {0.8, 0, 0.3}};
    BodyCase body;
    body.name = "angle";
    MeshSource source;
    source.uri = scratch.write("angle.obj", obj_text(prism_mesh(corners, -0.3, 0.3)));
    source.translation = {1, 1, 0};
    body.shape = source;
    body.motion = Motion::free;
    body.rigid.density = 500;
    return body;
  }
  void drop(int dimensions) const {
    Case scene = dimensions == 2 ? dry_case({3, 0, 2}, spacing) : dry_case({3, 2, 2}, spacing);
    BodyCase body = angle();
    if (dimensions == 2) std::get<MeshSource>(body.shape).translation.y() = 0;
    const Vector3d peg(1.55, dimensions == 2 ? 0.0 : 1.0, 0.6);
    scene.bodies = {body, free_box("peg", peg, {0.3, dimensions == 2 ? 0.0 : 0.3, 0.3})};
    Trial run(scene, 2e-4);
    run.until(0.6);
    // The peg falls into the hollow and lies on the lower leg, not on the hull over both.
    EXPECT_NEAR(run.world.state(2).position.z(), 0.45, 0.1 * spacing);
    EXPECT_NEAR(run.world.state(1).position.z(), run.world.reference(1).z(), 0.1 * spacing);
  }
  const ScratchDirectory scratch;
};

TEST_F(Notch, OfADecompositionIsOpen) {
  const Logged logged;
  drop(3);
  ASSERT_EQ(logged.lines.size(), 1u);
  EXPECT_NE(logged.lines[0].find("body 'angle' is"), std::string::npos) << logged.lines[0];
  EXPECT_NE(logged.lines[0].find("convex parts"), std::string::npos) << logged.lines[0];
  std::cout << logged.lines[0] << "\n";
}

TEST_F(Notch, OfASectionIsOpen) {
  const Logged logged;
  drop(2);
  EXPECT_TRUE(logged.lines.empty()) << "a section falls into convex parts exactly: " << logged.lines[0];
}

TEST_F(Notch, OfAConvexHullIsFilledAndItSaysSo) {
  const Logged logged;
  Case scene = dry_case({3, 2, 2}, spacing);
  scene.bodies = {angle()};
  scene.bodies[0].rigid.collision = CollisionShape::convex_hull;
  const Trial run(scene, 1e-3);
  ASSERT_EQ(logged.lines.size(), 1u);
  // The L has 0.39 m² of section, the triangle between its tips 0.125 m².
  EXPECT_NE(logged.lines[0].find("32.05"), std::string::npos) << logged.lines[0];
}

TEST_F(Notch, OfListedPartsIsOpen) {
  const Logged logged;
  Case scene = dry_case({3, 2, 2}, spacing);
  scene.bodies = {angle(), free_box("peg", {1.55, 1, 0.6}, {0.3, 0.3, 0.3})};
  scene.bodies[0].rigid.collision = CollisionShape::parts;
  for (const Box& box : {Box{{0, -0.3, 0}, {0.8, 0.3, 0.3}}, Box{{0, -0.3, 0.3}, {0.3, 0.3, 0.8}}}) {
    MeshSource part;
    part.uri = scratch.write("part" + std::to_string(scene.bodies[0].rigid.collision_parts.size()) + ".obj",
                             obj_text(box_mesh(box, false, "part")));
    part.translation = {1, 1, 0};
    scene.bodies[0].rigid.collision_parts.push_back(part);
  }
  Trial run(scene, 2e-4);
  run.until(0.6);
  EXPECT_NEAR(run.world.state(2).position.z(), 0.45, 0.1 * spacing);
  ASSERT_EQ(logged.lines.size(), 1u);
  EXPECT_NE(logged.lines[0].find("2 convex parts in contacts, as listed: they lack 0 % of its volume and hold 0 %"), std::string::npos)
      << logged.lines[0];
}

TEST(CollisionShapes, ATanksListedPartsStandForItsWalls) {
  const ScratchDirectory scratch;
  for (const double width : {2.0, 0.0}) {
    Case scene = dry_case({3, width, 2}, spacing);
    const Vector3d middle(1, 0.5 * width, 1);
    scene.bodies = {free_box("peg", middle, {0.3, 0.15 * width, 0.3})};
    scene.tank.rigid.collision = CollisionShape::parts;
    MeshSource deck;  // above the floor
    deck.uri = scratch.write("deck.obj", obj_text(box_mesh({{0, -1, 0}, {3, 1, 0.4}}, false, "deck")));
    deck.translation.y() = 0.5 * width;
    scene.tank.rigid.collision_parts = {deck};
    const Logged logged;
    Trial run(scene, 5e-4);
    run.until(1);
    EXPECT_NEAR(run.world.state(1).position.z(), 0.55, 0.02 * spacing) << "width " << width;
    EXPECT_TRUE(logged.lines.empty()) << logged.lines[0];
    scene.tank.motion = Motion::prescribed;
    scene.tank.rigid.prescribed.ramps = {RampCase{Direction::heave, 0.3, 0, 1}};
    Trial lifted(scene, 5e-4);
    lifted.until(1.5);
    EXPECT_NEAR(lifted.world.state(1).position.z(), 0.85, 0.03 * spacing) << "the parts have not moved with the tank";
  }
}

TEST(CollisionShapes, AFinelyCutRingKeepsItsHole) {
  const ScratchDirectory scratch;
  const Logged logged;
  constexpr int round = 64, across = 40;  // so many triangles that the parts are found on a coarser mesh
  TriangleMesh ring;
  for (int i = 0; i < round; ++i)
    for (int j = 0; j < across; ++j) {
      const double a = 2 * pi * i / round, b = 2 * pi * j / across, radius = 0.5 + 0.2 * std::cos(b);
      ring.vertices.emplace_back(radius * std::cos(a), radius * std::sin(a), 0.2 + 0.2 * std::sin(b));
    }
  const auto at = [&](int i, int j) { return (i % round) * across + j % across; };
  for (int i = 0; i < round; ++i)
    for (int j = 0; j < across; ++j) {
      ring.triangles.emplace_back(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      ring.triangles.emplace_back(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  Case scene = dry_case({2, 2, 2}, spacing);
  BodyCase body = free_box("ring", {1, 1, 0.2}, {1, 1, 0.4});
  MeshSource source;
  source.uri = scratch.write("ring.obj", obj_text(ring));
  source.translation = {1, 1, 0};
  body.shape = source;
  scene.bodies = {body, free_box("peg", {1, 1, 0.7}, {0.3, 0.3, 0.3})};
  Trial run(scene, 5e-4);
  run.until(0.7);
  EXPECT_NEAR(run.world.state(2).position.z(), 0.15, 0.1 * spacing) << "the peg hangs in the hole";
  ASSERT_EQ(logged.lines.size(), 1u);
  std::cout << logged.lines[0] << "\n";
}

}  // namespace
}  // namespace wavetank::collision_shapes_test

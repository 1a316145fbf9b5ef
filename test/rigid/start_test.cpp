// What a world says of bodies that start where they cannot be.
#include "rigid_fixture.h"

namespace wavetank::start_test {
namespace {

constexpr double spacing = 0.05;

/// Two boxes of 0.4 m that touch, on the floor of a tank of 3 m × 2 m × 2 m.
Case touching() {
  Case scene = dry_case({3, 2, 2}, spacing);
  scene.bodies = {free_box("left", {1, 1, 0.2}, {0.4, 0.4, 0.4}), free_box("right", {1.4, 1, 0.2}, {0.4, 0.4, 0.4})};
  return scene;
}

std::vector<std::string> said_of(const Case& scene) {
  const Logged logged;
  const Trial run(scene, 1e-3);
  return logged.lines;
}

TEST(Start, OfBodiesThatTouchIsNothingToTell) { EXPECT_TRUE(said_of(touching()).empty()); }

TEST(Start, InsideEachOtherIsToldWithBothNamesAndTheDepth) {
  Case scene = touching();
  std::get<Box>(scene.bodies[1].shape).min.x() -= 0.02;
  const std::vector<std::string> said = said_of(scene);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NE(said[0].find("body 'left' and body 'right' overlap by 0.02 m"), std::string::npos) << said[0];
  std::get<Box>(scene.bodies[1].shape).min.x() += 0.019;  // a fiftieth of the spacing
  EXPECT_TRUE(said_of(scene).empty());
}

TEST(Start, InTheFloorOrInAFixedBodyIsToldOnceOfTheDeepest) {
  Case scene = touching();
  std::get<Box>(scene.bodies[0].shape).min.z() -= 0.03;
  std::vector<std::string> said = said_of(scene);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NE(said[0].find("body 'left' and the tank overlap by 0.03 m"), std::string::npos) << said[0];
  BodyCase post = free_box("post", {1.78, 1, 0.5}, {0.4, 0.4, 1.0});  // 0.02 m inside the right one
  post.motion = Motion::fixed;
  post.rigid.density.reset();
  scene.bodies.push_back(post);
  said = said_of(scene);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NE(said[0].find("body 'left' and the tank overlap by 0.03 m"), std::string::npos) << said[0];
  std::get<Box>(scene.bodies[0].shape).min.z() += 0.03;
  said = said_of(scene);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NE(said[0].find("body 'right' and body 'post' overlap by 0.02 m"), std::string::npos) << said[0];
}

TEST(Start, WhollyOutsideOfTheTankIsRefused) {
  for (const Vector3d& place : {Vector3d(4, 1, 1), Vector3d(1, -1, 1), Vector3d(1, 1, -0.3), Vector3d(4, 1, 3)}) {
    Case scene = touching();
    scene.bodies[0] = free_box("lost", place, {0.4, 0.4, 0.4});
    const std::string message = error_of([&] { said_of(scene); });
    EXPECT_NE(message.find("body 'lost' is free and starts wholly outside of the tank"), std::string::npos) << message;
    EXPECT_NE(message.find("[0, 0, 0] to [3, 2, 2] m"), std::string::npos) << message;
  }
  Case scene = touching();
  scene.bodies[0] = free_box("dropped", {1, 1, 3}, {0.4, 0.4, 0.4});
  EXPECT_TRUE(said_of(scene).empty()) << "over an open tank it falls in";
  std::get<BoxTank>(scene.tank.shape).closed = true;
  EXPECT_NE(error_of([&] { said_of(scene); }).find("body 'dropped'"), std::string::npos);
  scene.bodies[0] = free_box("arm", {3.4, 1, 1}, {0.4, 0.4, 0.4});
  JointCase joint;
  joint.name = "shoulder";
  joint.child = "arm";
  joint.point = {3.2, 1, 1};
  scene.joints = {joint};
  EXPECT_TRUE(said_of(scene).empty()) << "what a joint holds may be anywhere";
}

TEST(Start, InAPlaneWhollyOutsideOfTheTankIsRefused) {
  Case scene = dry_case({3, 0, 2}, spacing);
  scene.bodies = {free_box("lost", {3.5, 0, 1}, {0.4, 0, 0.4})};
  EXPECT_NE(error_of([&] { said_of(scene); }).find("body 'lost'"), std::string::npos);
  scene.bodies = {free_box("found", {1, 0, 1}, {0.4, 0, 0.4})};
  EXPECT_TRUE(said_of(scene).empty());
}

// The water's walls are all that holds a body: behind a dam up to the rim there are none.
TEST(Start, OverAFloorThatWaterCannotReachIsTold) {
  for (const double width : {2.0, 0.0}) {
    Case scene = dry_case({3, width, 2}, spacing);
    BodyCase dam = free_box("dam", {1.5, 0.5 * width, 1}, {0.1, width, 2});
    dam.motion = Motion::fixed;
    dam.rigid.density.reset();
    scene.bodies = {free_box("dry", {2.2, 0.5 * width, 0.4}, {0.4, 0.5 * width, 0.4}), dam};
    const std::vector<std::string> said = said_of(scene);
    ASSERT_EQ(said.size(), 1u);
    EXPECT_NE(said[0].find("body 'dry'"), std::string::npos) << said[0];
    EXPECT_NE(said[0].find("water can reach"), std::string::npos) << said[0];
    scene.bodies[0] = free_box("dry", {0.8, 0.5 * width, 0.4}, {0.4, 0.5 * width, 0.4});
    EXPECT_TRUE(said_of(scene).empty());
    scene.tank.motion = Motion::free;
    scene.tank.rigid.mass = 50;
    scene.tank.rigid.centre_of_mass = Vector3d(1.5, 0.5 * width, 1);
    scene.tank.rigid.inertia = {40, 50, 60, 0, 0, 0};
    EXPECT_TRUE(said_of(scene).empty()) << "a free tank's floor holds as well";
  }
}

}  // namespace
}  // namespace wavetank::start_test

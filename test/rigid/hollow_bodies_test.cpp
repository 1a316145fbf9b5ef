// Crates, cups, boats and housings in contacts: what falls into a hollow lies on its floor, and what a cavity holds stays in it.
#include <Eigen/Geometry>
#include <utility>

#include "rigid_fixture.h"

namespace wavetank::hollow_bodies_test {
namespace {

constexpr double spacing = 0.05;

void append(TriangleMesh& to, const TriangleMesh& from, bool turned = false) {
  const int first = static_cast<int>(to.vertices.size());
  to.vertices.insert(to.vertices.end(), from.vertices.begin(), from.vertices.end());
  for (Vector3i triangle : from.triangles) {
    if (turned) std::swap(triangle[1], triangle[2]);
    to.triangles.push_back(triangle + Vector3i::Constant(first));
  }
}

/// A profile of radii and heights, anticlockwise with the radius to the right, turned about the z axis.
TriangleMesh turned_profile(const std::vector<std::pair<double, double>>& profile, int facets) {
  TriangleMesh mesh;
  std::vector<std::vector<int>> rings;
  for (const auto& [radius, height] : profile) {
    rings.emplace_back();
    for (int i = 0; i < facets; ++i) {
      if (radius > 0 || i == 0)
        mesh.vertices.emplace_back(radius * std::cos(2 * pi * i / facets), radius * std::sin(2 * pi * i / facets), height);
      rings.back().push_back(static_cast<int>(mesh.vertices.size()) - 1);
    }
  }
  for (std::size_t k = 0; k < rings.size(); ++k) {
    const std::vector<int>&low = rings[k], &high = rings[(k + 1) % rings.size()];
    for (int i = 0; i < facets; ++i) {
      const int next = (i + 1) % facets;
      if (low[i] != low[next]) mesh.triangles.emplace_back(low[i], low[next], high[next]);
      if (high[i] != high[next]) mesh.triangles.emplace_back(low[i], high[next], high[i]);
    }
  }
  return mesh;
}

/// A box with an opening from above: its outer and its inner half size, and the heights of its floor, of the floor within and of its rim.
TriangleMesh crate_mesh(const Vector3d& outer, const Vector3d& inner, double floor, double height) {
  TriangleMesh mesh;
  for (const double z : {0.0, height})
    for (const auto& [x, y] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) mesh.vertices.emplace_back(x * outer.x(), y * outer.y(), z);
  for (const double z : {floor, height})
    for (const auto& [x, y] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) mesh.vertices.emplace_back(x * inner.x(), y * inner.y(), z);
  const auto add = [&](int a, int b, int c, int d) {
    mesh.triangles.emplace_back(a, b, c);
    mesh.triangles.emplace_back(a, c, d);
  };
  add(3, 2, 1, 0);
  add(8, 9, 10, 11);
  for (int k = 0; k < 4; ++k) {
    const int next = (k + 1) % 4;
    add(k, next, 4 + next, 4 + k);
    add(8 + next, 8 + k, 12 + k, 12 + next);
    add(4 + k, 4 + next, 12 + next, 12 + k);
  }
  return mesh;
}

class HollowBody : public ::testing::Test {
 protected:
  BodyCase body(const std::string& name, const TriangleMesh& mesh, const Vector3d& place) const {
    BodyCase result = free_box(name, Vector3d::Zero(), Vector3d::Ones());
    MeshSource source;
    source.uri = scratch.write(name + ".obj", obj_text(mesh));
    source.translation = place;
    result.shape = source;
    return result;
  }
  /// Where a ball of radius 0.05 m comes to rest that falls into a body on the floor.
  Vector3d rest(const TriangleMesh& mesh, const Vector3d& from, Motion motion = Motion::free) const {
    Case scene = dry_case({2, 2, 2}, spacing);
    scene.bodies = {body("hollow", mesh, {1, 1, 0}), free_box("ball", from, Vector3d::Ones())};
    scene.bodies[0].motion = motion;
    MeshSource ball;
    ball.uri = "shape://sphere?radius=0.05";
    ball.translation = from;
    scene.bodies[1].shape = ball;
    scene.bodies[1].rigid.density = 3000;
    scene.bodies[0].rigid.density = 2000;
    scene.bodies[1].rigid.friction = scene.bodies[0].rigid.friction = 0.5;
    Trial run(scene, 5e-4);
    run.until(0.8);
    EXPECT_NEAR(run.world.state(1).position.z(), run.world.reference(1).z(), 0.05 * spacing) << "the hollow body has moved";
    return run.world.state(2).position;
  }
  const ScratchDirectory scratch;
};

TEST_F(HollowBody, ACratesFloorHolds) {
  // A ball of 24 facets lies up to 1.5 % of its radius lower than a true one; each contact overlaps by 0.01 of the spacing.
  EXPECT_NEAR(rest(crate_mesh({0.2, 0.2, 0}, {0.17, 0.17, 0}, 0.03, 0.2), {1, 1, 0.3}).z(), 0.08, 0.05 * spacing);
}

TEST_F(HollowBody, ACratesFloorHoldsHoweverItIsTriangulated) {
  TriangleMesh mesh = crate_mesh({0.2, 0.2, 0}, {0.17, 0.17, 0}, 0.03, 0.2);
  for (int cut = 0; cut < 2; ++cut) {
    std::vector<Vector3i> finer;
    for (const Vector3i& t : mesh.triangles) {  // in three, about a point of their own
      mesh.vertices.push_back((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3);
      const int middle = static_cast<int>(mesh.vertices.size()) - 1;
      for (int k = 0; k < 3; ++k) finer.emplace_back(t[k], t[(k + 1) % 3], middle);
    }
    mesh.triangles = finer;
  }
  EXPECT_NEAR(rest(mesh, {1, 1, 0.3}).z(), 0.08, 0.05 * spacing);
}

TEST_F(HollowBody, ACupsFloorHolds) {
  const std::vector<std::pair<double, double>> cup{{0, 0}, {0.2, 0}, {0.2, 0.3}, {0.18, 0.3}, {0.18, 0.02}, {0, 0.02}};
  EXPECT_NEAR(rest(turned_profile(cup, 24), {1, 1, 0.4}).z(), 0.07, 0.05 * spacing);
}

TEST_F(HollowBody, ABoatsFloorHoldsOffTheMiddle) {
  EXPECT_NEAR(rest(crate_mesh({0.5, 0.2, 0}, {0.45, 0.17, 0}, 0.04, 0.2), {1.25, 1, 0.3}).z(), 0.09, 0.05 * spacing);
}

TEST_F(HollowBody, ACavityIsFilledInContactsFromOutside) {
  const Logged logged;
  TriangleMesh housing = box_mesh({{-0.2, -0.15, 0}, {0.2, 0.15, 0.2}}, false, "");
  append(housing, box_mesh({{-0.19, -0.14, 0.01}, {0.19, 0.14, 0.19}}, false, ""), true);
  EXPECT_NEAR(rest(housing, {1, 1, 0.4}).z(), 0.25, 0.05 * spacing);
  for (const std::string& line : logged.lines) EXPECT_EQ(line.find("hollow"), std::string::npos) << line;  // it is its hull exactly
}

TEST_F(HollowBody, WhatIsInACavityStaysInIt) {
  TriangleMesh housing = box_mesh({{-0.2, -0.15, 0}, {0.2, 0.15, 0.4}}, false, "");
  append(housing, box_mesh({{-0.19, -0.14, 0.01}, {0.19, 0.14, 0.39}}, false, ""), true);
  for (const Motion motion : {Motion::free, Motion::fixed, Motion::commanded})
    EXPECT_NEAR(rest(housing, {1, 1, 0.2}, motion).z(), 0.06, 0.05 * spacing) << "motion " << static_cast<int>(motion);
  TriangleMesh globe = turned_profile({{0, 0}, {0.2, 0}, {0.2, 0.4}, {0, 0.4}}, 24);
  append(globe, turned_profile({{0, 0.02}, {0.15, 0.02}, {0.15, 0.38}, {0, 0.38}}, 24), true);
  EXPECT_NEAR(rest(globe, {1, 1, 0.2}).z(), 0.07, 0.05 * spacing);
}

TEST_F(HollowBody, WhatDoesNotFallIntoPartsThatHoldTheSameIsRefused) {
  // A thin bowl, round all over: a hundred thousand parts would be wanted.
  constexpr int steps = 40;
  std::vector<std::pair<double, double>> bowl;
  for (int k = 0; k <= steps; ++k)
    bowl.emplace_back(k == 0 ? 0.0 : 0.5 * std::sin(0.5 * pi * k / steps), 0.5 - 0.5 * std::cos(0.5 * pi * k / steps));
  for (int k = steps; k >= 0; --k)
    bowl.emplace_back(k == 0 ? 0.0 : 0.498 * std::sin(0.5 * pi * k / steps), 0.5 - 0.498 * std::cos(0.5 * pi * k / steps));
  Case scene = dry_case({2, 2, 2}, spacing);
  scene.bodies = {body("bowl", turned_profile(bowl, 60), {1, 1, 0})};
  const Layout layout = lay_out(scene);
  const std::string error = error_of([&] { RigidWorld(scene, layout); });
  EXPECT_NE(error.find("body 'bowl'"), std::string::npos) << error;
  EXPECT_NE(error.find("collision_parts"), std::string::npos) << error;
}

}  // namespace
}  // namespace wavetank::hollow_bodies_test

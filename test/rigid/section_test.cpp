// What stands for a mesh's section in 2-D.
#include "../../src/rigid/section.h"

#include <iostream>

#include "rigid_fixture.h"

namespace wavetank::section_test {
namespace {

constexpr int slices = 1000;
constexpr double hollow = 0.9;  // m, its radius
const double area = 2 - 0.5 * pi * hollow * hollow;

/// A block of 2 m × 1 m with a half-round hollow in its top, cut into many slices from left to right.
TriangleMesh trough() {
  TriangleMesh mesh;
  const auto top = [](double x) { return 1 - std::sqrt(std::max(hollow * hollow - x * x, 0.0)); };
  for (int k = 0; k <= slices; ++k) {
    const double x = -1 + 2.0 * k / slices;
    for (const double y : {-0.1, 0.1}) {
      mesh.vertices.emplace_back(x, y, 0);
      mesh.vertices.emplace_back(x, y, top(x));
    }
  }
  const auto quad = [&](int a, int b, int c, int d) {
    mesh.triangles.emplace_back(a, b, c);
    mesh.triangles.emplace_back(a, c, d);
  };
  for (int k = 0; k < slices; ++k) {
    const int here = 4 * k, next = here + 4;  // front below, front above, back below, back above
    quad(here, next, next + 1, here + 1);
    quad(here + 2, here + 3, next + 3, next + 2);
    quad(here, here + 2, next + 2, next);
    quad(here + 1, next + 1, next + 3, here + 3);
  }
  quad(0, 1, 3, 2);
  const int last = 4 * slices;
  quad(last, last + 2, last + 3, last + 1);
  return mesh;
}

TEST(Section, OfManySlicesKeepsItsHollow) {
  double sum = 0;
  const std::vector<std::vector<Vector3d>> polygons = convex_polygons(trough());
  for (const std::vector<Vector3d>& polygon : polygons)
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Vector3d &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
      sum += 0.5 * (a.x() * b.z() - b.x() * a.z());
    }
  std::cout << polygons.size() << " polygons hold " << 100 * (sum / area - 1) << " % more than the section\n";
  EXPECT_GT(sum, (1 - 1e-4) * area);  // the slices' own chords lack 1e-6 or so
  EXPECT_LT(sum, (1 + 1.1e-3) * area);
  EXPECT_LT(polygons.size(), 100u);
}

TEST(Section, SaysByHowMuchItIsApproximated) {
  const ScratchDirectory scratch;
  const Logged logged;
  Case scene = dry_case({4, 0, 3}, 0.05);
  BodyCase body = free_box("trough", {2, 0, 0.6}, {2, 0, 1});
  MeshSource source;
  source.uri = scratch.write("trough.obj", obj_text(trough()));
  source.translation = {2, 0, 0.1};
  body.shape = source;
  scene.bodies = {body};
  const Trial run(scene, 1e-3);
  ASSERT_EQ(logged.lines.size(), 1u);
  std::cout << logged.lines[0] << "\n";
  EXPECT_NE(logged.lines[0].find("body 'trough' is"), std::string::npos) << logged.lines[0];
  EXPECT_NE(logged.lines[0].find("they lack 0 % of its area and hold 0.0"), std::string::npos) << logged.lines[0];
}

TEST(Section, OfListedPartsIsComparedToo) {
  const ScratchDirectory scratch;
  const Logged logged;
  Case scene = dry_case({4, 0, 3}, 0.05);
  scene.bodies = {free_box("block", {2, 0, 0.5}, {1, 0, 0.8})};
  scene.bodies[0].rigid.collision = CollisionShape::parts;
  MeshSource part;  // its left half, and as much again above that
  part.uri = scratch.write("part.obj", obj_text(box_mesh({{1.5, -0.1, 0.1}, {2, 0.1, 1.7}}, false, "part")));
  scene.bodies[0].rigid.collision_parts = {part};
  const Trial run(scene, 1e-3);
  ASSERT_EQ(logged.lines.size(), 1u);
  EXPECT_NE(logged.lines[0].find("they lack 50 % of its area and hold 50 % more"), std::string::npos) << logged.lines[0];
}

}  // namespace
}  // namespace wavetank::section_test

// Convex hulls of what comes from files: rounded to single precision, and very finely cut.
#include "../../src/rigid/convex_hull.h"

#include <algorithm>
#include <iostream>
#include <random>

#include "../../src/rigid/collision_shapes.h"
#include "rigid_fixture.h"

namespace wavetank::convex_hull_test {
namespace {

/// A cylinder of diameter and height 1 m about the origin, of 64 sides, in 5 rings.
TriangleMesh cylinder() {
  constexpr int sides = 64, rings = 5;
  TriangleMesh mesh;
  for (int ring = 0; ring <= rings; ++ring)
    for (int side = 0; side < sides; ++side) {
      const double angle = 2 * pi * side / sides;
      mesh.vertices.emplace_back(0.5 * std::cos(angle), 0.5 * std::sin(angle), 1.0 * ring / rings - 0.5);
    }
  for (int side = 0; side < sides; ++side) {
    const int next = (side + 1) % sides, top = rings * sides;
    for (int ring = 0; ring < top; ring += sides) {
      mesh.triangles.emplace_back(ring + side, ring + next, ring + next + sides);
      mesh.triangles.emplace_back(ring + side, ring + next + sides, ring + side + sides);
    }
    if (side == 0 || next == 0) continue;
    mesh.triangles.emplace_back(0, next, side);
    mesh.triangles.emplace_back(top, top + side, top + next);
  }
  return mesh;
}

/// By how much a face's plane cuts off what the hull holds, m.
double cut_off_by_planes(const ConvexHull& hull) {
  double depth = 0;
  for (const ConvexHull::Face& face : hull.faces)
    for (const Vector3d& vertex : hull.vertices) depth = std::max(depth, face.normal.dot(vertex) - face.offset);
  return depth;
}

// Ten metres from its file's origin a body of one metre is rounded by half of 1e-6 of its size, and in the case it may lie anywhere.
TEST(ConvexHull, OfAFileFarFromItsOriginHasItsFacesPlanes) {
  const ScratchDirectory scratch;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> part;
    const Quaterniond turn = Quaterniond(part(random), part(random), part(random), part(random)).normalized();
    for (const double distance : {0.0, 1.0, 10.0, 100.0}) {
      TriangleMesh mesh = cylinder();
      for (Vector3d& vertex : mesh.vertices) vertex = turn * vertex + Vector3d::Constant(distance);
      MeshSource source;
      source.uri = scratch.write("cylinder.obj", obj_text(mesh));
      source.translation = Vector3d::Constant(-distance);
      const TriangleMesh read = read_mesh(source, "", {});
      RigidCase rigid;
      rigid.collision = CollisionShape::convex_hull;
      ShapeRequest request;
      request.rigid = &rigid;
      request.mesh = &read;
      request.source = &source;
      request.spacing = 0.1;
      request.what = "the cylinder";
      const std::vector<ConvexPart> parts = make_shape(request, "", {});
      ASSERT_EQ(parts.size(), 1u);
      // At 100 m the file holds the corners to 4e-6 m each, and planes through neighbours tilt by that over their distance.
      EXPECT_LT(cut_off_by_planes(parts[0].hull), distance < 50 ? 1e-4 : 1e-3)
          << "seed " << seed << ", " << distance << " m from the origin";
      EXPECT_NEAR(parts[0].hull.volume, 0.25 * 32 * std::sin(2 * pi / 64), 1e-3) << "seed " << seed << ", " << distance << " m";
    }
  }
}

TEST(ConvexHull, OfVeryManyCornersIsThinnedAndItSaysSo) {
  const ScratchDirectory scratch;
  const Logged logged;
  constexpr int round = 200, rings = 100;
  constexpr double radius = 0.5, spacing = 0.1;
  TriangleMesh ball;
  for (int ring = 1; ring < rings; ++ring)
    for (int k = 0; k < round; ++k) {
      const double polar = pi * ring / rings, angle = 2 * pi * k / round;
      ball.vertices.emplace_back(radius * Vector3d(std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle), std::cos(polar)));
    }
  const int north = static_cast<int>(ball.vertices.size()), south = north + 1, last = (rings - 2) * round;
  ball.vertices.emplace_back(0, 0, radius);
  ball.vertices.emplace_back(0, 0, -radius);
  for (int k = 0; k < round; ++k) {
    const int next = (k + 1) % round;
    for (int ring = 0; ring < last; ring += round) {
      ball.triangles.emplace_back(ring + k, ring + round + k, ring + round + next);
      ball.triangles.emplace_back(ring + k, ring + round + next, ring + next);
    }
    ball.triangles.emplace_back(north, k, next);
    ball.triangles.emplace_back(south, last + next, last + k);
  }
  Case scene = dry_case({2, 2, 2}, spacing);
  BodyCase body = free_box("ball", {1, 1, radius}, {1, 1, 1});
  MeshSource source;
  source.uri = scratch.write("ball.obj", obj_text(ball));
  source.translation = {1, 1, radius};
  body.shape = source;
  scene.bodies = {body};
  Trial run(scene, 5e-4);
  ASSERT_EQ(logged.lines.size(), 1u);
  std::cout << logged.lines[0] << "\n";
  EXPECT_NE(logged.lines[0].find("body 'ball'"), std::string::npos);
  EXPECT_NE(logged.lines[0].find("% less than the body"), std::string::npos);
  run.until(0.2);
  EXPECT_NEAR(run.world.state(1).position.z(), radius, 0.03 * spacing) << "it lies on the floor to the tolerance and the slop";
}

}  // namespace
}  // namespace wavetank::convex_hull_test

// Two links that turn about a hinge in which both end: what is seen of their walls is the surface of both together, whatever the angle.
#include "../../src/sph/hidden_walls.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "../common/box_case.h"

namespace wavetank::hidden_walls_test {
namespace {

constexpr double spacing = 0.04;

Vector3d hinge(int dimensions) { return {0.5, dimensions == 2 ? 0.0 : 0.3, 0.6}; }

/// Bars of 0.4 m × 0.1 m × 0.1 m, each with its end about the hinge. They hang on a joint, or pass through each other.
Case bars(int dimensions, double turn, Motion motion, bool joined) {
  Case scene = box_case(Vector3d(1.2, dimensions == 2 ? 0.0 : 0.6, 1), 0.1, spacing);
  scene.dimensions = dimensions;
  scene.numerics.walls.elements = WallElements::semi_analytical;
  for (int bar = 0; bar < 2; ++bar) {
    MeshSource source;
    source.uri = "shape://box?size=0.4,0.1,0.1";
    source.rotation = {0, bar == 0 ? 0.0 : turn, 0};
    const Vector3d from_hinge(bar == 0 ? -0.15 : 0.15, 0, bar == 0 ? 0.0 : 0.013);
    source.translation = hinge(dimensions) + Eigen::AngleAxisd(source.rotation.y(), Vector3d::UnitY()) * from_hinge;
    BodyCase body;
    body.name = bar == 0 ? "upper" : "lower";
    body.shape = source;
    body.motion = motion;
    body.rigid.density = 500;
    scene.bodies.push_back(body);
  }
  JointCase joint;
  joint.name = "elbow";
  joint.parent = "upper";
  joint.child = "lower";
  joint.point = hinge(dimensions);
  if (joined) scene.joints = {joint};
  return scene;
}

struct Seen {
  double area = 0;
  Vector3d flux = Vector3d::Zero();
};

Seen seen(const std::vector<Facet>& facets, const std::vector<WallPose>& poses, int dimensions) {
  Seen sum;
  for (const Facet& facet : facets) {
    if (facet.owner == 0) continue;
    const Vector3d a = facet.corners[1] - facet.corners[0], b = facet.corners[2] - facet.corners[0];
    const double area = dimensions == 2 ? a.norm() : 0.5 * a.cross(b).norm();
    sum.area += area;
    sum.flux += area * (poses[facet.owner].rotation * facet.normal);
  }
  return sum;
}

std::vector<Facet> in_sight(const Layout& layout, const HiddenWalls& hidden, const std::vector<WallPose>& poses) {
  std::vector<Facet> facets;
  for (const int s : hidden.facets_in_sight(poses)) {
    const std::size_t f = s, whole = layout.facets.size();
    facets.push_back(f < whole ? layout.facets[f] : layout.pieces[f - whole].shape);
  }
  return facets;
}

std::vector<Facet> triangles_in_sight(const Layout& layout, const HiddenWalls& hidden, const std::vector<WallPose>& poses) {
  std::vector<Facet> triangles;
  for (const Facet& triangle : layout.triangles)
    if (!hidden.hides(triangle, poses)) triangles.push_back(triangle);
  return triangles;
}

TEST(HiddenWalls, OfLinksThatTurnInEachOtherLeaveTheSurfaceOfBoth) {
  for (const int dimensions : {2, 3})
    for (const bool joined : {true, false}) {
      const Layout moved = lay_out(bars(dimensions, 0, joined ? Motion::free : Motion::commanded, joined));
      const HiddenWalls hidden(moved, dimensions);
      ASSERT_EQ(moved.intruding.size(), 2u);
      for (const double turn : {0.0, 0.3, 0.7, 1.2}) {
        const Layout standing = lay_out(bars(dimensions, turn, Motion::fixed, false));
        std::vector<WallPose> poses(3);
        for (std::size_t o = 1; o < 3; ++o) poses[o].rest = poses[o].place = hinge(dimensions);
        poses[2].rotation = Eigen::AngleAxisd(turn, Vector3d::UnitY()).toRotationMatrix();
        const double exact = seen(standing.facets, std::vector<WallPose>(3), dimensions).area;
        // Along the seam, of four sides, pieces of half a spacing are seen or hidden whole: half of one each on either side at worst.
        const double seam = dimensions == 2 ? 4 * 0.25 * spacing : 0.4 * 0.25 * spacing;
        const Seen facets = seen(in_sight(moved, hidden, poses), poses, dimensions);
        const Seen triangles = seen(triangles_in_sight(moved, hidden, poses), poses, dimensions);
        EXPECT_NEAR(facets.area, exact, seam) << dimensions << "-D, turned by " << turn;
        EXPECT_LT(facets.flux.norm(), seam) << dimensions << "-D, turned by " << turn;
        EXPECT_NEAR(triangles.area, exact, 2 * seam) << dimensions << "-D, turned by " << turn << ", triangles";
      }
    }
}

TEST(HiddenWalls, WhatOnlyTouchesOrKeepsApartStaysWhole) {
  for (const double gap : {0.0, 0.01}) {
    Case scene = box_case({1, 0.6, 0.9}, 0.1, spacing);
    for (int k = 0; k < 2; ++k) {
      BodyCase body;
      body.name = k == 0 ? "sill" : "gate";
      body.shape = k == 0 ? Box{{0.3, 0.1, 0.2}, {0.7, 0.5, 0.3}} : Box{{0.4, 0.2, 0.3 + gap}, {0.6, 0.4, 0.7}};
      body.motion = k == 0 ? Motion::fixed : Motion::prescribed;
      scene.bodies.push_back(body);
    }
    EXPECT_TRUE(lay_out(scene).intruding.empty()) << gap;
  }
}

}  // namespace
}  // namespace wavetank::hidden_walls_test

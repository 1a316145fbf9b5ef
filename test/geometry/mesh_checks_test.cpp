#include <algorithm>

#include "geometry_fixture.h"

namespace wavetank::mesh_checks_test {
namespace {

const Box unit_cube{Vector3d::Zero(), Vector3d::Ones()};

TriangleMesh cube(bool open_top = false) { return box_mesh(unit_cube, open_top, "cube"); }

TEST(BoxMesh, IsWoundOutwards) {
  EXPECT_NEAR(cube().signed_volume(), 1.0, 1e-15);
  EXPECT_EQ(cube().triangles.size(), 12u);
  EXPECT_EQ(cube(true).triangles.size(), 10u);
  EXPECT_NEAR(surface_area(cube(true)), 5.0, 1e-15);
  TriangleMesh open = cube(true);
  for (std::size_t t = 0; t < open.triangles.size(); ++t) {
    EXPECT_LT(std::min({open.corner(t, 0).z(), open.corner(t, 1).z(), open.corner(t, 2).z()}), 0.5) << "a triangle of the top is left";
  }
}

TEST(SignedVolume, KeepsItsDigitsFarFromTheOrigin) {
  const Vector3d far(1e6, -1e6, 1e6);
  EXPECT_NEAR(box_mesh({far, far + Vector3d(1, 2, 3)}, false, "far").signed_volume(), 6.0, 1e-8);
}

TEST(CentreOfVolume, OfAWedgeFarAway) {
  // A right prism over the triangle (0,0) (3,0) (0,3) in x-z, 1 deep: its centre is a third along.
  TriangleMesh wedge;
  const Vector3d far(1000, -2000, 500);
  for (const double y : {0.0, 1.0})
    for (const Vector3d& corner : {Vector3d(0, y, 0), Vector3d(3, y, 0), Vector3d(0, y, 3)}) wedge.vertices.push_back(far + corner);
  wedge.triangles = {{0, 1, 2}, {3, 5, 4}, {0, 3, 1}, {1, 3, 4}, {1, 4, 2}, {2, 4, 5}, {2, 5, 0}, {0, 5, 3}};
  EXPECT_LT((wedge.centre_of_volume() - far - Vector3d(1.0, 0.5, 1.0)).norm(), 1e-9);
}

TEST(CentreOfVolume, OfAFlatMeshIsTheMiddleOfItsBox) {
  TriangleMesh flat;
  flat.vertices = {{0, 0, 0}, {2, 0, 0}, {0, 4, 0}};
  flat.triangles = {{0, 1, 2}};
  EXPECT_LT((flat.centre_of_volume() - Vector3d(1, 2, 0)).norm(), 1e-12);
}

TEST(CheckSurface, RefusesEmptyAndDegenerate) {
  TriangleMesh mesh;
  mesh.name = "hull";
  EXPECT_ERROR(check_surface(mesh), "'hull' has no triangles");
  mesh.vertices = {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(2, 0, 0)};
  mesh.triangles = {Vector3i(0, 1, 2), Vector3i(0, 0, 1)};
  EXPECT_ERROR(check_surface(mesh), "zero area");
}

TEST(CheckSurface, AcceptsAnEdgeOfThreeTriangles) {
  TriangleMesh mesh;
  mesh.name = "baffle";
  mesh.vertices = {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, -1, 0), Vector3d(0, 0, 1)};
  mesh.triangles = {Vector3i(0, 1, 2), Vector3i(0, 1, 3), Vector3i(0, 1, 4)};
  check_surface(mesh);
  EXPECT_EQ(mesh.triangles.size(), 3u);
  EXPECT_ERROR(check_closed(mesh), "'baffle' is not closed");
}

/// Unit cubes at whole numbers, with common vertices where they touch. Of two that share a face across y or x the face's diagonals differ.
class TouchingSolids : public GeometryTest {
 protected:
  TriangleMesh cubes(const std::vector<Vector3d>& places) const {
    TriangleMesh mesh;
    for (const Vector3d& place : places) append(mesh, box_mesh({place, place + Vector3d::Ones()}, false, ""));
    return mesh;
  }
  /// With equal vertices merged, as of a file.
  TriangleMesh welded(const TriangleMesh& mesh) const { return read_mesh(source(write("solids.obj", mesh)), "", {}); }
};

TEST_F(TouchingSolids, AlongAnEdgeOrAFaceEncloseTheirVolume) {
  const std::vector<std::vector<Vector3d>> arrangements = {
      {{0, 0, 0}, {1, 1, 0}},                                  // an edge
      {{0, 0, 0}, {0, 0, 1}},                                  // a face of common triangles
      {{0, 0, 0}, {0, 1, 0}},                                  // a face of two pairs of triangles
      {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}},                       // three in a row
      {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}},                       // three about an edge
      {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {1, 0, 1}},            // four about an edge
      {{0, 0, 0}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}},            // every two along an edge
      {{0, 0, 0}, {1, 1, 1}},                                  // a corner
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}}  // faces of both kinds
  };
  for (const bool inverted : {false, true}) {
    for (const std::vector<Vector3d>& places : arrangements) {
      SCOPED_TRACE(std::to_string(&places - arrangements.data()) + (inverted ? ", wound inwards" : ""));
      TriangleMesh mesh = cubes(places);
      if (inverted) std::for_each(mesh.triangles.begin(), mesh.triangles.end(), [](Vector3i& t) { std::swap(t[0], t[1]); });
      mesh = welded(mesh);
      check_closed(mesh);
      EXPECT_NEAR(mesh.signed_volume(), static_cast<double>(places.size()), 1e-9);
      for (const Vector3d& place : places) EXPECT_TRUE(inside(mesh, place + Vector3d(0.5, 0.4, 0.3)));
      EXPECT_FALSE(inside(mesh, Vector3d(0.5, 1.5, 0.4)) && places.size() == 3);
    }
  }
}

TEST_F(TouchingSolids, WhatPartsThemGoes) {
  TriangleMesh mesh = welded(cubes({{0, 0, 0}, {0, 0, 1}, {0, 0, 2}}));
  check_closed(mesh);
  EXPECT_EQ(mesh.triangles.size(), 2u + 2 + 3 * 8);
  EXPECT_NEAR(surface_area(mesh), 14, 1e-12);
}

TEST_F(TouchingSolids, ABulkheadInABodyGoesWhateverItsWinding) {
  for (int mask = 0; mask < 16384; mask += 57) {
    TriangleMesh mesh = cubes({{0, 0, 0}, {0, 0, 1}});
    mesh = welded(mesh);
    ASSERT_EQ(mesh.triangles.size(), 22u);
    for (int t = 0; t < 22; ++t) {
      if (mask >> (t % 14) & 1) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    }
    check_closed(mesh);
    EXPECT_EQ(mesh.triangles.size(), 20u) << mask;
    EXPECT_NEAR(mesh.signed_volume(), 2, 1e-9) << mask;
  }
}

TEST_F(TouchingSolids, BricksKeepTheSpaceBetweenThem) {
  std::vector<Vector3d> places;
  for (int k = 0; k < 27; ++k) {
    if (k != 13) places.emplace_back(k % 3, k / 3 % 3, k / 9);
  }
  TriangleMesh mesh = welded(cubes(places));
  check_closed(mesh);
  EXPECT_NEAR(mesh.signed_volume(), 26, 1e-9);
  EXPECT_FALSE(inside(mesh, Vector3d(1.5, 1.5, 1.5)));
  EXPECT_TRUE(inside(mesh, Vector3d(0.5, 1.5, 1.4)));
}

TEST_F(TouchingSolids, ABlockInACrateIsNoCavity) {
  // The walls of the crate are 1 thick; the block fills a corner of it and has no vertex in common with it.
  TriangleMesh mesh = cubes({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 0, 1}, {2, 0, 1}});
  append(mesh, box_mesh({Vector3d(1, 0.25, 1), Vector3d(1.5, 0.75, 1.5)}, false, ""));
  mesh = welded(mesh);
  check_closed(mesh);
  EXPECT_NEAR(mesh.signed_volume(), 5.125, 1e-9);
}

TEST_F(TouchingSolids, RefusesOnesThatLieUponEachOther) {
  // A second cube over half of the first, from the same edge on: two pairs of triangles lie upon each other, wound alike.
  TriangleMesh mesh = cubes({{0, 0, 0}});
  append(mesh, box_mesh({Vector3d::Zero(), Vector3d(0.5, 1, 0.5)}, false, ""));
  mesh = welded(mesh);
  EXPECT_ERROR(check_closed(mesh), "'solids.obj' has no clear inside: triangles lie upon each other at the edge from (0, ");
}

TEST(CheckClosed, RefusesAnOpenBodyAndSaysWhere) {
  TriangleMesh mesh = cube(true);
  EXPECT_ERROR(check_closed(mesh), "'cube' is not closed");
  const std::string message = error_of([&] { check_closed(mesh); });
  EXPECT_NE(message.find(", 1)"), std::string::npos) << "an edge of the open top has z = 1: " << message;
}

TEST(CheckClosed, TurnsAnInvertedBodyOutwards) {
  TriangleMesh mesh = cube();
  for (Vector3i& t : mesh.triangles) std::swap(t[0], t[1]);
  EXPECT_NEAR(mesh.signed_volume(), -1.0, 1e-15);
  check_closed(mesh);
  EXPECT_NEAR(mesh.signed_volume(), 1.0, 1e-15);
}

TEST(CheckClosed, RepairsEveryMixtureOfWindings) {
  for (int mask = 0; mask < 4096; mask += 7) {
    TriangleMesh mesh = cube();
    for (int t = 0; t < 12; ++t) {
      if (mask >> t & 1) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    }
    check_closed(mesh);
    EXPECT_NEAR(mesh.signed_volume(), 1.0, 1e-15) << mask;
  }
}

TEST(CheckClosed, TurnsEachPartOnItsOwn) {
  TriangleMesh mesh = cube();
  for (Vector3i& t : mesh.triangles) std::swap(t[0], t[1]);
  append(mesh, box_mesh({Vector3d(2, 0, 0), Vector3d(3, 1, 1)}, false, ""));
  check_closed(mesh);
  EXPECT_NEAR(mesh.signed_volume(), 2.0, 1e-12);
}

TEST(CheckClosed, KeepsACavity) {
  for (const bool inverted : {false, true}) {
    TriangleMesh cavity = box_mesh({Vector3d::Constant(0.25), Vector3d::Constant(0.75)}, false, "");
    if (inverted) std::for_each(cavity.triangles.begin(), cavity.triangles.end(), [](Vector3i& t) { std::swap(t[0], t[1]); });
    TriangleMesh mesh = cube();
    append(mesh, cavity);
    check_closed(mesh);
    EXPECT_NEAR(mesh.signed_volume(), 1.0 - 0.125, 1e-12);
    EXPECT_FALSE(inside(mesh, Vector3d::Constant(0.5)));
    EXPECT_TRUE(inside(mesh, Vector3d::Constant(0.1)));
  }
}

/// A prism over a figure of eight, whose lobes differ: where it crosses itself the smaller one comes out inside out.
TEST(CheckClosed, RefusesASurfaceThatTurnsInsideOut) {
  const double eight[4][2] = {{0, 0}, {3, 1}, {3, 0}, {0, 2}};  // (x, z); the first and third sides cross
  TriangleMesh mesh;
  mesh.name = "eight";
  for (const double y : {0.0, 1.0}) {
    for (const auto& p : eight) mesh.vertices.emplace_back(p[0], y, p[1]);
  }
  for (int k = 0; k < 4; ++k) {
    const int n = (k + 1) % 4;
    mesh.triangles.emplace_back(k, n, n + 4);
    mesh.triangles.emplace_back(k, n + 4, k + 4);
  }
  mesh.triangles.insert(mesh.triangles.end(), {Vector3i(0, 2, 1), Vector3i(0, 3, 2), Vector3i(4, 5, 6), Vector3i(4, 6, 7)});
  EXPECT_ERROR(check_closed(mesh), "'eight' is turned inside out about");
}

TEST(CheckClosed, RefusesAMoebiusBandOfABody) {
  TriangleMesh mesh;  // the projective plane on six vertices: closed, but without two sides
  mesh.name = "cross cap";
  mesh.vertices = {Vector3d(0, 0, 0),     Vector3d(1, 0, 0.1), Vector3d(0.3, 1, 0),
                   Vector3d(0.2, 0.1, 1), Vector3d(1, 1, 0.7), Vector3d(0.4, 0.9, 1.3)};
  mesh.triangles = {Vector3i(0, 1, 2), Vector3i(0, 2, 3), Vector3i(0, 3, 4), Vector3i(0, 4, 5), Vector3i(0, 5, 1),
                    Vector3i(1, 2, 4), Vector3i(2, 3, 5), Vector3i(3, 4, 1), Vector3i(4, 5, 2), Vector3i(5, 1, 3)};
  EXPECT_ERROR(check_closed(mesh), "cannot be wound consistently");
}

TEST(CheckClosed, RefusesABodyWithoutVolume) {
  TriangleMesh mesh;  // a sheet with two sides
  mesh.name = "sheet";
  mesh.vertices = {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(1, 1, 0), Vector3d(0, 1, 0)};
  mesh.triangles = {Vector3i(0, 1, 2), Vector3i(0, 2, 3), Vector3i(0, 3, 1), Vector3i(1, 3, 2)};
  EXPECT_ERROR(check_closed(mesh), "without volume");
}

TEST(CheckClosed, KeepsABodyClosedWhenACollinearTriangleGoes) {
  TriangleMesh mesh = cube();
  // The bottom's diagonal gets a point in its middle on one side only, and a triangle of zero area that fills the crack.
  const Vector3i first = mesh.triangles[0], second = mesh.triangles[1];  // (a, b, c), (a, c, d)
  const int a = first[0], b = first[1], c = first[2], middle = 8;
  ASSERT_EQ(second[0], a);
  ASSERT_EQ(second[1], c);
  mesh.vertices.push_back(0.5 * (mesh.vertices[a] + mesh.vertices[c]));
  mesh.triangles[0] = Vector3i(a, b, middle);
  mesh.triangles.emplace_back(middle, b, c);
  mesh.triangles.emplace_back(a, middle, c);
  check_closed(mesh);
  EXPECT_EQ(mesh.triangles.size(), 14u);
  EXPECT_NEAR(mesh.signed_volume(), 1.0, 1e-12);
}

TEST(Inside, HoldsUpToTheSurface) {
  const TriangleMesh mesh = cube();
  EXPECT_TRUE(inside(mesh, Vector3d::Constant(0.5)));
  for (const double near : {1e-3, 1e-6, 1e-9}) {
    EXPECT_TRUE(inside(mesh, Vector3d(near, near, near)));
    EXPECT_TRUE(inside(mesh, Vector3d(0.5, 0.5, 1 - near)));
    EXPECT_FALSE(inside(mesh, Vector3d(-near, 0.5, 0.5)));
    EXPECT_FALSE(inside(mesh, Vector3d(1 + near, 1 + near, 1 + near)));
    EXPECT_FALSE(inside(mesh, Vector3d(0.5, 0.5, 1 + near)));
  }
}

TEST(Distance, ToFaceEdgeAndCorner) {
  const TriangleMesh mesh = cube();
  EXPECT_NEAR(distance(mesh, Vector3d(0.3, 0.6, 1.25)), 0.25, 1e-15);
  EXPECT_NEAR(distance(mesh, Vector3d(0.3, 0.6, 0.9)), 0.1, 1e-15);
  EXPECT_NEAR(distance(mesh, Vector3d(1.3, 1.4, 0.5)), 0.5, 1e-15);
  EXPECT_NEAR(distance(mesh, Vector3d(-1, -2, -2)), 3.0, 1e-15);
}

}  // namespace
}  // namespace wavetank::mesh_checks_test

#include <map>
#include <utility>

#include "geometry_fixture.h"

namespace wavetank::shape_mesh_test {
namespace {

// The meshes are made in double precision and scaled by one factor: a few hundred roundings of 1e-16.
constexpr double rounding = 1e-13;

TriangleMesh shape(const std::string& uri) { return read_mesh(source(uri), "", ResourceResolver()); }

/// Every edge once in each direction: closed and wound alike.
void expect_closed(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, int> edges;
  for (const Vector3i& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
  }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1) << edge.first << " " << edge.second;
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1u) << edge.first << " " << edge.second;
  }
}

/// Least and greatest distance of a sphere's surface from its centre.
std::pair<double, double> extremes(const TriangleMesh& mesh) {
  double greatest = 0;
  for (const Vector3d& vertex : mesh.vertices) greatest = std::max(greatest, vertex.norm());
  return {distance(mesh, Vector3d::Zero()), greatest};
}

TEST(ShapeMesh, BoxHasItsSizeAboutTheOrigin) {
  const TriangleMesh mesh = shape("shape://box?size=0.2,0.5,1e-1");
  expect_closed(mesh);
  EXPECT_EQ(mesh.triangles.size(), 12u);
  EXPECT_NEAR(mesh.signed_volume(), 0.01, 0.01 * rounding);
  EXPECT_EQ(mesh.bounding_box().min, Vector3d(-0.1, -0.25, -0.05));
  EXPECT_EQ(mesh.bounding_box().max, Vector3d(0.1, 0.25, 0.05));
}

TEST(ShapeMesh, SphereIsClosedAndHasItsVolume) {
  for (const int facets : {8, 12, 48, 512}) {
    SCOPED_TRACE(facets);
    TriangleMesh mesh = shape("shape://sphere?radius=0.3&facets=" + std::to_string(facets));
    expect_closed(mesh);
    check_closed(mesh);
    EXPECT_EQ(mesh.triangles.size(), static_cast<std::size_t>(facets) * facets / 2);
    const double volume = 4 * M_PI / 3 * 0.027;
    EXPECT_NEAR(mesh.signed_volume(), volume, volume * 100 * rounding);  // a sum of up to 1e5 terms
    EXPECT_LT(mesh.centre_of_volume().norm(), 0.3 * 100 * rounding);
  }
}

TEST(ShapeMesh, SphereOfTheUsualFinenessIsRound) {
  const auto [least, greatest] = extremes(shape("shape://sphere?radius=1"));
  EXPECT_GT(least, 1 - 0.015);  // what the documentation says
  EXPECT_LT(greatest, 1 + 0.015);
  EXPECT_GT(greatest, 1);  // its volume cannot be the true one otherwise
}

TEST(ShapeMesh, CylinderIsClosedAndHasItsVolume) {
  for (const int facets : {8, 48, 512}) {
    SCOPED_TRACE(facets);
    TriangleMesh mesh = shape("shape://cylinder?radius=0.3&length=2&facets=" + std::to_string(facets));
    expect_closed(mesh);
    check_closed(mesh);
    EXPECT_EQ(mesh.triangles.size(), 4u * facets);
    EXPECT_NEAR(mesh.signed_volume(), M_PI * 0.09 * 2, M_PI * 0.18 * rounding);
    EXPECT_EQ(mesh.bounding_box().min.z(), -1);
    EXPECT_EQ(mesh.bounding_box().max.z(), 1);
  }
}

TEST(ShapeMesh, CylinderOfTheUsualFinenessIsRound) {
  const TriangleMesh mesh = shape("shape://cylinder?radius=1&length=9");
  double greatest = 0;
  for (const Vector3d& vertex : mesh.vertices) greatest = std::max(greatest, vertex.head<2>().norm());
  EXPECT_LT(greatest, 1 + 0.006);  // what the documentation says
  EXPECT_GT(distance(mesh, Vector3d::Zero()), 1 - 0.006);
  EXPECT_GT(greatest, 1);
}

TEST(ShapeMesh, IsScaledThenRotatedThenTranslated) {
  MeshSource from = source("shape://cylinder?radius=0.5&length=4&facets=8");
  from.scale = Vector3d::Constant(0.5);
  from.rotation = Vector3d(0, M_PI / 2, 0);  // its axis from z to x
  from.translation = Vector3d(10, 20, 30);
  const Box box = read_mesh(from, "", ResourceResolver()).bounding_box();
  EXPECT_NEAR(box.min.x(), 9, 1e-12);
  EXPECT_NEAR(box.max.x(), 11, 1e-12);
  // An octagon of the circle's area: its corners' radius by r² · 2√2 = π 0.25².
  EXPECT_NEAR(box.max.z() - 30, 0.25 * std::sqrt(M_PI / (2 * std::sqrt(2))), 1e-12);
}

TEST(ShapeMesh, MakesATankAndABody) {
  Case scene = box_case(Vector3d(1, 1, 1), 0.5, 0.1);
  scene.tank.shape = source("shape://box?size=1,1,1");
  BodyCase ball;
  ball.name = "ball";
  ball.shape = source("shape://sphere?radius=0.2");
  ball.motion = Motion::free;
  ball.rigid.density = 500;
  scene.bodies = {ball};
  scene.fluid.fill = {Box{Vector3d(-0.5, -0.5, -0.5), Vector3d(0.5, 0.5, -0.2)}};
  const Layout layout = lay_out(scene);
  EXPECT_EQ(layout.particles.size(), 300u);  // 10 × 10 × 3, of which the ball takes none
  EXPECT_NEAR(layout.meshes.at(1).signed_volume(), 4 * M_PI / 3 * 0.008, 1e-12);
}

struct Wrong {
  const char* uri;
  const char* reason;
};

TEST(ShapeMesh, RefusesWhatIsNoShape) {
  const Wrong wrongs[] = {
      {"shape://cone?radius=1", "there is no such shape; write shape://box?size=X,Y,Z, shape://sphere"},
      {"shape://", "there is no such shape"},
      {"shape://Box?size=1,1,1", "there is no such shape"},
      {"shape://sphere", "radius is missing; it must be given (m)"},
      {"shape://sphere?radius=", "radius is missing"},
      {"shape://sphere?radius=0", "radius is '0'; it must be a number greater than 0 (m)"},
      {"shape://sphere?radius=-1", "radius is '-1'"},
      {"shape://sphere?radius=nan", "radius is 'nan'"},
      {"shape://sphere?radius=1e999", "radius is '1e999'"},
      {"shape://sphere?radius=1m", "radius is '1m'"},
      {"shape://sphere?radius= 1", "radius is ' 1'"},
      {"shape://sphere?radius=1&radius=2", "radius is given twice; give it once"},
      {"shape://sphere?radius=1&length=2", "'length' is no property of it; it has radius, facets"},
      {"shape://sphere?radius", "'radius' is not of the form NAME=VALUE"},
      {"shape://sphere?radius=1&facets=10", "facets is '10'; it must be a multiple of 4 from 8 to 512"},
      {"shape://sphere?radius=1&facets=4", "facets is '4'"},
      {"shape://sphere?radius=1&facets=1e9", "facets is '1e9'"},
      {"shape://cylinder?radius=1", "length is missing"},
      {"shape://cylinder?radius=1&length=0", "length is '0'"},
      {"shape://box?size=1,2", "size is '1,2'; it must be X,Y,Z, three numbers greater than 0 (m)"},
      {"shape://box?size=1,2,3,4", "size is '1,2,3,4'"},
      {"shape://box?size=1,2,3,", "size is '1,2,3,'"},
      {"shape://box?size=1,,3", "size is '1,,3'"},
      {"shape://box?size=1,0,3", "size is '1,0,3'"},
      {"shape://box?size=1,2,3&facets=8", "'facets' is no property of it; it has size"},
  };
  for (const Wrong& wrong : wrongs) {
    SCOPED_TRACE(wrong.uri);
    EXPECT_ERROR(shape(wrong.uri), std::string("mesh '") + wrong.uri + "': " + wrong.reason);
  }
}

TEST(ShapeMesh, RefusesAPlacementWithoutEnd) {
  MeshSource from = source("shape://sphere?radius=1e200");
  from.scale = Vector3d::Constant(1e200);
  EXPECT_ERROR(read_mesh(from, "", ResourceResolver()), "its scale, rotation or translation makes vertices that are not finite numbers");
}

}  // namespace
}  // namespace wavetank::shape_mesh_test

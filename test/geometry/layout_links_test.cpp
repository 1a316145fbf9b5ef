// Walls of links that lie inside, through or flush with others: what is left is the surface of them all.
#include <Eigen/Geometry>

#include "geometry_fixture.h"

namespace wavetank::layout_links_test {
namespace {

constexpr double spacing = 0.05;

struct Links {
  std::string what;
  std::vector<Box> boxes;
  double area = 0, volume = 0;             ///< of all together, m², m³
  double section_length = 0, section = 0;  ///< of the section with y = 0, m, m²
};

/// A hull of 0.8 m × 0.4 m × 0.3 m and what is fixed to it.
std::vector<Links> all_links() {
  const Box hull{{0, -0.2, 0}, {0.8, 0.2, 0.3}};
  const double area = 2 * (0.8 * 0.4 + 0.8 * 0.3 + 0.4 * 0.3), volume = 0.8 * 0.4 * 0.3;
  const Box inside{{0.55, -0.1, 0.1}, {0.75, 0.1, 0.2}}, through{{0.3, -0.05, -0.2}, {0.5, 0.05, 0.6}},
      beside{{0.8, -0.1, 0.05}, {1.03, 0.1, 0.15}}, mast{{0.2, -0.1, 0.2}, {0.3, 0.1, 0.7}}, across{{0.3, -0.5, 0}, {0.53, 0.5, 0.3}},
      flush{{0.3, -0.2, 0.1}, {1.1, 0.2, 0.3}};
  return {{"inside", {hull, inside}, area, volume, 2.2, 0.24},
          {"through", {hull, through}, area - 2 * 0.02 + 0.5 * 0.6 + 2 * 0.02, volume + 0.01, 2.2 + 1.0, 0.24 + 0.1},
          {"flush beside", {hull, beside}, area + 0.6 * 0.23, volume + 0.2 * 0.1 * 0.23, 2.2 + 0.46, 0.24 + 0.023},
          {"standing in it", {hull, mast}, area + 0.6 * 0.4, volume + 0.02 * 0.4, 2.2 + 0.8, 0.24 + 0.04},
          {"crossing in one plane", {hull, across}, area + 4 * 0.3 * 0.3 + 4 * 0.3 * 0.23, volume + 2 * 0.3 * 0.3 * 0.23, 2.2, 0.24},
          {"flush with three sides", {hull, flush}, area + 2 * 0.3 * 0.2 + 2 * 0.3 * 0.4, volume + 0.3 * 0.2 * 0.4, 2.2 + 0.6, 0.24 + 0.06},
          {"three of them", {hull, inside, mast}, area + 0.6 * 0.4, volume + 0.02 * 0.4, 2.2 + 0.8, 0.24 + 0.04}};
}

Case links_case(const Links& links, int dimensions, Motion motion, double tilt, WallElements elements) {
  Case result;
  result.dimensions = dimensions;
  result.numerics.walls.elements = elements;
  BoxTank tank;
  tank.origin = {-0.3, dimensions == 2 ? 0.0 : -0.7, -0.4};
  tank.size = {1.8, dimensions == 2 ? 0.0 : 1.4, 1.3};
  result.tank.shape = tank;
  result.fluid.spacing = spacing;
  result.fluid.fill = {Box{tank.origin, tank.origin + Vector3d(0.1, dimensions == 2 ? 0.0 : 0.1, 0.1)}};
  for (std::size_t b = 0; b < links.boxes.size(); ++b) {
    BodyCase body;
    body.name = "link" + std::to_string(b);
    Box box = links.boxes[b];
    if (dimensions == 2) box.min.y() = box.max.y() = 0;
    body.shape = box;
    if (tilt != 0) {
      const Vector3d size = box.max - box.min, middle = 0.5 * (box.min + box.max);
      MeshSource source;
      source.uri = "shape://box?size=" + std::to_string(size.x()) + "," + std::to_string(size.y()) + "," + std::to_string(size.z());
      source.rotation = {0, tilt, 0};
      source.translation = Eigen::AngleAxisd(tilt, Vector3d::UnitY()) * middle;
      body.shape = source;
    }
    body.motion = motion;
    body.rigid.density = 500;
    result.bodies.push_back(body);
    if (b == 0) continue;
    JointCase joint;
    joint.name = "joint" + std::to_string(b);
    joint.type = JointType::fixed;
    joint.parent = "link0";
    joint.child = body.name;
    if (motion == Motion::free) result.joints.push_back(joint);
  }
  return result;
}

struct Sums {
  double area = 0, volume = 0;
  Vector3d flux = Vector3d::Zero();
};

template <class Walls>
Sums facet_sums(const Walls& facets, int dimensions) {
  Sums sums;
  for (const Facet& facet : facets) {
    if (facet.owner == 0) continue;
    const Vector3d a = facet.corners[1] - facet.corners[0], b = facet.corners[2] - facet.corners[0];
    const double area = dimensions == 2 ? a.norm() : 0.5 * a.cross(b).norm();
    sums.area += area;
    sums.flux += area * facet.normal;
    sums.volume -= area * facet.normal.dot(facet.plane_point) / dimensions;
  }
  return sums;
}

void expect_surface(const Sums& sums, double area, double volume, const std::string& what) {
  EXPECT_NEAR(sums.area, area, 1e-5) << what;
  EXPECT_NEAR(sums.volume, volume, 1e-5) << what;
  EXPECT_LT(sums.flux.norm(), 1e-5) << what;
}

TEST(LayoutLinks, ThatAreFixedToEachOtherHaveTheSurfaceOfAll) {
  for (const Links& links : all_links())
    for (const Motion motion : {Motion::free, Motion::fixed})
      for (const double tilt : {0.0, 0.3})
        for (const int dimensions : {3, 2}) {
          if (dimensions == 2 && tilt != 0) continue;
          const Layout layout = lay_out(links_case(links, dimensions, motion, tilt, WallElements::semi_analytical));
          const std::string what = links.what + (motion == Motion::free ? ", free, " : ", fixed, ") + std::to_string(dimensions) +
                                   "-D, tilt " + std::to_string(tilt);
          const double area = dimensions == 2 ? links.section_length : links.area, volume = dimensions == 2 ? links.section : links.volume;
          expect_surface(facet_sums(layout.facets, dimensions), area, volume, what + ", facets");
          expect_surface(facet_sums(layout.triangles, dimensions), area, volume, what + ", triangles");
          Sums walls;
          for (const WallElement& wall : layout.walls) {
            if (wall.owner == 0) continue;
            walls.area += wall.area;
            walls.flux += wall.area * wall.normal;
            walls.volume -= wall.area * wall.normal.dot(wall.centre) / dimensions;
          }
          expect_surface(walls, area, volume, what + ", elements");
        }
}

using SolidsOfOneMesh = GeometryTest;
TEST_F(SolidsOfOneMesh, HaveTheSurfaceOfAll) {
  for (const Links& links : all_links())
    for (const int dimensions : {3, 2}) {
      if (links.what == "inside" || links.what == "three of them") continue;  // in one mesh that is a cavity
      Case checked = links_case({links.what, {}, 0, 0, 0, 0}, dimensions, Motion::free, 0, WallElements::semi_analytical);
      TriangleMesh mesh;
      for (const Box& box : links.boxes) append(mesh, box_mesh(box, false, ""));
      MeshSource source;
      source.uri = write("links.obj", mesh);
      BodyCase body;
      body.name = "links";
      body.shape = source;
      body.motion = Motion::free;
      body.rigid.density = 500;
      checked.bodies = {body};
      const Layout layout = lay_out(checked);
      const std::string what = links.what + ", " + std::to_string(dimensions) + "-D";
      const double area = dimensions == 2 ? links.section_length : links.area, volume = dimensions == 2 ? links.section : links.volume;
      expect_surface(facet_sums(layout.facets, dimensions), area, volume, what + ", facets");
      expect_surface(facet_sums(layout.triangles, dimensions), area, volume, what + ", triangles");
    }
}

TEST(LayoutLinks, WhollyInsideHaveNoWallsAndTheHullKeepsItsOwn) {
  const Layout layout = lay_out(links_case(all_links().front(), 3, Motion::free, 0, WallElements::facet));
  for (const Facet& facet : layout.facets) EXPECT_NE(facet.owner, 2);
  const Links alone{"alone", {all_links().front().boxes.front()}, 0, 0, 0, 0};
  EXPECT_EQ(layout.facets.size(), lay_out(links_case(alone, 3, Motion::free, 0, WallElements::facet)).facets.size());
}

}  // namespace
}  // namespace wavetank::layout_links_test

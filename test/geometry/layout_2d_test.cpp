#include "geometry_fixture.h"

namespace wavetank::layout_2d_test {
namespace {

class Layout2d : public GeometryTest {};

TEST_F(Layout2d, ABoxTankIsThreeLines) {
  const Layout layout = lay_out(box_case(Vector3d(0.9, 0, 0.508), 0.092, 0.0092));
  EXPECT_NEAR(sums_of(layout, 0).area, 0.9 + 2 * 0.508, 1e-12);
  EXPECT_EQ(layout.walls.size(), 98u + 2 * 55);
  EXPECT_EQ(layout.particles.size(), 98u * 10);
  EXPECT_NEAR(total(layout.volumes), 0.9 * 0.092, 1e-12);
  EXPECT_EQ(layout.lid.size(), 98u);
  for (const WallElement& wall : layout.walls) {
    EXPECT_EQ(wall.centre.y(), 0);
    EXPECT_LT(wall.normal.dot(Vector3d(0.45, 0, 0.25) - wall.centre), 0);
    EXPECT_NEAR(wall.normal.dot(wall.tangent), 0, 1e-12);
    EXPECT_NEAR(wall.normal.y(), 0, 1e-15);
    EXPECT_NEAR(wall.tangent.y(), 0, 1e-15);
  }
  for (const WallElement& element : layout.lid) EXPECT_NEAR(element.area, 0.9 / 98, 1e-12);
  for (const Vector3d& p : layout.particles) EXPECT_EQ(p.y(), 0);
  EXPECT_EQ(layout.domain.min.y(), 0);
  EXPECT_EQ(layout.domain.max.y(), 0);
  EXPECT_TRUE(layout.domain.max.isApprox(Vector3d(0.9, 0, 0.508)));
}

TEST_F(Layout2d, AMeshIsCutByThePlane) {
  Case checked;
  checked.dimensions = 2;
  checked.tank.shape = source(write("tank.obj", box_mesh({Vector3d(0, -0.3, 0), Vector3d(2, 0.5, 1)}, true, "")));
  checked.fluid.spacing = 0.05;
  checked.fluid.fill = {FloodFill{Vector3d(0.5, 7, 0.1), 0.4}};  // the seed's y does not matter
  const Layout layout = lay_out(checked);
  EXPECT_NEAR(sums_of(layout, 0).area, 4.0, 1e-6);
  EXPECT_EQ(layout.walls.size(), 80u);
  EXPECT_NEAR(total(layout.volumes), 0.8, 1e-6);
  EXPECT_EQ(layout.meshes[0].triangles.size(), 10u);
}

TEST_F(Layout2d, AMeshWithAFaceOnThePlaneIsCut) {
  for (const double side : {-0.5, 0.5}) {
    Case checked;
    checked.dimensions = 2;
    checked.tank.shape =
        source(write("tank.obj", box_mesh({Vector3d(0, std::min(0.0, side), 0), Vector3d(2, std::max(0.0, side), 1)}, true, "")));
    checked.fluid.spacing = 0.05;
    checked.fluid.fill = {Box{Vector3d(0, 0, 0), Vector3d(2, 0, 0.4)}};
    EXPECT_NEAR(sums_of(lay_out(checked), 0).area, 4.0, 1e-6) << side;
  }
}

TEST_F(Layout2d, RefusesAMeshBesideThePlane) {
  Case checked = box_case(Vector3d(1, 0, 0.5), 0.4, 0.05);
  BodyCase body;
  body.name = "cube";
  body.shape = source(write("cube.obj", box_mesh({Vector3d(0.4, 0.1, 0.1), Vector3d(0.5, 0.3, 0.2)}, false, "")));
  checked.bodies = {body};
  EXPECT_ERROR(lay_out(checked), "body 'cube': mesh 'cube.obj' does not meet the plane y = 0");
}

TEST_F(Layout2d, ABodyIsClosedEmptyAndFacesItsInside) {
  for (const bool mesh : {false, true}) {
    Case checked = box_case(Vector3d(1, 0, 0.5), 0.4, 0.02);
    BodyCase body;
    body.name = "box";
    const Box box{Vector3d(0.3, mesh ? -0.1 : 0, 0.1), Vector3d(0.6, mesh ? 0.2 : 0, 0.25)};
    if (mesh) {
      body.shape = source(write("box.obj", box_mesh(box, false, "")));
    } else {
      body.shape = box;
    }
    checked.bodies = {body};
    const Layout layout = lay_out(checked);
    const OwnerSums sums = sums_of(layout, 1);
    EXPECT_NEAR(sums.area, 0.9, 1e-6);
    EXPECT_LT(sums.flux.norm(), 1e-6);
    EXPECT_NEAR(sums.divergence, -2 * 0.3 * 0.15, 1e-6);
    EXPECT_GT(total(layout.volumes), 0.35 - 0.3 * 0.01);
    for (const Vector3d& p : layout.particles) {
      EXPECT_FALSE(p.x() > 0.3 && p.x() < 0.6 && p.z() > 0.1 && p.z() < 0.25) << p.transpose();
    }
  }
}

TEST_F(Layout2d, SolidsThatTouchAlongAnEdgeAreClosed) {
  Case checked = box_case(Vector3d(1, 0, 0.5), 0.4, 0.02);
  TriangleMesh mesh = box_mesh({Vector3d(0.3, -0.1, 0.1), Vector3d(0.4, 0.1, 0.2)}, false, "");
  append(mesh, box_mesh({Vector3d(0.4, -0.1, 0.2), Vector3d(0.5, 0.1, 0.3)}, false, ""));
  append(mesh, box_mesh({Vector3d(0.3, -0.1, 0.3), Vector3d(0.4, 0.1, 0.35)}, false, ""));
  BodyCase body;
  body.name = "steps";
  body.shape = source(write("steps.obj", mesh));
  checked.bodies = {body};
  const Layout layout = lay_out(checked);
  const OwnerSums sums = sums_of(layout, 1);
  EXPECT_NEAR(sums.area, 2 * 0.4 + 0.3, 1e-6);
  EXPECT_LT(sums.flux.norm(), 1e-6);
  EXPECT_NEAR(sums.divergence, -2 * 0.025, 1e-6);
  EXPECT_NEAR(total(layout.volumes), 0.4 - 0.025, 1e-3);
}

TEST_F(Layout2d, ABodyFarOutOfTheTankIsSampledInItOnly) {
  Case checked = box_case(Vector3d(1, 0, 0.5), 0.4, 0.02);
  BodyCase body;
  body.name = "beam";
  body.shape = Box{Vector3d(0.3, 0, 0.1), Vector3d(1e5, 0, 0.2)};
  checked.bodies = {body};
  const Layout layout = lay_out(checked);
  EXPECT_NEAR(sums_of(layout, 1).area, 2 * 0.7 + 0.1, 1e-4);
  EXPECT_LT(sums_of(layout, 1).count, 80);
}

TEST_F(Layout2d, ABoxOnTheFloorUncoversItsFootprint) {
  Case checked = box_case(Vector3d(1, 0, 0.5), 0.4, 0.02);
  BodyCase body;
  body.name = "box";
  body.shape = Box{Vector3d(0.307, 0, 0), Vector3d(0.493, 0, 0.2)};
  checked.bodies = {body};
  const Layout layout = lay_out(checked);
  EXPECT_NEAR(sums_of(layout, 0).area, 1 + 1 - 0.186, 1e-9);
  EXPECT_NEAR(sums_of(layout, 1).area, 0.186 + 0.4, 1e-9);
}

TEST_F(Layout2d, ARoundBodyOfShortSegmentsGetsElementsOfTheSpacing) {
  Case checked = box_case(Vector3d(1, 0, 1), 0.9, 0.02);
  BodyCase body;
  body.name = "cylinder";
  MeshSource sphere = source(repository_mesh("sphere.stl"));
  sphere.scale = Vector3d::Constant(0.4);
  sphere.translation = Vector3d(0.5, 0.001, 0.5);
  body.shape = sphere;
  checked.bodies = {body};
  const Layout layout = lay_out(checked);
  const OwnerSums sums = sums_of(layout, 1);
  EXPECT_NEAR(sums.area, 2 * M_PI * 0.2, 0.01);
  EXPECT_LT(sums.flux.norm(), 1e-9);
  EXPECT_LT(sums.count, 150);
  for (const WallElement& wall : layout.walls) {
    if (wall.owner == 1) EXPECT_GT(wall.normal.dot((Vector3d(0.5, 0, 0.5) - wall.centre).normalized()), 0.95);
  }
}

TEST_F(Layout2d, RefusesALeakAndAProbeInABody) {
  Case checked;
  checked.dimensions = 2;
  TriangleMesh tank = box_mesh({Vector3d(0, -1, 0), Vector3d(2, 1, 1)}, true, "");
  TriangleMesh open;
  open.vertices = tank.vertices;
  for (std::size_t t = 0; t < tank.triangles.size(); ++t) {
    if (tank.corner(t, 0).x() + tank.corner(t, 1).x() + tank.corner(t, 2).x() > 0) open.triangles.push_back(tank.triangles[t]);
  }
  checked.tank.shape = source(write("open.obj", open));
  checked.fluid.spacing = 0.05;
  checked.fluid.fill = {Box{Vector3d(1, 0, 0), Vector3d(2, 0, 0.5)}};
  EXPECT_ERROR(lay_out(checked), "leaks out of the tank near (0, 0, ");

  Case probe = box_case(Vector3d(1, 0, 0.5), 0.4, 0.02);
  BodyCase body;
  body.name = "box";
  body.shape = Box{Vector3d(0.3, 0, 0), Vector3d(0.5, 0, 0.2)};
  probe.bodies = {body};
  probe.instruments.pressure_probes = {{"P1", Vector3d(0.4, 0, 0.1)}};
  EXPECT_ERROR(lay_out(probe), "lies inside body 'box'");
  probe.instruments.pressure_probes = {{"P1", Vector3d(0.5, 0, 0.1)}};
  EXPECT_NO_THROW(lay_out(probe));
}

}  // namespace
}  // namespace wavetank::layout_2d_test

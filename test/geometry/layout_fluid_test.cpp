#include <algorithm>

#include "geometry_fixture.h"

namespace wavetank {
namespace {

class LayoutFluid : public GeometryTest {
 protected:
  MeshSource tank_with(const TriangleMesh& more) const {
    TriangleMesh tank = box_mesh({Vector3d::Zero(), Vector3d(1, 0.5, 0.5)}, true, "");
    append(tank, more);
    return source(write("tank.obj", tank));
  }
  Case flood_case(const MeshSource& tank, const Vector3d& seed, double level) const {
    Case checked;
    checked.tank.shape = tank;
    checked.fluid.spacing = 0.05;
    checked.fluid.fill = {FloodFill{seed, level}};
    return checked;
  }
};

TriangleMesh plate(double x, double y0, double y1, double z0, double z1) {
  TriangleMesh mesh;
  mesh.vertices = {Vector3d(x, y0, z0), Vector3d(x, y1, z0), Vector3d(x, y1, z1), Vector3d(x, y0, z1)};
  mesh.triangles = {Vector3i(0, 1, 2), Vector3i(0, 2, 3)};
  return mesh;
}

BodyCase box_body(const std::string& name, const Vector3d& low, const Vector3d& high) {
  BodyCase body;
  body.name = name;
  body.shape = Box{low, high};
  return body;
}

TEST_F(LayoutFluid, ABoxIsFilledToItsExactVolume) {
  Case checked = box_case(Vector3d(1.03, 0.51, 0.7), 0.33, 0.05);
  const Layout layout = lay_out(checked);
  EXPECT_EQ(layout.particles.size(), 21u * 10 * 7);
  EXPECT_NEAR(total(layout.volumes), 1.03 * 0.51 * 0.33, 1e-12);
  EXPECT_EQ(layout.spacing, 0.05);
  EXPECT_EQ(layout.levels.size(), layout.particles.size());
  for (std::size_t p = 0; p < layout.particles.size(); ++p) {
    EXPECT_EQ(layout.levels[p], 0.33);
    EXPECT_GT(layout.particles[p].minCoeff(), 0.02);
    EXPECT_LT(layout.particles[p].z(), 0.33);
  }
  EXPECT_TRUE(layout.domain.max.isApprox(Vector3d(1.03, 0.51, 0.7)));
}

TEST_F(LayoutFluid, TheLidClosesTheFreeSurfaceOnly) {
  const Layout layout = lay_out(box_case(Vector3d(1, 0.5, 0.7), 0.3, 0.05));
  ASSERT_EQ(layout.lid.size(), 200u);
  for (const WallElement& element : layout.lid) {
    EXPECT_NEAR(element.centre.z(), 0.3, 1e-12);
    EXPECT_NEAR(element.normal.z(), 1, 1e-12);
    EXPECT_NEAR(element.area, 0.0025, 1e-12);
  }
}

TEST_F(LayoutFluid, ADamBreakColumnAlsoHasALidOnItsOpenSide) {
  Case checked = box_case(Vector3d(2, 0.5, 1), 0.5, 0.05);
  checked.fluid.fill = {Box{Vector3d::Zero(), Vector3d(0.5, 0.5, 0.5)}};
  const Layout layout = lay_out(checked);
  EXPECT_EQ(layout.lid.size(), 200u);  // a hundred on top, a hundred towards the dry bed
  // With the walls about the column the lid closes it: walls inside the column's bounds and lid together have no net area vector.
  Vector3d sum = Vector3d::Zero();
  for (const WallElement& element : layout.lid) sum += element.area * element.normal;
  for (const WallElement& wall : layout.walls) {
    if (wall.centre.x() < 0.5 && wall.centre.z() < 0.5) sum += wall.area * wall.normal;
  }
  EXPECT_LT(sum.norm(), 1e-9);
}

TEST_F(LayoutFluid, NoLidBetweenFillsThatTouch) {
  Case checked = box_case(Vector3d(1, 0.5, 0.7), 0.3, 0.05);
  checked.fluid.fill = {Box{Vector3d(0, 0, 0), Vector3d(0.52, 0.5, 0.3)}, Box{Vector3d(0.52, 0, 0), Vector3d(1, 0.5, 0.3)}};
  const Layout layout = lay_out(checked);
  EXPECT_NEAR(total(layout.volumes), 0.15, 1e-12);
  for (const WallElement& element : layout.lid) EXPECT_NEAR(element.normal.z(), 1, 1e-12);
}

TEST_F(LayoutFluid, SpacingFromTheNumberOfParticles) {
  Case checked = box_case(Vector3d(1, 0.5, 0.7), 0.4, 0.05);
  checked.fluid.spacing.reset();
  checked.fluid.particles = 5000;
  const Layout box = lay_out(checked);
  EXPECT_NEAR(box.spacing, std::cbrt(0.2 / 5000), 1e-3);
  EXPECT_NEAR(static_cast<double>(box.particles.size()), 5000, 500);
  checked.tank.shape = source(repository_mesh("cylinder_tank.stl"));
  checked.fluid.fill = {FloodFill{Vector3d(0, 0, 0.1), 0.5}};
  EXPECT_NEAR(static_cast<double>(lay_out(checked).particles.size()), 5000, 500);
}

TEST_F(LayoutFluid, ObstaclesStayEmpty) {
  for (const bool flood : {false, true}) {
    Case checked = box_case(Vector3d(1, 0.5, 0.5), 0.4, 0.05);
    if (flood) checked.fluid.fill = {FloodFill{Vector3d(0.1, 0.1, 0.1), 0.4}};
    checked.bodies = {box_body("box", Vector3d(0.3, 0.2, 0.1), Vector3d(0.6, 0.4, 0.3))};
    const Layout layout = lay_out(checked);
    EXPECT_NEAR(total(layout.volumes), 0.2 - 0.3 * 0.2 * 0.2, 1e-9);
    for (const Vector3d& p : layout.particles) EXPECT_GT(distance(layout.meshes[1], p), 0.02);
    for (const WallElement& element : layout.lid) EXPECT_NEAR(element.centre.z(), 0.4, 1e-9) << "no lid at an obstacle";
  }
}

TEST_F(LayoutFluid, ParticlesOnAnObstaclesSurfaceAreLeftOut) {
  Case checked = box_case(Vector3d(1, 0.5, 0.5), 0.4, 0.05);
  checked.bodies = {box_body("box", Vector3d(0.325, 0.225, 0.125), Vector3d(0.575, 0.375, 0.275))};  // its faces lie on lattice planes
  const Layout layout = lay_out(checked);
  for (const Vector3d& p : layout.particles) EXPECT_GT(distance(layout.meshes[1], p), 0.049);
}

TEST_F(LayoutFluid, ParticlesKeepOffCurvedWalls) {
  Case checked = flood_case(source(repository_mesh("sphere.stl")), Vector3d(0, 0, -0.3), 0.2);
  const Layout layout = lay_out(checked);
  const double depth = 0.7, exact = M_PI * depth * depth * (0.5 - depth / 3);
  EXPECT_NEAR(total(layout.volumes) / exact, 1, 0.03);
  for (const Vector3d& p : layout.particles) EXPECT_GT(distance(layout.meshes[0], p), 0.05 * 0.05 * 0.999);
}

TEST_F(LayoutFluid, AFloodFillsABoxExactly) {
  const Layout layout = lay_out(flood_case(tank_with(TriangleMesh()), Vector3d(0.513, 0.207, 0.033), 0.31));
  EXPECT_NEAR(total(layout.volumes), 0.155, 1e-6);
  for (const double level : layout.levels) EXPECT_EQ(level, 0.31);
}

TEST_F(LayoutFluid, AFloodStopsAtAThinPlate) {
  const Layout layout = lay_out(flood_case(tank_with(plate(0.613, 0, 0.5, 0, 0.5)), Vector3d(0.1, 0.1, 0.1), 0.3));
  EXPECT_NEAR(total(layout.volumes), 0.613 * 0.5 * 0.3, 1e-5);
  for (const Vector3d& p : layout.particles) EXPECT_LT(p.x(), 0.613);
}

TEST_F(LayoutFluid, AFloodStopsAtAPlateOnALatticePlane) {
  const Layout layout = lay_out(flood_case(tank_with(plate(0.525, 0, 0.5, 0, 0.5)), Vector3d(0.1, 0.1, 0.1), 0.3));
  for (const Vector3d& p : layout.particles) EXPECT_LT(p.x(), 0.525);
}

TEST_F(LayoutFluid, AFloodDoesNotSqueezeThroughWhereCornersMeet) {
  TriangleMesh pen = plate(0.5, 0, 0.25, 0, 0.5);  // two plates that meet at an upright edge: a pen about a corner of the tank
  TriangleMesh other;
  other.vertices = {Vector3d(0.5, 0.25, 0), Vector3d(0, 0.25, 0), Vector3d(0, 0.25, 0.5), Vector3d(0.5, 0.25, 0.5)};
  other.triangles = {Vector3i(0, 1, 2), Vector3i(0, 2, 3)};
  append(pen, other);
  const Layout layout = lay_out(flood_case(tank_with(pen), Vector3d(0.1, 0.1, 0.1), 0.3));
  EXPECT_NEAR(total(layout.volumes), 0.5 * 0.25 * 0.3, 1e-5);
}

TEST_F(LayoutFluid, AFloodPassesUnderAWeir) {
  const Layout layout = lay_out(flood_case(tank_with(plate(0.5, 0, 0.5, 0.2, 0.5)), Vector3d(0.1, 0.1, 0.1), 0.3));
  EXPECT_NEAR(total(layout.volumes), 0.15, 1e-5);
}

TEST_F(LayoutFluid, RefusesALeakingTankAndSaysWhere) {
  TriangleMesh tank = box_mesh({Vector3d::Zero(), Vector3d(1, 0.5, 0.5)}, true, "");
  tank.triangles.erase(
      std::remove_if(tank.triangles.begin(), tank.triangles.end(),
                     [&](const Vector3i& t) { return tank.vertices[t[0]].x() + tank.vertices[t[1]].x() + tank.vertices[t[2]].x() > 2.9; }),
      tank.triangles.end());
  const MeshSource open_end = source(write("open.obj", tank));
  Case flood = flood_case(open_end, Vector3d(0.1, 0.1, 0.1), 0.3), box = flood;
  EXPECT_ERROR(lay_out(flood), "leaks out of the tank near (1, ");
  box.fluid.fill = {Box{Vector3d::Zero(), Vector3d(0.3, 0.5, 0.3)}};  // touches no opening itself
  EXPECT_ERROR(lay_out(box), "leaks out of the tank near (1, ");
}

TEST_F(LayoutFluid, RefusesSeedsInWrongPlaces) {
  Case checked = flood_case(tank_with(TriangleMesh()), Vector3d(1.5, 0.1, 0.1), 0.3);
  EXPECT_ERROR(lay_out(checked), "fluid/fill/0: the seed (1.5, 0.1, 0.1) m lies outside the tank");
  checked = flood_case(tank_with(TriangleMesh()), Vector3d(0.5, 0.1, 0.35), 0.3);
  EXPECT_ERROR(lay_out(checked), "lies above the level");
  checked = flood_case(tank_with(TriangleMesh()), Vector3d(0.5, 0.2, 0.2), 0.3);
  checked.bodies = {box_body("box", Vector3d(0.3, 0.1, 0.1), Vector3d(0.7, 0.4, 0.4))};
  EXPECT_ERROR(lay_out(checked), "lies inside body 'box'");
  checked = flood_case(tank_with(TriangleMesh()), Vector3d(0.5, 0.2, 0.2), 0.8);
  EXPECT_ERROR(lay_out(checked), "above the tank's rim");
  checked = flood_case(source(repository_mesh("cylinder_tank.stl")), Vector3d(0.45, 0.45, 0.2), 0.3);
  EXPECT_ERROR(lay_out(checked), "leaks out of the tank");
}

TEST_F(LayoutFluid, RefusesBoxesThatStickOut) {
  Case checked = box_case(Vector3d(1, 0.5, 0.5), 0.4, 0.05);
  checked.fluid.fill = {Box{Vector3d(0.5, 0, 0), Vector3d(1.2, 0.5, 0.4)}};
  EXPECT_ERROR(lay_out(checked), "x = 1.2 m, and the tank ends at 1 m");
  checked.fluid.fill = {Box{Vector3d(0.5, 0, -0.1), Vector3d(1, 0.5, 0.4)}};
  EXPECT_ERROR(lay_out(checked), "z = -0.1 m, and the tank begins at 0 m");
  checked.fluid.fill = {Box{Vector3d(0, 0, 0), Vector3d(1, 0.5, 0.6)}};
  EXPECT_ERROR(lay_out(checked), "z = 0.6 m");
  checked.tank.shape = source(repository_mesh("cylinder_tank.stl"));
  checked.fluid.fill = {Box{Vector3d(-0.45, -0.45, 0), Vector3d(0.45, 0.45, 0.4)}};
  EXPECT_ERROR(lay_out(checked), "sticks out of the tank");
  checked.fluid.fill = {Box{Vector3d(-0.3, -0.3, 0), Vector3d(0.3, 0.3, 0.4)}};
  EXPECT_EQ(lay_out(checked).particles.size(), 12u * 12 * 8);
}

TEST_F(LayoutFluid, RefusesOverlaps) {
  Case checked = box_case(Vector3d(1, 0.5, 0.5), 0.4, 0.05);
  checked.fluid.fill.push_back(Box{Vector3d(0.4, 0.1, 0.1), Vector3d(0.6, 0.3, 0.3)});
  EXPECT_ERROR(lay_out(checked), "overlaps another region");
  checked.fluid.fill = {Box{Vector3d(0, 0, 0), Vector3d(0.5, 0.5, 0.3)}, FloodFill{Vector3d(0.8, 0.2, 0.1), 0.3}};
  EXPECT_ERROR(lay_out(checked), "overlaps another region");
}

TEST_F(LayoutFluid, RefusesAFillWithoutRoom) {
  Case checked = box_case(Vector3d(1, 0.5, 0.5), 0.4, 0.05);
  checked.fluid.fill = {Box{Vector3d(0.4, 0.2, 0.1), Vector3d(0.5, 0.3, 0.2)}};
  checked.bodies = {box_body("box", Vector3d(0.3, 0.1, 0.05), Vector3d(0.6, 0.4, 0.3))};
  EXPECT_ERROR(lay_out(checked), "no room for a single particle");
  checked.fluid.fill = {Box{Vector3d(0.4, 0.2, 0.1), Vector3d(0.4, 0.3, 0.2)}};
  EXPECT_ERROR(lay_out(checked), "no extent along x");
}

TEST_F(LayoutFluid, NamesTheBodyWhoseMeshIsWrong) {
  Case checked = box_case(Vector3d(1, 0.5, 0.5), 0.4, 0.05);
  BodyCase body;
  body.name = "hull";
  body.shape = source(write("open.obj", box_mesh({Vector3d(0.4, 0.2, 0.1), Vector3d(0.5, 0.3, 0.2)}, true, "")));
  checked.bodies = {body};
  EXPECT_ERROR(lay_out(checked), "body 'hull': mesh 'open.obj' is not closed");
  checked.tank.shape = source("/nowhere/tank.stl");
  EXPECT_ERROR(lay_out(checked), "tank: mesh file '/nowhere/tank.stl' does not exist");
}

TEST_F(LayoutFluid, ChecksProbesAndGauges) {
  Case checked = box_case(Vector3d(1, 0.5, 0.5), 0.4, 0.05);
  checked.bodies = {box_body("box", Vector3d(0.3, 0.1, 0.1), Vector3d(0.7, 0.4, 0.4))};
  const auto with_probe = [&](const Vector3d& position) {
    Case result = checked;
    result.instruments.pressure_probes = {{"P7", position}};
    return result;
  };
  EXPECT_ERROR(lay_out(with_probe(Vector3d(0.5, 0.2, 0.2))), "pressure probe 'P7' at (0.5, 0.2, 0.2) m lies inside body 'box'");
  EXPECT_ERROR(lay_out(with_probe(Vector3d(0.32, 0.2, 0.2))), "lies inside body 'box'");
  EXPECT_ERROR(lay_out(with_probe(Vector3d(0.5, 0.2, -0.2))), "outside the tank");
  EXPECT_ERROR(lay_out(with_probe(Vector3d(1.1, 0.2, 0.2))), "outside the tank");
  for (const Vector3d& fine :
       {Vector3d(0.3, 0.2, 0.2), Vector3d(0.305, 0.2, 0.2), Vector3d(0, 0.2, 0), Vector3d(0.1, 0.1, 0.1), Vector3d(1, 0.5, 0.5)}) {
    EXPECT_NO_THROW(lay_out(with_probe(fine))) << fine.transpose();
  }
  Case gauge = checked;
  gauge.instruments.wave_gauges = {{"H1", Vector3d(0.5, 0.6, 0)}};
  EXPECT_ERROR(lay_out(gauge), "wave gauge 'H1' at x = 0.5, y = 0.6 m lies outside the tank");
  gauge.instruments.wave_gauges = {{"H1", Vector3d(1.0, 0.25, 99)}};
  EXPECT_NO_THROW(lay_out(gauge));
}

TEST_F(LayoutFluid, RefusesAProbeBehindAWall) {
  Case checked = flood_case(tank_with(plate(0.5, 0, 0.5, 0, 0.5)), Vector3d(0.1, 0.1, 0.1), 0.3);
  checked.instruments.pressure_probes = {{"dry", Vector3d(0.75, 0.25, 0.2)}};
  EXPECT_ERROR(lay_out(checked), "pressure probe 'dry' at (0.75, 0.25, 0.2) m lies where the fluid cannot come");
}

TEST_F(LayoutFluid, Spheric2) {
  Case checked;
  checked.tank.shape = source(repository_mesh("spheric2_tank.stl"));
  BodyCase body;
  body.name = "box";
  body.shape = source(repository_mesh("spheric2_box.stl"));
  checked.bodies = {body};
  checked.fluid.spacing = 0.55 / 20;
  checked.fluid.fill = {Box{Vector3d(1.992, 0, 0), Vector3d(3.22, 1, 0.55)}};
  for (int k = 0; k < 4; ++k) {
    checked.instruments.pressure_probes.push_back({"P" + std::to_string(k + 1), Vector3d(0.8245, 0.4745, 0.021 + 0.04 * k)});
    checked.instruments.pressure_probes.push_back({"P" + std::to_string(k + 5), Vector3d(0.8035 - 0.04 * k, 0.4745, 0.161)});
  }
  const Layout layout = lay_out(checked);
  EXPECT_EQ(layout.particles.size(), 45u * 36 * 20);
  EXPECT_NEAR(total(layout.volumes), 1.228 * 0.55, 1e-9);
  EXPECT_NEAR(sums_of(layout, 0).area, 3.22 + 2 * 4.22 - 0.161 * 0.403, 1e-6);
  EXPECT_NEAR(sums_of(layout, 1).area, 0.161 * 0.403 + 2 * 0.161 * (0.161 + 0.403), 1e-6);
}

}  // namespace
}  // namespace wavetank

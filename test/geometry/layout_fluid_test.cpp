#include <algorithm>

#include "geometry_fixture.h"
#include "wavetank/common/log.h"
#include "wavetank/scene/case_reader.h"

namespace wavetank::layout_fluid_test {
namespace {

/// The lines that are logged while it lives.
class LogLines {
 public:
  LogLines() {
    set_log_sink([this](LogLevel, const std::string& line) { lines.push_back(line); });
  }
  ~LogLines() {
    set_log_sink([](LogLevel, const std::string&) {});
  }
  std::vector<std::string> lines;
};

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

/// Links as a user writes them: meshes in millimetres beside the URDF, one mirrored, one stretched.
TEST_F(LayoutFluid, MeshesOfARobotAreMirroredAndStretched) {
  TriangleMesh wedge;
  for (const double y : {0.0, 150.0})
    for (const Vector3d& corner : {Vector3d(0, y, 0), Vector3d(200, y, 0), Vector3d(0, y, 100)}) wedge.vertices.push_back(corner);
  wedge.triangles = {{0, 1, 2}, {3, 5, 4}, {0, 3, 1}, {1, 3, 4}, {1, 4, 2}, {2, 4, 5}, {2, 5, 0}, {0, 5, 3}};
  write("wedge_mm.obj", wedge);
  std::string urdf = "<robot name=\"pair\">";
  const std::pair<const char*, const char*> links[] = {
      {"left", "0.001 0.001 0.001"}, {"right", "0.001 -0.001 0.001"}, {"large", "0.0015 0.0015 0.0015"}, {"flat", "0.002 0.001 -0.0005"}};
  const char* places[] = {"0 0 0", "0 -0.05 0", "0.3 0 0", "0.3 -0.2 0.2"};
  for (int k = 0; k < 4; ++k) {
    const std::string name = links[k].first;
    urdf += "<link name=\"" + name + "\"><collision><geometry><mesh filename=\"wedge_mm.obj\" scale=\"" + links[k].second +
            "\"/></geometry></collision></link>";
    if (k > 0) {
      urdf += "<joint name=\"to_" + name + "\" type=\"fixed\"><parent link=\"left\"/><child link=\"" + name + "\"/><origin xyz=\"" +
              places[k] + "\"/></joint>";
    }
  }
  write("robot.urdf", urdf + "</robot>");
  const Case checked = read_case_file(
      write("case.yaml",
            "duration: 1\nfluid: {spacing: 0.04, fill: [{box: {min: [0, 0, 0], max: [1, 0.7, 0.5]}}]}\ntank: {box: {size: [1, 0.7, 0.6]}}\n"
            "robots: [{urdf: robot.urdf, position: [0.1, 0.4, 0.15], motion: fixed}]\n"));
  const Layout layout = lay_out(checked);
  ASSERT_EQ(layout.meshes.size(), 5u);
  const double volumes[] = {0.0015, 0.0015, 0.0050625, 0.0015};
  for (int k = 0; k < 4; ++k) {
    EXPECT_NEAR(layout.meshes[k + 1].signed_volume(), volumes[k], 1e-8) << k;
    EXPECT_NEAR(sums_of(layout, k + 1).divergence, -3 * volumes[k], 1e-6) << k;
  }
  // links come by their joints' names: left, flat, large, right
  EXPECT_NEAR(layout.meshes[2].bounding_box().min.z(), 0.3, 1e-6);
  EXPECT_NEAR(layout.meshes[4].bounding_box().min.y(), 0.2, 1e-6);
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

/// Packing would push the water off the mouth of a gap by a lid there and by the film as well, and the tank ring by it.
TEST_F(LayoutFluid, NoLidAtAGapThatAFilmFills) {
  const auto upright = [](double gap, Motion motion, Gradients gradients) {
    Case checked = box_case(Vector3d(0.8, 0, 0.5), 0.3, 0.02);
    BodyCase box = box_body("box", Vector3d(0.2, 0, 0.02 * gap), Vector3d(0.6, 0, 0.02 * gap + 0.12));
    box.motion = motion;
    checked.bodies = {box};
    checked.numerics.gradients = gradients;
    std::size_t count = 0;
    for (const WallElement& element : lay_out(checked).lid) count += std::abs(element.normal.x()) > 0.5 ? 1 : 0;
    return count;
  };
  for (const double gap : {0.52, 0.6, 0.75, 0.89}) EXPECT_EQ(upright(gap, Motion::fixed, Gradients::sph), 0u) << gap << " spacings";
  EXPECT_EQ(upright(0.75, Motion::prescribed, Gradients::sph), 0u);
  EXPECT_EQ(upright(0.75, Motion::free, Gradients::sph), 2u) << "at either end: its film is not felt before it moves";
  EXPECT_EQ(upright(0.75, Motion::fixed, Gradients::mls), 2u) << "nor is any by least squares";
}

/// A gap has particles only as they fit, whatever stands about it.
TEST_F(LayoutFluid, ParticlesInNarrowGapsHaveTheirRoom) {
  struct Place {
    const char* what;
    Vector3d low, high;  ///< of a body that leaves a gap of width 0 to what faces it ...
    Vector3d off;        ///< ... and which way it is moved from there
    std::optional<Box> other;
  };
  const std::vector<Place> places = {
      {"over the floor", {0.3, 0.1, 0}, {0.7, 0.4, 0.2}, {0, 0, 1}, {}},
      {"beside the wall", {0, 0.1, 0.1}, {0.3, 0.4, 0.3}, {1, 0, 0}, {}},
      {"beside a body", {0.5, 0.1, 0.1}, {0.7, 0.4, 0.3}, {1, 0, 0}, Box{Vector3d(0.3, 0.1, 0.1), Vector3d(0.5, 0.4, 0.3)}},
      {"above a body", {0.3, 0.1, 0.15}, {0.5, 0.4, 0.3}, {0, 0, 1}, Box{Vector3d(0.3, 0.1, 0), Vector3d(0.5, 0.4, 0.15)}},
  };
  constexpr double spacing = 0.05;
  for (const int dimensions : {3, 2}) {
    for (const bool flood : {false, true}) {
      for (const Place& place : places) {
        const std::vector<double> few = {0.55, 1.0, 1.3, 1.8}, many = {0.3, 0.55, 0.7, 0.85, 1.0, 1.1, 1.3, 1.6, 1.8, 1.95};
        for (const double width : dimensions == 3 ? few : many) {
          SCOPED_TRACE(std::string(place.what) + (flood ? ", seed, " : ", box, ") + std::to_string(dimensions) + "-D, " +
                       std::to_string(width));
          Case checked = box_case(Vector3d(1, dimensions == 3 ? 0.5 : 0, 0.5), 0.4, spacing);
          if (flood) checked.fluid.fill = {FloodFill{Vector3d(0.93, 0.07, 0.33), 0.4}};
          const Vector3d moved = width * spacing * place.off;
          checked.bodies = {box_body("box", place.low + moved, place.high + moved)};
          if (place.other) checked.bodies.push_back(box_body("other", place.other->min, place.other->max));
          const Layout layout = lay_out(checked);
          const Vector3d gap_end = place.low + moved;
          const int axis = place.off.x() > 0 ? 0 : 2;
          std::vector<double> heights;  // in the gap, over the wall across it
          for (const Vector3d& p : layout.particles) {
            bool within = p[axis] > place.low[axis] && p[axis] < gap_end[axis];
            for (int other = 0; other < dimensions; ++other) {
              const int along = dimensions == 2 ? 2 * other : other;
              if (along != axis) within = within && p[along] > place.low[along] && p[along] < place.high[along];
            }
            if (within) heights.push_back((p[axis] - place.low[axis]) / spacing);
          }
          const double across = dimensions == 3 ? 6 : 1;           // rows along y
          const double along = axis == 2 && !place.other ? 8 : 4;  // and along the gap
          const double layers = static_cast<double>(heights.size()) / (across * along);
          if (width < 0.9) {
            EXPECT_EQ(heights.size(), 0u);
          }
          EXPECT_LE(layers, width < 1.7 ? 1.01 : 2.01);
          if (width >= 1.0) {
            EXPECT_GE(layers, 0.99);
          }
          for (const double height : heights) {
            EXPECT_GT(height, 0.499);
            EXPECT_LT(height, width - 0.499);
          }
        }
      }
    }
  }
}

TEST_F(LayoutFluid, NarrowTanksAreFilledToTheirVolume) {
  // Their cells are fitted to them, and so is the room that a particle needs.
  EXPECT_NEAR(total(lay_out(box_case(Vector3d(1, 0.08, 0.5), 0.4, 0.05)).volumes), 0.032, 1e-9);
  EXPECT_NEAR(total(lay_out(box_case(Vector3d(0.07, 0, 0.5), 0.4, 0.05)).volumes), 0.028, 1e-9);
  EXPECT_NEAR(total(lay_out(box_case(Vector3d(0.074, 0, 0.5), 0.4, 0.05)).volumes), 0.0296, 1e-9);
  Case flood = box_case(Vector3d(0.08, 0, 0.5), 0.4, 0.05);
  flood.fluid.fill = {FloodFill{Vector3d(0.05, 0, 0.1), 0.4}};
  EXPECT_NEAR(total(lay_out(flood).volumes), 0.032, 1e-6);
}

/// A boat of 0.5 × 0.3 × 0.15 m about the middle of its bottom, 30 mm thick, open at the top.
TriangleMesh open_boat() {
  TriangleMesh boat = box_mesh({Vector3d(-0.25, -0.15, 0), Vector3d(0.25, 0.15, 0.15)}, true, "");
  TriangleMesh inner = box_mesh({Vector3d(-0.22, -0.12, 0.03), Vector3d(0.22, 0.12, 0.15)}, true, "");
  for (Vector3i& t : inner.triangles) std::swap(t[1], t[2]);
  append(boat, inner);
  const int ring[4] = {4, 5, 7, 6};  // the corners at the top of either, in turn
  for (int k = 0; k < 4; ++k) {
    const int a = ring[k], b = ring[(k + 1) % 4];
    boat.triangles.emplace_back(a, b, b + 8);
    boat.triangles.emplace_back(a, b + 8, a + 8);
  }
  return boat;
}

TEST_F(LayoutFluid, WaterThatABodyPartsFromTheRestOfABoxIsTold) {
  Case checked = box_case(Vector3d(0.9, 0.6, 0.5), 0.25, 0.03);
  BodyCase boat;
  boat.name = "boat";
  MeshSource mesh = source(write("boat.obj", open_boat()));
  mesh.translation = Vector3d(0.45, 0.3, 0.19);
  boat.shape = mesh;
  const auto warnings = [&](const Case& told) {
    const LogLines log;
    lay_out(told);
    return log.lines;
  };
  for (const int dimensions : {3, 2}) {
    checked.dimensions = dimensions;
    if (dimensions == 2) mesh.translation.y() = 0.01;
    boat.shape = mesh;
    checked.bodies = {boat};
    const std::vector<std::string> told = warnings(checked);
    ASSERT_EQ(told.size(), 1u);
    EXPECT_NE(told[0].find("fluid/fill/0: body 'boat' parts 0.0"), std::string::npos) << told[0];
    EXPECT_NE(told[0].find(dimensions == 3 ? " m³ (3." : " m³ a metre of width (1"), std::string::npos) << told[0];
    EXPECT_NE(told[0].find("fill from a seed"), std::string::npos) << told[0];

    Case seed = checked;
    seed.fluid.fill = {FloodFill{Vector3d(0.05, 0.05, 0.05), 0.25}};
    EXPECT_TRUE(warnings(seed).empty());
    Case sunk = checked;  // over its brim
    sunk.fluid.fill = {Box{Vector3d::Zero(), Vector3d(0.9, 0.6, 0.4)}};
    EXPECT_TRUE(warnings(sunk).empty());
    Case two = checked;
    two.bodies[0].name = "left";
    std::get<MeshSource>(two.bodies[0].shape).scale = Vector3d(0.7, 1, 1);
    std::get<MeshSource>(two.bodies[0].shape).translation.z() = 0.2;
    std::get<MeshSource>(two.bodies[0].shape).translation.x() = 0.2;
    two.bodies.push_back(two.bodies[0]);
    two.bodies[1].name = "right";
    std::get<MeshSource>(two.bodies[1].shape).translation.x() = 0.6;
    EXPECT_EQ(warnings(two).size(), 2u);
  }
  checked = box_case(Vector3d(0.9, 0.6, 0.5), 0.25, 0.03);
  checked.bodies = {box_body("block", Vector3d(0.2, 0.2, 0.1), Vector3d(0.5, 0.4, 0.4))};
  EXPECT_TRUE(warnings(checked).empty());
  checked.bodies = {box_body("gate", Vector3d(0.4, 0, 0), Vector3d(0.45, 0.6, 0.4))};
  EXPECT_EQ(warnings(checked).size(), 1u);
  // Water on either side of the gate as two boxes is what is meant.
  checked.fluid.fill = {Box{Vector3d::Zero(), Vector3d(0.4, 0.6, 0.25)}, Box{Vector3d(0.45, 0, 0), Vector3d(0.9, 0.6, 0.25)}};
  EXPECT_TRUE(warnings(checked).empty());
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

/// The floor's and the sides' triangles end at the baffle, as every mesh generator makes them, or do not.
TEST_F(LayoutFluid, AFloodStopsAtABaffleThatIsJoinedToItsTank) {
  for (const bool joined : {false, true}) {
    for (const int dimensions : {3, 2}) {
      SCOPED_TRACE(std::to_string(dimensions) + (joined ? "-D, joined" : "-D, loose"));
      const double ends[] = {0, joined ? 0.5 : 1.0, 1};
      TriangleMesh tank = plate(0.5, -0.2, 0.2, 0, 0.3);
      for (int part = 0; part < (joined ? 2 : 1); ++part) {
        TriangleMesh half = box_mesh({Vector3d(ends[part], -0.2, 0), Vector3d(ends[part + 1], 0.2, 0.5)}, true, "");
        half.triangles.erase(std::remove_if(half.triangles.begin(), half.triangles.end(),
                                            [&](const Vector3i& t) {
                                              const double x = half.vertices[t[0]].x();
                                              return joined && x == 0.5 && half.vertices[t[1]].x() == x && half.vertices[t[2]].x() == x;
                                            }),
                             half.triangles.end());
        append(tank, half);
      }
      Case checked = flood_case(source(write("tank.obj", tank)), Vector3d(0.2, 0, 0.1), 0.24);
      checked.fluid.spacing = 0.04;
      checked.dimensions = dimensions;
      const Layout layout = lay_out(checked);
      EXPECT_NEAR(total(layout.volumes), 0.5 * 0.24 * (dimensions == 3 ? 0.4 : 1), 1e-5);
      for (const Vector3d& p : layout.particles) EXPECT_LT(p.x(), 0.5);
      // Wet are all of the tank, over the baffle as well, and both of the baffle's sides.
      EXPECT_NEAR(sums_of(layout, 0).area, dimensions == 3 ? 0.4 + 2 * 0.5 * 1.4 + 2 * 0.4 * 0.3 : 1 + 2 * 0.5 + 2 * 0.3, 1e-5);
    }
  }
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
}  // namespace wavetank::layout_fluid_test

// Water at the start beside walls that lie between the lattice's planes.
#include <cmath>

#include "geometry_fixture.h"

namespace wavetank::cell_shares_test {
namespace {

using CellShares = GeometryTest;

/// A prism along y over a regular polygon, as wide as the tanks here.
TriangleMesh cylinder(const Vector3d& centre, double radius, int corners, double turned) {
  TriangleMesh mesh;
  for (const double y : {-0.1, 0.6})
    for (int k = 0; k < corners; ++k) {
      const double angle = turned + 2 * M_PI * k / corners;
      mesh.vertices.emplace_back(centre + Vector3d(radius * std::cos(angle), y, radius * std::sin(angle)));
    }
  for (int k = 0; k < corners; ++k) {
    const int next = (k + 1) % corners;
    mesh.triangles.emplace_back(k, next + corners, next);
    mesh.triangles.emplace_back(k, k + corners, next + corners);
    if (k < 2) continue;
    mesh.triangles.emplace_back(0, k - 1, k);
    mesh.triangles.emplace_back(corners, corners + k, corners + k - 1);
  }
  return mesh;
}

/// Half a row of particles more or less over a box was 5 % of its buoyancy.
TEST_F(CellShares, ParticlesHaveTheVolumeOfTheWaterWhereverWallsCutTheLattice) {
  constexpr double spacing = 0.02;
  for (const int dimensions : {2, 3}) {
    const double width = dimensions == 2 ? 0.0 : 0.2, across = dimensions == 2 ? 1.0 : width;
    for (const bool flood : {false, true}) {
      for (const double offset : {0.0, 0.2, 0.5, 0.65}) {
        SCOPED_TRACE(std::to_string(dimensions) + (flood ? "-D, seed, " : "-D, box, ") + std::to_string(offset));
        Case checked = box_case(Vector3d(0.8, width, 0.5), 0.4, spacing);
        if (flood) checked.fluid.fill = {FloodFill{Vector3d(0.05, 0.5 * width, 0.1), 0.4}};
        const double off = offset * spacing;
        const auto volume_beside = [&](const BodyCase& body) {
          checked.bodies = {body};
          return total(lay_out(checked).volumes);
        };
        const BodyCase box = box_body("box", Vector3d(0.2 + 0.5 * off, -0.1, 0.14 + off), Vector3d(0.5, 0.6, 0.3));
        EXPECT_NEAR(volume_beside(box) / across, 0.32 - (0.3 - 0.5 * off) * (0.16 - off), 0.05 * spacing * 0.3);
        const Layout layout = lay_out(checked);
        double over = 0;
        for (std::size_t i = 0; i < layout.particles.size(); ++i)
          if (layout.particles[i].z() > 0.28 && std::abs(layout.particles[i].x() - 0.35) < 0.07) over += layout.volumes[i];
        EXPECT_NEAR(over / across, 0.14 * 0.1, 0.05 * spacing * 0.14) << "over the box";
        for (const auto& [corners, turned] : {std::pair(3, 0.3), std::pair(4, 0.3), std::pair(4, 0.0), std::pair(48, 0.3)}) {
          BodyCase body;
          body.name = "cylinder";
          body.shape = source(write("cylinder.obj", cylinder(Vector3d(0.4 + off, 0, 0.2 + 0.7 * off), 0.1, corners, turned)));
          const double area = 0.5 * corners * 0.01 * std::sin(2 * M_PI / corners);
          const double off_layer = corners == 4 && turned == 0 ? 0.055 : 0.02;  // at 45° all cells are cut alike
          EXPECT_NEAR(volume_beside(body) / across, 0.32 - area, off_layer * spacing * 0.6) << corners << " corners, turned by " << turned;
        }
      }
    }
  }
}

TEST_F(CellShares, ParticlesOfACorridorHaveTheVolumeOfTheWaterOverABody) {
  for (const double offset : {0.0, 0.2, 0.5, 0.65}) {
    Case checked = box_case(Vector3d(0.8, 0.05, 0.5), 0.4, 0.02);
    checked.bodies = {box_body("box", Vector3d(0.2, -0.1, -0.1), Vector3d(0.5, 0.6, 0.2 + 0.02 * offset))};
    EXPECT_NEAR(total(lay_out(checked).volumes) / 0.05, 0.32 - 0.3 * (0.2 + 0.02 * offset), 0.03 * 0.02 * 0.3) << offset;
  }
}

/// A cell whose middle lies on a wall has no particle, and packing needs no lid about it: what it leaves would fall in at the start.
TEST_F(CellShares, NoLidAboutACellOnAWall) {
  for (const double turned : {0.0, 0.3}) {
    for (const Vector3d& centre :
         {Vector3d(0.6, 0, 0.2), Vector3d(0.61, 0, 0.213), Vector3d(0.59, 0, 0.21), Vector3d(0.6 + 1e-5, 0, 0.21)}) {
      Case checked = box_case(Vector3d(1.2, 0, 0.6), 0.4, 0.02);
      BodyCase body;
      body.name = "cylinder";
      body.shape = source(write("cylinder.obj", cylinder(centre, 0.08, 48, turned)));
      checked.bodies = {body};
      for (const WallElement& element : lay_out(checked).lid) {
        EXPECT_NEAR(element.centre.z(), 0.4, 1e-9) << centre.transpose();
        EXPECT_NEAR(element.normal.z(), 1.0, 1e-9) << centre.transpose();
      }
    }
  }
}

}  // namespace
}  // namespace wavetank::cell_shares_test

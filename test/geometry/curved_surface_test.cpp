// Water that is filled up to a surface that is not level.
#include <algorithm>
#include <map>
#include <numeric>

#include "../../src/geometry/fluid_filling.h"
#include "geometry_fixture.h"

namespace wavetank::curved_surface_test {
namespace {

double total(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

Case wavy(const std::string& elevation) {
  Case scene = box_case(Vector3d(2, 0, 0.6), 0.3, 0.02);
  scene.fluid.initial.elevation = elevation;
  return scene;
}

/// The uppermost particle's height in each column.
std::map<int, double> tops(const Layout& layout) {
  std::map<int, double> highest;
  for (const Vector3d& place : layout.particles) {
    double& top = highest[static_cast<int>(std::floor(place.x() / 0.02))];
    top = std::max(top, place.z());
  }
  return highest;
}

TEST(CurvedSurface, HasTheVolumeAndTheHeightThatItIsGiven) {
  const Layout level = lay_out(wavy("")), waves = lay_out(wavy("0.05*cos(pi*x)"));
  EXPECT_NEAR(total(waves.volumes), 0.6, 1e-4) << "the wave has no volume of its own";
  EXPECT_EQ(tops(waves).size(), 100u);
  for (const auto& [column, top] : tops(waves)) {
    const double surface = 0.3 + 0.05 * std::cos(M_PI * 0.02 * (column + 0.5));
    EXPECT_NEAR(top, surface - 0.01, 0.0006) << "half a cell below it; cells differ by half of one in fifteen at most";
  }
  for (std::size_t i = 0; i < waves.particles.size(); ++i) {
    EXPECT_NEAR(waves.volumes[i], 4e-4, 4e-4 * 0.5 / 12);
    EXPECT_NEAR(waves.levels[i], 0.3 + 0.05 * std::cos(M_PI * waves.particles[i].x()), 1e-12);
  }
  // closed: a lid as long as the surface, no piece of it upright, and outwards all the same
  double length = 0, flux = 0;
  for (const WallElement& element : waves.lid) {
    EXPECT_GT(element.normal.z(), 0.9);
    length += element.area;
    flux += element.area * element.normal.z();
  }
  EXPECT_NEAR(flux, 2.0, 1e-9);
  EXPECT_NEAR(length, 2.0 * (1 + 0.25 * std::pow(0.05 * M_PI, 2)), 2e-4);
  EXPECT_EQ(level.lid.size(), 100u);
}

TEST(CurvedSurface, RisesFromASeedAndInThreeDimensionsAlike) {
  Case scene = box_case(Vector3d(1, 0.5, 0.6), 0.3, 0.05);
  scene.fluid.initial.elevation = "0.1*(x - 0.5) + 0.08*(y - 0.25)";
  const Layout box = lay_out(scene);
  EXPECT_NEAR(total(box.volumes), 0.15, 1e-5);
  scene.fluid.fill = {FloodFill{Vector3d(0.5, 0.25, 0.1), 0.3}};
  const Layout flood = lay_out(scene);
  EXPECT_NEAR(total(flood.volumes), 0.15, 1e-5);
  const Vector3d outwards = Vector3d(-0.1, -0.08, 1).normalized();
  for (const WallElement& element : flood.lid) EXPECT_NEAR((element.normal - outwards).norm(), 0, 1e-9);
}

TEST(CurvedSurface, HasItsVolumeOverAndBesideBodiesThatCutTheLattice) {
  for (const double offset : {0.0, 0.25, 0.5, 0.8}) {
    const double off = 0.02 * offset;
    Case scene = wavy("0.05*cos(pi*x)");
    scene.bodies = {box_body("sunk", Vector3d(0.3 + off, -0.1, 0.05 + off), Vector3d(0.7, 0.1, 0.16)),
                    box_body("in the surface", Vector3d(1.2, -0.1, 0.2 + off), Vector3d(1.5 + off, 0.1, 0.5))};
    const double under = 0.05 / M_PI * (std::sin(M_PI * (1.5 + off)) - std::sin(M_PI * 1.2));  // ∫ of the elevation over the second
    const double wet = 0.6 - (0.4 - off) * (0.11 - off) - (0.3 + off) * (0.1 - off) - under;
    EXPECT_NEAR(total(lay_out(scene).volumes), wet, 0.04 * 0.02 * 0.8) << "of the layers over and under them, " << offset;
  }
}

// Water that ends in the tank: its side is as high as the water, though the cells there are not as high as a cell of the lattice.
TEST(CurvedSurface, HasALidAsHighAsItsSide) {
  Case scene = wavy("0.05");
  scene.fluid.fill = {Box{Vector3d::Zero(), Vector3d(1, 0, 0.3)}};
  double height = 0, moment = 0;
  for (const WallElement& element : lay_out(scene).lid) {
    if (element.normal.z() > 0.5) continue;
    EXPECT_NEAR(element.normal.x(), 1, 1e-12);
    height += element.area;
    moment += element.area * element.centre.z();
  }
  EXPECT_NEAR(height, 0.35, 1e-6);
  EXPECT_NEAR(moment, 0.5 * 0.35 * 0.35, 1e-6);
}

TEST(CurvedSurface, HasInclinedPiecesAsLongAsTheSlope) {
  Case scene = box_case(Vector3d(1, 0.5, 0.6), 0.3, 0.05);
  scene.fluid.initial.elevation = "0.3*(x - 0.5)";
  for (const WallElement& element : lay_out(scene).lid) {
    if (element.normal.z() < 0.5) continue;
    EXPECT_NEAR(element.area, 0.05 * 0.05 * std::sqrt(1.09), 1e-9);
    EXPECT_NEAR(std::sqrt(element.area * element.elongation), 0.05 * std::sqrt(1.09), 1e-9) << "the side along the tangent";
  }
}

TEST(CurvedSurface, FitsTheEndsOfAPeriodicTank) {
  Case scene = wavy("0.05*cos(pi*x)");
  scene.tank.periodic[0] = true;
  EXPECT_NO_THROW(lay_out(scene));
  scene.fluid.initial.elevation = "0.05*x/2";
  EXPECT_ERROR(lay_out(scene),
               "fluid/fill/0: by fluid/initial the surface is raised by 0 m at x = 0 m and by 0.05 m at x = 2 m, which are one place in a "
               "tank that is periodic along x");
  scene.fluid.fill = {Box{Vector3d::Zero(), Vector3d(1, 0, 0.3)}};
  EXPECT_NO_THROW(lay_out(scene)) << "it does not come to the other end";
}

TEST(CurvedSurface, HasNoMoreCellsThanALatticeMayHave) {
  Basin basin;
  basin.dimensions = 2;
  basin.domain = {Vector3d::Zero(), Vector3d(1, 0, 1e8)};
  FilledRegion region;
  region.key = "fluid/fill/0";
  region.step = Vector3d(0.1, 0, 0.1);
  region.first = Vector3d(0.05, 0, 0.05);
  region.count = Vector3i(10, 1, 1);
  region.filled.assign(10, 1);
  region.position.resize(10);
  for (int i = 0; i < 10; ++i) region.position[i] = region.centre(i, 0, 0);
  const InitialState initial(wavy("2e6"));
  EXPECT_ERROR(raise_surface(basin, initial, region), "fluid/fill/0: more than 1e8 cells; choose a larger fluid/spacing");
}

// Under a body the water is as it was; over one that is wholly below the surface it is raised.
TEST(CurvedSurface, StopsAtWallsAboveIt) {
  Case scene = wavy("0.06");
  BodyCase block;
  block.name = "block";
  block.shape = Box{Vector3d(0.5, 0, 0.2), Vector3d(1, 0, 0.5)};
  scene.bodies = {block};
  const Layout layout = lay_out(scene);
  for (const Vector3d& place : layout.particles)
    EXPECT_FALSE(place.x() > 0.5 && place.x() < 1 && place.z() > 0.2 && place.z() < 0.5) << place.transpose();
  EXPECT_NEAR(total(layout.volumes), 2 * 0.36 - 0.5 * 0.16, 0.5 * 0.01);
  scene.bodies.clear();
  scene.tank.shape = BoxTank{Vector3d(2, 0, 0.32), Vector3d::Zero(), true};
  EXPECT_ERROR(lay_out(scene),
               "fluid/fill/0: by fluid/initial the surface is at z = 0.36 m at x = 0.01, y = 0 m, above the tank's rim at 0.32 m");
}

TEST(CurvedSurface, MustBeInTheTankAndFinite) {
  EXPECT_ERROR(lay_out(wavy("0.4*x")), "above the tank's rim at 0.6 m");
  EXPECT_ERROR(lay_out(wavy("-0.4*x")), "below the tank's floor at 0 m");
  EXPECT_ERROR(lay_out(wavy("1/(x - x)")), "fluid/initial/elevation is not finite at (");
}

}  // namespace
}  // namespace wavetank::curved_surface_test

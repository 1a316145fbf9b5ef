// The images that a periodic tank and a tank with ghosts are made of, and what such tanks are refused for.
#include "../../src/sph/tank_images.h"

#include <algorithm>

#include "../common/box_case.h"
#include "../common/error_of.h"

namespace wavetank::tank_images_test {
namespace {

std::vector<TankImage> images_of(const Case& checked, Discretisation* discretisation = nullptr) {
  const Layout layout = lay_out(checked);
  const Case scene = settled(checked, layout);
  const Discretisation d = discretise(scene, layout);
  if (discretisation) *discretisation = d;
  return tank_images(scene, layout, d);
}

/// Where a tank's images have a point of it, m.
std::vector<Vector3d> seen_of(const Case& scene, const Vector3d& point) {
  Discretisation d;
  std::vector<Vector3d> places;
  for (const TankImage& image : images_of(scene, &d)) places.push_back(d.origin + image.matrix * (point - d.origin) + image.offset);
  return places;
}

void expect_places(const std::vector<Vector3d>& found, const std::vector<Vector3d>& expected) {
  EXPECT_EQ(found.size(), expected.size());
  for (const Vector3d& place : expected) {
    // they are sums and differences of a few lengths below 1 m: 1e-9 m is only rounding
    const bool there = std::any_of(found.begin(), found.end(), [&](const Vector3d& other) { return (other - place).norm() < 1e-9; });
    EXPECT_TRUE(there) << "no image at " << place.transpose();
  }
}

Case with_ghosts(Case scene) {
  scene.numerics.walls.method = WallMethod::ghost;
  return scene;
}

Case periodic_along(Case scene, int axis) {
  scene.tank.periodic[axis] = true;
  return scene;
}

/// A tank of one of the repository's meshes, filled from a point inside it.
Case mesh_tank(const std::string& mesh, const Vector3d& seed) {
  Case scene = box_case(Vector3d(1, 1, 1), 0.2, 0.05);
  scene.tank.shape = MeshSource{std::string(WAVETANK_SOURCE_DIRECTORY) + "/meshes/" + mesh};
  scene.fluid.fill = {FloodFill{seed, 0.2}};
  return scene;
}

void expect_refusal(const Case& scene, const std::vector<std::string>& phrases) {
  const std::string message = error_of([&] { images_of(scene); });
  ASSERT_FALSE(message.empty());
  for (const std::string& phrase : phrases)
    EXPECT_NE(message.find(phrase), std::string::npos) << '"' << phrase << "\" is not in: " << message;
  EXPECT_EQ(message.back(), '.') << message;
  EXPECT_EQ(message.find(". "), std::string::npos) << "more than one sentence: " << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

TEST(TankImages, OfGhostsAreMirroredInWallsAndCorners) {
  const Vector3d point(0.1, 0, 0.2);
  Case scene = with_ghosts(box_case(Vector3d(0.5, 0, 0.5), 0.3, 0.02));
  std::vector<Vector3d> expected = {Vector3d(-0.1, 0, 0.2), Vector3d(0.9, 0, 0.2), Vector3d(0.1, 0, -0.2), Vector3d(-0.1, 0, -0.2),
                                    Vector3d(0.9, 0, -0.2)};
  expect_places(seen_of(scene, point), expected);
  std::get<BoxTank>(scene.tank.shape).closed = true;
  for (const double x : {-0.1, 0.1, 0.9}) expected.push_back(Vector3d(x, 0, 0.8));
  expect_places(seen_of(scene, point), expected);
  // 5 walls, 8 edges, 4 corners
  EXPECT_EQ(images_of(with_ghosts(box_case(Vector3d(0.5, 0.4, 0.5), 0.3, 0.05))).size(), 17u);
}

TEST(TankImages, OfPeriodicTanksAreShifted) {
  const Vector3d point(0.1, 0, 0.2);
  const Case scene = periodic_along(box_case(Vector3d(0.5, 0, 0.5), 0.3, 0.02), 0);
  std::vector<Vector3d> expected = {Vector3d(-0.4, 0, 0.2), Vector3d(0.6, 0, 0.2)};
  expect_places(seen_of(scene, point), expected);
  for (const double x : {-0.4, 0.1, 0.6}) expected.push_back(Vector3d(x, 0, -0.2));
  expect_places(seen_of(with_ghosts(scene), point), expected);
  // 4 ends, 4 edges between them
  EXPECT_EQ(images_of(periodic_along(periodic_along(box_case(Vector3d(0.5, 0.4, 0.5), 0.3, 0.05), 0), 1)).size(), 8u);
}

TEST(TankImages, OfOrdinaryTanksAreNone) { EXPECT_TRUE(images_of(box_case(Vector3d(0.5, 0, 0.5), 0.3, 0.02)).empty()); }

TEST(TankImages, GhostsRefuseWallsThatAreNotAtRightAngles) {
  expect_refusal(with_ghosts(mesh_tank("cylinder_tank.stl", Vector3d(0, 0, 0.1))),
                 {"numerics/walls/method is ghost", "needs walls at right angles", "walls that face (", "choose boundary_integral"});
}

TEST(TankImages, GhostsRefuseATankThatIsNotConvex) {
  expect_refusal(with_ghosts(mesh_tank("l_tank.stl", Vector3d(0.2, 0.2, 0.1))),
                 {"numerics/walls/method is ghost", "needs a convex tank", "m lies behind another", "choose boundary_integral"});
}

// The kernel's support is 4 spacings in 2-D, 0.08 m, and 3 in 3-D, 0.15 m. Twice that is wide enough.
TEST(TankImages, GhostsRefuseANarrowTank) {
  expect_refusal(
      with_ghosts(box_case(Vector3d(0.14, 0, 0.5), 0.2, 0.02)),
      {"numerics/walls/method is ghost", "only 0.14", "apart", "twice the kernel's support of 0.08", "choose boundary_integral"});
  EXPECT_NO_THROW(images_of(with_ghosts(box_case(Vector3d(0.16, 0, 0.5), 0.2, 0.02))));
}

Case with_opening(Case scene, const Vector3d& centre, const Vector3d& normal, double height) {
  OpeningCase opening;
  opening.name = "opening";
  opening.kind = OpeningKind::outlet;
  opening.centre = centre;
  opening.normal = normal;
  opening.size = std::array<double, 2>{1.0, height};
  scene.openings.push_back(opening);
  return scene;
}

/// How far outside of a gap a place's foot is, m; negative within.
double way_beside(const PlaneGap& gap, const Vector3d& place) {
  double way = -1;
  for (const TankPlane& edge : gap.edges) way = std::max(way, edge.normal.dot(place) + edge.offset);
  return way;
}

// Pockets have no planes of their own; a wall that is all open has none; and a gap that stands on the floor has no border there.
TEST(TankImages, OfGhostsHaveGapsAtOpenings) {
  const Case closed = with_ghosts(box_case(Vector3d(0.5, 0, 0.5), 0.3, 0.02));
  const Vector3d into_left(-1, 0, 0);
  EXPECT_EQ(images_of(with_opening(closed, Vector3d(0.5, 0, 0.25), into_left, 0.5)).size(), 3u);  // left, floor, and their corner
  for (const double middle : {0.1, 0.25}) {
    Discretisation d;
    std::size_t with_gaps = 0;
    const std::vector<TankImage> images = images_of(with_opening(closed, Vector3d(0.5, 0, middle), into_left, 0.2), &d);
    EXPECT_EQ(images.size(), 5u);
    for (const TankImage& image : images) {
      if (image.gaps.empty()) continue;
      ++with_gaps;
      ASSERT_EQ(image.gaps.size(), 1u);
      const PlaneGap& gap = image.gaps[0];
      EXPECT_NEAR(gap.plane.normal.dot(Vector3d(0.47, 0, 0.2) - d.origin) + gap.plane.offset, 0.03, 1e-12);
      EXPECT_NEAR(way_beside(gap, Vector3d(0.47, 0, middle + 0.13) - d.origin), 0.03, 1e-12);
      const double at_floor = way_beside(gap, Vector3d(0.47, 0, 0) - d.origin);
      if (middle == 0.1) {
        EXPECT_LE(at_floor, -0.5 * 0.02 + 1e-12);
      } else {
        EXPECT_NEAR(at_floor, 0.15, 1e-12);
      }
    }
    EXPECT_EQ(with_gaps, 2u);  // at the right, and in its corner with the floor
  }
}

// Of two openings that meet in an edge one's pocket is mirrored in the other's plane: behind both planes that fills the corner once.
TEST(TankImages, OfGhostsFillTheCornerBetweenTwoOpeningsOnce) {
  Case scene = with_opening(with_ghosts(box_case(Vector3d(0.5, 0, 0.5), 0.3, 0.02)), Vector3d(0.5, 0, 0.1), Vector3d(-1, 0, 0), 0.2);
  scene = with_opening(scene, Vector3d(0.4, 0, 0), Vector3d(0, 0, 1), 0.2);
  scene.openings[1].name = "floor";
  scene.openings[1].up = Vector3d::UnitX();
  Discretisation d;
  int mirrored = 0;
  for (const TankImage& image : images_of(scene, &d)) {
    if (image.gaps.size() != 1) continue;
    const PlaneGap& gap = image.gaps[0];
    const bool is_floor = gap.plane.normal.z() > 0.5;
    // of the other one's pocket
    const Vector3d behind = (is_floor ? Vector3d(0.53, 0, 0.1) : Vector3d(0.4, 0, -0.03)) - d.origin;
    if (std::abs(image.matrix.determinant() + 1) < 1e-9 && way_beside(gap, behind) > 0) ++mirrored;
  }
  EXPECT_EQ(mirrored, 1);
}

TEST(TankImages, AShortPeriodIsRefused) {
  expect_refusal(
      periodic_along(box_case(Vector3d(0.14, 0, 0.5), 0.2, 0.02), 0),
      {"tank/periodic", "only 0.14", "along x", "twice the kernel's support of 0.08", "make it longer or fluid/spacing smaller"});
  expect_refusal(periodic_along(box_case(Vector3d(0.5, 0.2, 0.5), 0.3, 0.05), 1),
                 {"tank/periodic", "only 0.2", "along y", "twice the kernel's support of 0.15", "make it longer or fluid/spacing smaller"});
  EXPECT_NO_THROW(images_of(periodic_along(box_case(Vector3d(0.16, 0, 0.5), 0.2, 0.02), 0)));
}

}  // namespace
}  // namespace wavetank::tank_images_test

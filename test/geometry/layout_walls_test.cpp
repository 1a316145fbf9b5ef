#include <Eigen/Geometry>
#include <algorithm>
#include <random>

#include "geometry_fixture.h"
#include "wavetank/geometry/thin_walls.h"

namespace wavetank::layout_walls_test {
namespace {

class LayoutWalls : public GeometryTest {
 protected:
  void add_body(Case& checked, const TriangleMesh& mesh, const std::string& name = "obstacle") const {
    BodyCase body;
    body.name = name;
    body.shape = source(write(name + ".obj", mesh));
    checked.bodies.push_back(body);
  }
  Case mesh_case(const TriangleMesh& tank, double spacing) const {
    Case checked;
    checked.tank.shape = source(write("tank.obj", tank));
    checked.fluid.spacing = spacing;
    return checked;
  }
};

TriangleMesh sphere(const Vector3d& centre, double radius, int rings) {
  TriangleMesh mesh;
  mesh.name = "sphere";
  const int sectors = 2 * rings;
  for (int i = 1; i < rings; ++i) {
    for (int j = 0; j < sectors; ++j) {
      const double polar = M_PI * i / rings, turn = 2 * M_PI * j / sectors;
      mesh.vertices.push_back(centre + radius * Vector3d(sin(polar) * cos(turn), sin(polar) * sin(turn), cos(polar)));
    }
  }
  const int top = static_cast<int>(mesh.vertices.size()), bottom = top + 1;
  mesh.vertices.push_back(centre + Vector3d(0, 0, radius));
  mesh.vertices.push_back(centre - Vector3d(0, 0, radius));
  for (int j = 0; j < sectors; ++j) {
    const int n = (j + 1) % sectors;
    mesh.triangles.emplace_back(top, j, n);
    for (int i = 0; i + 2 < rings; ++i) {
      mesh.triangles.emplace_back(i * sectors + j, (i + 1) * sectors + j, (i + 1) * sectors + n);
      mesh.triangles.emplace_back(i * sectors + j, (i + 1) * sectors + n, i * sectors + n);
    }
    mesh.triangles.emplace_back(bottom, (rings - 2) * sectors + n, (rings - 2) * sectors + j);
  }
  return mesh;
}

/// A vertical plate without thickness across the y direction.
TriangleMesh plate(double x, double y0, double y1, double z0, double z1) {
  TriangleMesh mesh;
  mesh.vertices = {Vector3d(x, y0, z0), Vector3d(x, y1, z0), Vector3d(x, y1, z1), Vector3d(x, y0, z1)};
  mesh.triangles = {Vector3i(0, 1, 2), Vector3i(0, 2, 3)};
  return mesh;
}

TEST_F(LayoutWalls, BoxTankIsARegularGridFacingOutwards) {
  const Layout layout = lay_out(box_case(Vector3d(1.0, 0.5, 0.7), 0.3, 0.05));
  EXPECT_NEAR(sums_of(layout, 0).area, 0.5 + 2 * 0.7 * 1.5, 1e-12);
  EXPECT_EQ(layout.walls.size(), 20u * 10 + 2 * 14 * 30);
  for (const WallElement& wall : layout.walls) {
    const Vector3d to_middle = Vector3d(0.5, 0.25, 0.35) - wall.centre;
    EXPECT_LT(wall.normal.dot(to_middle), 0);
    EXPECT_NEAR(wall.normal.norm(), 1, 1e-12);
    EXPECT_NEAR(wall.tangent.norm(), 1, 1e-12);
    EXPECT_NEAR(wall.normal.dot(wall.tangent), 0, 1e-12);
    EXPECT_NEAR(wall.tangent.cwiseAbs().maxCoeff(), 1, 1e-12) << "along an edge";
    EXPECT_NEAR(wall.area, 0.0025, 1e-12);
    EXPECT_EQ(wall.owner, 0);
  }
}

TEST_F(LayoutWalls, AClosedTankHasALid) {
  Case checked = box_case(Vector3d(1.0, 0.5, 0.7), 0.3, 0.05);
  std::get<BoxTank>(checked.tank.shape).closed = true;
  const Layout layout = lay_out(checked);
  const OwnerSums sums = sums_of(layout, 0);
  EXPECT_NEAR(sums.area, 2 * (0.5 + 0.35 + 0.7), 1e-12);
  EXPECT_LT(sums.flux.norm(), 1e-12);
  EXPECT_NEAR(sums.divergence, 3 * 0.35, 1e-12);
  EXPECT_FALSE(layout.open_top);
}

TEST_F(LayoutWalls, OnlyALidClosesATank) {
  Case checked = box_case(Vector3d(1, 0.5, 0.5), 0.4, 0.05);
  EXPECT_TRUE(lay_out(checked).open_top);
  std::get<BoxTank>(checked.tank.shape).closed = true;
  EXPECT_FALSE(lay_out(checked).open_top);
  checked.tank.shape = source(repository_mesh("sphere.stl"));
  checked.fluid.fill = {FloodFill{Vector3d(0, 0, -0.2), 0.1}};
  EXPECT_FALSE(lay_out(checked).open_top);
}

TEST_F(LayoutWalls, AreasOfAnyFlatRegionAreExact) {
  TriangleMesh tank;  // a trapezoidal trough with a sloping floor, triangles of very different sizes
  const double points[8][3] = {{0, 0, 0},       {2, 0, 0.31},   {2, 1.1, 0.31}, {0, 0.9, 0},
                               {-0.4, -0.2, 1}, {2.3, -0.3, 1}, {2.3, 1.3, 1},  {-0.4, 1.2, 1}};
  for (const auto& p : points) tank.vertices.emplace_back(p[0], p[1], p[2]);
  const int faces[5][4] = {{0, 1, 2, 3}, {0, 4, 5, 1}, {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}};
  for (const auto& f : faces) {
    tank.triangles.emplace_back(f[0], f[1], f[2]);
    tank.triangles.emplace_back(f[0], f[2], f[3]);
  }
  Case checked = mesh_case(tank, 0.037);
  checked.fluid.fill = {FloodFill{Vector3d(0.8, 0.5, 0.4), 0.6}};
  const Layout layout = lay_out(checked);
  // Faces that are not quite flat are two regions each; all of them are wetted from inside.
  EXPECT_NEAR(sums_of(layout, 0).area / surface_area(layout.meshes[0]), 1.0, 1e-9);
  for (const WallElement& wall : layout.walls) EXPECT_LT(wall.area, 2.0 * 0.037 * 0.037);
  EXPECT_LT(layout.walls.size(), 2.0 * surface_area(tank) / (0.037 * 0.037));
}

TEST_F(LayoutWalls, WindingAndOrderOfTrianglesDoNotMatter) {
  TriangleMesh tank = box_mesh({Vector3d::Zero(), Vector3d(1, 0.6, 0.5)}, true, "");
  TriangleMesh turned = tank;
  std::mt19937 random(7);
  std::shuffle(turned.triangles.begin(), turned.triangles.end(), random);
  for (std::size_t t = 0; t < turned.triangles.size(); ++t) {
    if (t % 3 != 1) std::swap(turned.triangles[t][0], turned.triangles[t][1]);
  }
  const auto elements = [&](const TriangleMesh& mesh) {
    Case checked = mesh_case(mesh, 0.1);
    checked.fluid.fill = {Box{Vector3d::Zero(), Vector3d(1, 0.6, 0.3)}};
    std::vector<std::vector<long>> sorted;
    for (const WallElement& wall : lay_out(checked).walls) {
      std::vector<long> key;
      for (int axis = 0; axis < 3; ++axis) {
        key.push_back(std::lround(wall.centre[axis] * 1e6));
        key.push_back(std::lround(wall.normal[axis] * 1e6));
        key.push_back(std::lround(wall.tangent[axis] * 1e6));
      }
      key.push_back(std::lround(wall.area * 1e9));
      sorted.push_back(key);
    }
    std::sort(sorted.begin(), sorted.end());
    return sorted;
  };
  const auto expected = elements(tank);
  EXPECT_EQ(expected.size(), 60u + 2 * 5 * 16);
  EXPECT_EQ(elements(turned), expected);
}

TEST_F(LayoutWalls, TheSameEveryTime) {
  Case checked = box_case(Vector3d(1, 1, 1), 0.6, 0.05);
  add_body(checked, sphere(Vector3d(0.5, 0.5, 0.5), 0.3, 24));
  const Layout first = lay_out(checked), second = lay_out(checked);
  ASSERT_EQ(first.walls.size(), second.walls.size());
  for (std::size_t w = 0; w < first.walls.size(); ++w) EXPECT_EQ((first.walls[w].centre - second.walls[w].centre).norm(), 0.0);
}

TEST_F(LayoutWalls, AFloatingBodyIsClosedAndFacesItsInside) {
  for (const bool round : {false, true}) {
    Case checked = box_case(Vector3d(1, 1, 1), 0.9, 0.05);
    const Vector3d middle(0.47, 0.52, 0.44);
    const Vector3d half(0.21, 0.17, 0.13);
    add_body(checked, round ? sphere(middle, 0.25, 30) : box_mesh({middle - half, middle + half}, false, ""));
    const Layout layout = lay_out(checked);
    const OwnerSums sums = sums_of(layout, 1);
    EXPECT_LT(sums.flux.norm(), 1e-9);
    const double volume = layout.meshes[1].signed_volume();
    EXPECT_NEAR(sums.divergence / (-3 * volume), 1.0, 1e-9);
    EXPECT_NEAR(sums.area / surface_area(layout.meshes[1]), 1.0, round ? 5e-3 : 1e-9);
    for (const WallElement& wall : layout.walls) {
      if (wall.owner == 1) EXPECT_GT(wall.normal.dot(middle - wall.centre), 0);
    }
  }
}

TEST_F(LayoutWalls, FineTrianglesDoNotMultiplyElements) {
  Case checked = box_case(Vector3d(1, 1, 1), 0.9, 0.05);
  const TriangleMesh fine = sphere(Vector3d(0.5, 0.5, 0.5), 0.3, 120);
  add_body(checked, fine);
  const OwnerSums sums = sums_of(lay_out(checked), 1);
  EXPECT_GT(fine.triangles.size(), 50000u);
  const double cells = surface_area(fine) / (0.05 * 0.05);
  EXPECT_LT(sums.count, 2.5 * cells);
  EXPECT_GT(sums.count, 0.8 * cells);
}

TEST_F(LayoutWalls, LongTrianglesAreCut) {
  Case checked = box_case(Vector3d(1, 1, 1), 0.9, 0.05);
  TriangleMesh wedge;  // a thin prism from end to end: needles 20 spacings long
  wedge.vertices = {Vector3d(0.05, 0.5, 0.5), Vector3d(0.05, 0.54, 0.5), Vector3d(0.05, 0.52, 0.54),
                    Vector3d(0.95, 0.5, 0.5), Vector3d(0.95, 0.54, 0.5), Vector3d(0.95, 0.52, 0.54)};
  wedge.triangles = {Vector3i(0, 2, 1), Vector3i(3, 4, 5), Vector3i(0, 1, 4), Vector3i(0, 4, 3),
                     Vector3i(1, 2, 5), Vector3i(1, 5, 4), Vector3i(2, 0, 3), Vector3i(2, 3, 5)};
  add_body(checked, wedge);
  const Layout layout = lay_out(checked);
  const OwnerSums sums = sums_of(layout, 1);
  EXPECT_NEAR(sums.area, surface_area(layout.meshes[1]), 1e-9);
  EXPECT_GE(sums.count, 3 * 18);
}

TEST_F(LayoutWalls, ABoxOnTheFloorUncoversExactlyItsFootprint) {
  Case checked = box_case(Vector3d(1, 1, 0.8), 0.5, 0.05);
  const Box box{Vector3d(0.312, 0.287, 0), Vector3d(0.668, 0.701, 0.2)};  // no side on a line of the floor's grid
  add_body(checked, box_mesh(box, false, ""));
  const Layout layout = lay_out(checked);
  const double lx = 0.356, ly = 0.414, lz = 0.2;
  EXPECT_NEAR(sums_of(layout, 1).area, lx * ly + 2 * lz * (lx + ly), 1e-7) << "its sides and top, not its bottom";
  EXPECT_NEAR(sums_of(layout, 0).area, 1 - lx * ly + 4 * 0.8, 1e-7) << "the floor without the footprint";
  for (const WallElement& wall : layout.walls) {
    const bool under = wall.centre.z() < 1e-9 && wall.centre.x() > box.min.x() && wall.centre.x() < box.max.x() &&
                       wall.centre.y() > box.min.y() && wall.centre.y() < box.max.y();
    EXPECT_FALSE(under) << wall.centre.transpose();
  }
}

TEST_F(LayoutWalls, ElementsBesideABoxAreRectanglesThatEndThere) {
  Case checked = box_case(Vector3d(1, 1, 0.8), 0.5, 0.05);
  const Box box{Vector3d(0.312, 0.287, 0), Vector3d(0.668, 0.701, 0.2)};
  add_body(checked, box_mesh(box, false, ""));
  int corners = 0;
  for (const WallElement& wall : lay_out(checked).walls) {
    const double gap = std::max(wall.gap[0], wall.gap[1]);
    if (gap > 1e-6) {  // a cell that a corner of the box takes a bite from
      ++corners;
      EXPECT_LT(gap, 0.025);
      continue;
    }
    if (wall.owner != 0 || wall.centre.z() > 1e-9) continue;
    const Vector3d along = wall.tangent.cwiseAbs(), across = wall.normal.cross(wall.tangent).cwiseAbs();
    const Vector3d half = 0.5 * (std::sqrt(wall.area * wall.elongation) * along + std::sqrt(wall.area / wall.elongation) * across);
    for (int axis = 0; axis < 2; ++axis) EXPECT_LT(half[axis], 0.5 * 0.0551) << "a sliver at most is joined to a cell";
    const bool beside =
        (wall.centre + half - box.min).head<2>().minCoeff() < 1e-6 || (box.max - (wall.centre - half)).head<2>().minCoeff() < 1e-6;
    EXPECT_TRUE(beside) << wall.centre.transpose() << " reaches under the box";
  }
  EXPECT_LE(corners, 4);
}

TEST_F(LayoutWalls, ABodyThroughAWallShowsOnlyItsPartInside) {
  Case checked = box_case(Vector3d(1, 1, 0.8), 0.5, 0.05);
  add_body(checked, box_mesh({Vector3d(-0.2, 0.4, 0.2), Vector3d(0.33, 0.6, 0.4)}, false, ""));
  const Layout layout = lay_out(checked);
  EXPECT_NEAR(sums_of(layout, 1).area, 0.04 + 4 * 0.2 * 0.33, 1e-7);
  EXPECT_NEAR(sums_of(layout, 0).area, 1 + 4 * 0.8 - 0.04, 1e-7);
}

TEST_F(LayoutWalls, ABodyFarOutOfTheTankIsSampledInItOnly) {
  Case checked = box_case(Vector3d(0.8, 0.6, 0.8), 0.3, 0.08);
  BodyCase body;
  body.name = "beam";
  for (const double length : {2.0, 1e4}) {
    for (const bool mesh : {false, true}) {
      if (mesh && length > 2) continue;  // taken for one in other units
      const Box box{Vector3d(0.3, 0.2, 0.1), Vector3d(0.5, length, 0.3)};
      if (mesh) {
        TriangleMesh beam = box_mesh(box, false, "");
        beam.vertices[7] += Vector3d(0.1, 0, 0);  // no rectangles
        body.shape = source(write("beam.obj", beam));
      } else {
        body.shape = box;
      }
      checked.bodies = {body};
      const Layout layout = lay_out(checked);
      EXPECT_NEAR(sums_of(layout, 1).area, 0.4 * 0.8 + 0.04, mesh ? 0.04 : 1e-5) << length;
      EXPECT_LT(sums_of(layout, 1).count, 120) << length;
    }
  }
  body.shape = Box{Vector3d(0.3, 0.2, 0.1), Vector3d(0.5, 1e9, 0.3)};
  checked.bodies = {body};
  EXPECT_ERROR(lay_out(checked), "body 'beam' reaches from (0.3, 0.2, 0.1) to (0.5, 1e+09, 0.3) m, too far for a particle spacing");
  body.shape = Box{Vector3d(0.3, 0.2, 0.1), Vector3d(0.5, 1e7, 0.3)};
  body.motion = Motion::free;
  checked.bodies = {body};
  EXPECT_ERROR(lay_out(checked), "too far for a particle spacing");
}

/// Of the facets and of the elements of an owner that face this way, the whole size, m² (2-D: m).
std::pair<double, double> sizes_facing(const Layout& layout, int owner, const Vector3d& way, int dimensions) {
  std::pair<double, double> sizes(0, 0);
  for (const Facet& facet : layout.facets) {
    if (facet.owner != owner || facet.normal.dot(way) < 0.99) continue;
    const Vector3d one = facet.corners[1] - facet.corners[0], other = facet.corners[2] - facet.corners[0];
    sizes.first += dimensions == 2 ? one.norm() : 0.5 * one.cross(other).norm();
  }
  for (const WallElement& element : layout.walls)
    if (element.owner == owner && element.normal.dot(way) > 0.99) sizes.second += element.area;
  return sizes;
}

/// Two boxes over a floor, so many spacings from it and from each other, 0.4 m long (3-D: and 0.2 m wide).
Case stacked_boxes(int dimensions, double spacing, double gap) {
  const double across = dimensions == 3 ? 0.4 : 0.0, inset = dimensions == 3 ? 0.1 : 0.0, low = gap * spacing;
  Case checked = box_case(Vector3d(0.8, across, 0.4), 0.3, spacing);
  checked.bodies = {box_body("lower", Vector3d(0.2, inset, low), Vector3d(0.6, across - inset, low + 0.08)),
                    box_body("upper", Vector3d(0.2, inset, 2 * low + 0.08), Vector3d(0.6, across - inset, 2 * low + 0.16))};
  return checked;
}

void expect_whole_faces(const Layout& layout, int dimensions) {
  const double face = dimensions == 3 ? 0.4 * 0.2 : 0.4, floor = dimensions == 3 ? 0.8 * 0.4 : 0.8;
  for (const auto& [owner, upward, size] :
       {std::tuple(0, -1, floor), std::tuple(1, 1, face), std::tuple(1, -1, face), std::tuple(2, 1, face), std::tuple(2, -1, face)}) {
    const auto [of_facets, of_elements] = sizes_facing(layout, owner, upward * Vector3d::UnitZ(), dimensions);
    EXPECT_NEAR(of_facets, size, 1e-6 * size) << "owner " << owner << ", way " << upward << ", " << dimensions << "-D";
    EXPECT_NEAR(of_elements, size, 1e-6 * size) << "owner " << owner << ", way " << upward << ", " << dimensions << "-D";
  }
}

/// From the middle of a face that a gap covers no open space was in sight: a whole floor was lost to a box a fifth of a spacing over it.
TEST_F(LayoutWalls, FacesAreWholeHoweverNarrowTheGapBeforeThem) {
  for (const int dimensions : {2, 3})
    for (const double gap : {0.02, 0.1, 0.2, 0.29, 0.31, 0.7}) {
      SCOPED_TRACE(gap);
      expect_whole_faces(lay_out(stacked_boxes(dimensions, 0.02, gap)), dimensions);
    }
}

/// In a tank of so many cells that the flood goes by whole spacings.
TEST_F(LayoutWalls, FacesAreWholeAlsoWhereTheFloodIsCoarse) { expect_whole_faces(lay_out(stacked_boxes(2, 0.001, 0.8)), 2); }

/// Likewise in one mesh, as far as its facets go: a slab a fifth of a spacing over the floor's middle.
TEST_F(LayoutWalls, AFloorUnderASlabOfItsOwnMeshIsWhole) {
  TriangleMesh tank = box_mesh(Box{Vector3d::Zero(), Vector3d(0.8, 0.4, 0.4)}, true, "tank");
  append(tank, box_mesh(Box{Vector3d(0.2, 0.1, 0.004), Vector3d(0.6, 0.3, 0.1)}, false, "slab"));
  Case checked = mesh_case(tank, 0.02);
  checked.fluid.fill = {FloodFill{Vector3d(0.1, 0.05, 0.1), 0.3}};
  const Layout layout = lay_out(checked);
  EXPECT_NEAR(sizes_facing(layout, 0, -Vector3d::UnitZ(), 3).first, 0.8 * 0.4 + 0.4 * 0.2, 1e-6);
}

/// But where bodies lie on each other no water is: those faces are no walls.
TEST_F(LayoutWalls, FacesOfBodiesThatTouchAreNone) {
  const Layout layout = lay_out(stacked_boxes(3, 0.02, 0));
  EXPECT_NEAR(sizes_facing(layout, 1, -Vector3d::UnitZ(), 3).first, 0, 1e-9);
  EXPECT_NEAR(sizes_facing(layout, 0, -Vector3d::UnitZ(), 3).second, 0.8 * 0.4 - 0.4 * 0.2, 1e-6);
}

TEST_F(LayoutWalls, SolidsOfOneBodyThatTouchAreClosedToTheWater) {
  // A post on a plinth with no common vertices, and a block that shares an edge with the plinth.
  Case checked = box_case(Vector3d(1, 1, 0.8), 0.7, 0.05);
  TriangleMesh mesh = box_mesh({Vector3d(0.3, 0.3, 0.2), Vector3d(0.7, 0.7, 0.3)}, false, "");
  append(mesh, box_mesh({Vector3d(0.4, 0.4, 0.3), Vector3d(0.6, 0.6, 0.5)}, false, ""));
  append(mesh, box_mesh({Vector3d(0.7, 0.3, 0.3), Vector3d(0.8, 0.7, 0.4)}, false, ""));
  BodyCase body;
  body.name = "plinth";
  body.shape = source(write("plinth.obj", mesh));
  checked.bodies = {body};
  for (const Motion motion : {Motion::fixed, Motion::free}) {
    checked.bodies[0].motion = motion;
    const Layout layout = lay_out(checked);
    const OwnerSums sums = sums_of(layout, 1);
    const double plinth = 2 * 0.16 + 4 * 0.04 - 0.04, post = 0.04 + 4 * 0.04, block = 2 * 0.04 + 2 * 0.04 + 2 * 0.01;
    EXPECT_NEAR(sums.area, plinth + post + block, 1e-5);
    EXPECT_LT(sums.flux.norm(), 1e-5);
    EXPECT_NEAR(sums.divergence, -3 * (0.016 + 0.008 + 0.004), 1e-5);
  }
}

TEST_F(LayoutWalls, ABaffleGetsAnElementOnEachSide) {
  TriangleMesh tank = box_mesh({Vector3d::Zero(), Vector3d(1, 0.5, 0.5)}, true, "");
  append(tank, plate(0.525, 0.1, 0.4, 0.1, 0.4));  // on a plane of the fill's lattice, through its middle
  Case checked = mesh_case(tank, 0.05);
  checked.fluid.fill = {Box{Vector3d::Zero(), Vector3d(1, 0.5, 0.45)}};
  const Layout layout = lay_out(checked);
  int left = 0, right = 0;
  for (const WallElement& wall : layout.walls) {
    if (std::abs(wall.centre.x() - 0.525) > 1e-6 || std::abs(wall.normal.x()) < 0.5) continue;
    (wall.normal.x() > 0 ? left : right) += 1;  // fluid on the left has its normal out of it to the right
  }
  EXPECT_EQ(left, 36);
  EXPECT_EQ(right, 36);
}

TEST_F(LayoutWalls, TheThinnestPlaceWithFluidOnBothSidesIsFound) {
  Case checked = box_case(Vector3d(1, 1, 0.8), 0.5, 0.05);
  EXPECT_FALSE(find_thin_parts(lay_out(checked), 3, 0.15).thinnest);
  checked.bodies = {{"thick", Box{Vector3d(0.1, 0.3, 0), Vector3d(0.3, 0.7, 0.3)}, Motion::fixed},
                    {"thin", Box{Vector3d(0.6, 0.2, 0), Vector3d(0.66, 0.8, 0.4)}, Motion::fixed}};
  const std::optional<ThinWall> thin = find_thin_parts(lay_out(checked), 3, 0.15).thinnest;
  ASSERT_TRUE(thin);
  EXPECT_EQ(thin->owner, 2);
  EXPECT_NEAR(thin->thickness, 0.06, 1e-9);
  EXPECT_FALSE(find_thin_parts(lay_out(checked), 3, 0.05).thinnest);

  TriangleMesh tank = box_mesh({Vector3d::Zero(), Vector3d(1, 0.5, 0.5)}, true, "");
  append(tank, plate(0.525, 0.1, 0.4, 0.1, 0.4));
  Case with_baffle = mesh_case(tank, 0.05);
  with_baffle.fluid.fill = {Box{Vector3d::Zero(), Vector3d(1, 0.5, 0.45)}};
  const std::optional<ThinWall> baffle = find_thin_parts(lay_out(with_baffle), 3, 0.15).thinnest;
  ASSERT_TRUE(baffle);
  EXPECT_EQ(baffle->owner, 0);
  EXPECT_NEAR(baffle->thickness, 0, 1e-9);
}

TEST_F(LayoutWalls, OfAThickWalledTankOnlyTheInnerSkinStays) {
  Case checked;
  checked.tank.shape = source(repository_mesh("l_tank.stl"));
  checked.fluid.spacing = 0.05;
  checked.fluid.fill = {FloodFill{Vector3d(0.2, 0.2, 0.1), 0.4}};
  const Layout layout = lay_out(checked);
  const double floor = 1.2 * 0.5 + 0.7 * 0.5, sides = 0.6 * 4.8;
  EXPECT_NEAR(sums_of(layout, 0).area, floor + sides, 1e-6);
  EXPECT_NEAR(total(layout.volumes), 0.4 * floor, 1e-6);
  for (const WallElement& wall : layout.walls) EXPECT_GT(wall.centre.z(), -1e-6);
  EXPECT_TRUE(layout.open_top) << "its skins enclose the walls, not the water";
}

TEST_F(LayoutWalls, RoundTanksFaceOutwards) {
  Case checked;
  checked.tank.shape = source(repository_mesh("cylinder_tank.stl"));
  checked.fluid.spacing = 0.05;
  checked.fluid.fill = {FloodFill{Vector3d(0, 0, 0.1), 0.5}};
  const Layout layout = lay_out(checked);
  EXPECT_NEAR(sums_of(layout, 0).area / surface_area(layout.meshes[0]), 1.0, 5e-3);
  EXPECT_LT(layout.walls.size(), 2.5 * surface_area(layout.meshes[0]) / 0.0025);
  for (const WallElement& wall : layout.walls) {
    const Vector3d outwards = wall.centre.z() < 1e-6 ? Vector3d(0, 0, -1) : Vector3d(wall.centre.x(), wall.centre.y(), 0).normalized();
    EXPECT_GT(wall.normal.dot(outwards), 0.95);
  }
  checked.tank.shape = source(repository_mesh("sphere.stl"));
  checked.fluid.fill = {FloodFill{Vector3d(0, 0, -0.2), 0.1}};
  const Layout ball = lay_out(checked);
  EXPECT_LT(sums_of(ball, 0).flux.norm(), 1e-9);
  EXPECT_NEAR(sums_of(ball, 0).divergence / (3 * std::abs(ball.meshes[0].signed_volume())), 1.0, 1e-9);
}

TEST_F(LayoutWalls, AKilometreAwayNothingChanges) {
  const auto spheric = [](const Vector3d& shift) {
    Case checked;
    MeshSource tank = source(repository_mesh("spheric2_tank.stl")), box = source(repository_mesh("spheric2_box.stl"));
    tank.translation = box.translation = shift;
    checked.tank.shape = tank;
    BodyCase body;
    body.name = "box";
    body.shape = box;
    checked.bodies = {body};
    checked.fluid.spacing = 0.05;
    checked.fluid.fill = {Box{Vector3d(1.992, 0, 0) + shift, Vector3d(3.22, 1, 0.55) + shift}};
    return lay_out(checked);
  };
  const Vector3d shift(1000, -1000, 1000);
  const Layout here = spheric(Vector3d::Zero()), there = spheric(shift);
  ASSERT_EQ(here.walls.size(), there.walls.size());
  ASSERT_EQ(here.lid.size(), there.lid.size());
  ASSERT_EQ(here.particles.size(), there.particles.size());
  for (std::size_t w = 0; w < here.walls.size(); ++w) {
    EXPECT_LT((here.walls[w].centre + shift - there.walls[w].centre).norm(), 1e-8);
    EXPECT_LT((here.walls[w].normal - there.walls[w].normal).norm(), 1e-6);
    EXPECT_NEAR(here.walls[w].area, there.walls[w].area, 1e-9);
  }
  for (std::size_t p = 0; p < here.particles.size(); ++p) EXPECT_LT((here.particles[p] + shift - there.particles[p]).norm(), 1e-9);
}

}  // namespace
}  // namespace wavetank::layout_walls_test

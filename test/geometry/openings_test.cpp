// Openings in walls: their pockets, the lattice beyond them, and those that cannot be.
#include <numeric>

#include "geometry_fixture.h"

namespace wavetank::openings_test {
namespace {

OpeningCase hole(const Vector3d& centre, const Vector3d& normal, double width, double height) {
  OpeningCase opening;
  opening.name = "hole";
  opening.velocity = "1";
  opening.centre = centre;
  opening.normal = normal;
  opening.size = std::array<double, 2>{width, height};
  return opening;
}

OpeningCase disc(const Vector3d& centre, const Vector3d& normal, double diameter) {
  OpeningCase opening = hole(centre, normal, 1, 1);
  opening.size.reset();
  opening.diameter = diameter;
  return opening;
}

Case flat_tank() {
  Case scene = box_case(Vector3d(2, 0, 1), 0.6, 0.1);
  scene.openings = {hole(Vector3d(0, 0, 0.5), Vector3d::UnitX(), 1, 0.4)};
  return scene;
}

Case solid_tank() {
  Case scene = box_case(Vector3d(2, 1, 1), 0.6, 0.1);
  scene.openings = {hole(Vector3d(2, 0.5, 0.3), -Vector3d::UnitX(), 0.4, 0.4)};
  return scene;
}

/// Of facets that face along an axis at a place on it, m (2-D) or m².
double wall_at(const Layout& layout, int axis, double place, int dimensions) {
  double size = 0;
  for (const Facet& facet : layout.facets) {
    if (std::abs(facet.normal[axis]) < 0.999 || std::abs(facet.plane_point[axis] - place) > 1e-6) continue;
    const Vector3d a = facet.corners[1] - facet.corners[0], b = facet.corners[2] - facet.corners[0];
    size += dimensions == 2 ? a.norm() : 0.5 * a.cross(b).norm();
  }
  return size;
}

/// Normal times size over all wall elements, out of the water: zero over a closed surface.
Vector3d flux(const Layout& layout) {
  Vector3d sum = Vector3d::Zero();
  for (const WallElement& wall : layout.walls) sum += wall.area * wall.normal;
  return sum;
}

class OpeningsTest : public GeometryTest {};

TEST_F(OpeningsTest, AreHolesWithAPocketIn2D) {
  const Layout layout = lay_out(flat_tank());
  ASSERT_EQ(layout.openings.size(), 1u);
  const Opening& opening = layout.openings[0];
  EXPECT_EQ(opening.rows, 5);  // the support of 4 spacings, and one
  EXPECT_NEAR(opening.pocket, 0.6, 1e-12);
  EXPECT_NEAR(opening.area, 0.4, 1e-12);
  EXPECT_EQ(opening.columns.size(), 4u);
  EXPECT_NEAR(wall_at(layout, 0, 0, 2), 0.6, 1e-9);
  EXPECT_NEAR(wall_at(layout, 0, -0.6, 2), 0.4, 1e-9);
  EXPECT_NEAR(wall_at(layout, 2, 0.3, 2), 0.6, 1e-9);
  EXPECT_NEAR(wall_at(layout, 2, 0.7, 2), 0.6, 1e-9);
  EXPECT_EQ(layout.domain.min.x(), 0);
  EXPECT_NEAR(flux(layout).x(), 0, 1e-9);
}

TEST_F(OpeningsTest, AreHolesWithAPocketIn3D) {
  const Layout whole = lay_out([] {
    Case scene = solid_tank();
    scene.openings.clear();
    return scene;
  }());
  const Layout layout = lay_out(solid_tank());
  EXPECT_NEAR(wall_at(layout, 0, 2, 3), wall_at(whole, 0, 2, 3) - 0.16, 1e-9);
  EXPECT_NEAR(wall_at(layout, 0, 2.5, 3), 0.16, 1e-9);  // 3 spacings of support, and two
  double area = 0, area_whole = 0;
  for (const WallElement& wall : layout.walls) area += wall.area;
  for (const WallElement& wall : whole.walls) area_whole += wall.area;
  EXPECT_NEAR(area, area_whole + 4 * 0.4 * 0.5, 1e-6);
  EXPECT_LT((flux(layout) - flux(whole)).norm(), 1e-9);
}

TEST_F(OpeningsTest, TheLatticeHasTheAreaOfTheOutline) {
  const double pi = std::acos(-1.0);
  for (const double diameter : {0.25, 0.4, 0.55}) {
    Case scene = solid_tank();
    scene.openings = {disc(Vector3d(2, 0.5, 0.4), -Vector3d::UnitX(), diameter)};
    const Opening opening = lay_out(scene).openings[0];
    double area = 0;
    Vector3d moment = Vector3d::Zero();
    for (const Opening::Column& column : opening.columns) {
      EXPECT_GT(column.area, 0.3 * 0.01);
      EXPECT_LT(column.area, 2.2 * 0.01);
      area += column.area;
      moment += column.area * (column.place - opening.centre);
    }
    EXPECT_NEAR(area, 0.25 * pi * diameter * diameter, 1e-9);
    EXPECT_LT(moment.norm(), 1e-9);
    EXPECT_EQ(opening.column_of.size(), static_cast<std::size_t>(opening.cells[0]) * opening.cells[1]);
  }
}

TEST_F(OpeningsTest, WaterBeyondStandsWhereThereIsWaterBefore) {
  Case scene = flat_tank();
  scene.openings[0].kind = OpeningKind::outlet;
  scene.openings[0].velocity.clear();
  scene.openings[0].size = std::array<double, 2>{1, 0.8};
  const Layout layout = lay_out(scene);
  EXPECT_EQ(layout.beyond, 5u * 5u);  // from 0.1 m to the level of 0.6 m, 5 rows deep
  double volume = 0;
  for (std::size_t i = layout.particles.size() - layout.beyond; i < layout.particles.size(); ++i) {
    EXPECT_LT(layout.particles[i].x(), 0);
    EXPECT_LT(layout.particles[i].z(), 0.6);
    EXPECT_NEAR(layout.levels[i], 0.6, 1e-12);
    volume += layout.volumes[i];
  }
  EXPECT_NEAR(volume, 0.5 * 0.5, 1e-12);
}

// The surface is 0.2 m lower before the opening than at the other end.
TEST_F(OpeningsTest, WaterBeyondStandsAsHighAsATroughBefore) {
  Case scene = flat_tank();
  scene.openings[0].kind = OpeningKind::outlet;
  scene.openings[0].velocity.clear();
  scene.openings[0].size = std::array<double, 2>{1, 0.8};
  scene.fluid.initial.elevation = "-0.1*cos(pi*x/2)";
  const Layout layout = lay_out(scene);
  ASSERT_GT(layout.beyond, 0u);
  const double trough = 0.6 - 0.1 * std::cos(M_PI * 0.05 / 2);  // over the first column
  double volume = 0;
  for (std::size_t i = layout.particles.size() - layout.beyond; i < layout.particles.size(); ++i) {
    EXPECT_LT(layout.particles[i].z(), trough);
    EXPECT_NEAR(layout.levels[i], trough, 1e-9);
    volume += layout.volumes[i];
  }
  EXPECT_NEAR(volume, 0.5 * (trough - 0.1), 1e-9);
}

TEST_F(OpeningsTest, ALevelIsBetweenTwoRows) {
  Case scene = flat_tank();
  scene.openings[0].centre.z() = 0.5;
  scene.openings[0].size = std::array<double, 2>{1, 0.9};
  scene.openings[0].level = 0.57;
  const Opening opening = lay_out(scene).openings[0];
  double area = 0;
  for (const Opening::Column& column : opening.columns) area += column.wet ? column.area : 0.0;
  EXPECT_NEAR(area, 0.57 - 0.05, 1e-12);
}

TEST_F(OpeningsTest, OfABodyHaveTheirPocketInIt) {
  Case scene = box_case(Vector3d(2, 1, 1), 0.3, 0.1);
  BodyCase nozzle;
  nozzle.name = "nozzle";
  nozzle.shape = Box{Vector3d(0.4, 0.2, 0.4), Vector3d(1.0, 0.8, 0.9)};
  scene.bodies = {nozzle};
  scene.openings = {disc(Vector3d(1.0, 0.5, 0.65), Vector3d::UnitX(), 0.3)};
  scene.openings[0].body = "nozzle";
  const Layout layout = lay_out(scene);
  EXPECT_EQ(layout.openings[0].owner, 1);
  EXPECT_NEAR(wall_at(layout, 0, 1.0, 3), 0.6 * 0.5 - layout.openings[0].area, 1e-9);
  EXPECT_NEAR(wall_at(layout, 0, 0.5, 3), layout.openings[0].area, 1e-9);
  EXPECT_GT(layout.beyond, 0u);
  scene.openings[0].centre.x() = 0.8;
  EXPECT_ERROR(lay_out(scene), "does not lie in a flat wall of body 'nozzle'");
}

TEST_F(OpeningsTest, ThatCannotBeAreRefused) {
  const auto with = [](Case scene, const std::function<void(OpeningCase&)>& change) {
    change(scene.openings[0]);
    return scene;
  };
  EXPECT_ERROR(lay_out(with(flat_tank(), [](OpeningCase& o) { o.centre.x() = 0.2; })),
               "opening 'hole' at (0.2, 0, 0.5) m does not lie in a flat wall of the tank: of its 0.4 m, 0 m are on one");
  EXPECT_ERROR(lay_out(with(flat_tank(), [](OpeningCase& o) { o.centre.z() = 0.9; })), "of its 0.4 m, 0.3 m are on one");
  EXPECT_ERROR(lay_out(with(solid_tank(), [](OpeningCase& o) { o.centre.y() = 0.9; })), "of its 0.16 m², 0.12 m² are on one");
  EXPECT_ERROR(lay_out(with(solid_tank(), [](OpeningCase& o) { o.normal = Vector3d(-1, 0.1, 0); })), "does not lie in a flat wall");
  EXPECT_ERROR(lay_out(with(flat_tank(), [](OpeningCase& o) { o.normal = -o.normal; })),
               "opens where no water can come to, about (-0.05, 0, 0.35) m; its normal must point into the water");
  EXPECT_ERROR(lay_out(with(flat_tank(),
                            [](OpeningCase& o) {
                              o.size = std::array<double, 2>{1, 0.15};
                            })),
               "is narrower than two spacings of 0.1 m");
  Case overlapping = flat_tank();
  overlapping.openings.push_back(overlapping.openings[0]);
  overlapping.openings[1].name = "other";
  overlapping.openings[1].centre.z() += 0.2;
  EXPECT_ERROR(lay_out(overlapping), "overlaps opening 'other'");
}

TEST_F(OpeningsTest, PocketsThatMeetWaterOrBodiesAreRefused) {
  Case scene = box_case(Vector3d(2, 1, 1), 0.6, 0.1);
  BodyCase wall;
  wall.name = "wall";
  wall.shape = Box{Vector3d(0.9, 0, 0), Vector3d(1.1, 1, 0.9)};
  scene.bodies = {wall};
  scene.openings = {hole(Vector3d(1.1, 0.5, 0.3), Vector3d::UnitX(), 0.4, 0.4)};
  scene.openings[0].body = "wall";
  EXPECT_ERROR(lay_out(scene), "takes a pocket of 0.5 m behind it, which meets the space that water can reach");
  scene.openings[0].body.clear();
  EXPECT_ERROR(lay_out(scene), "does not lie in a flat wall of the tank");
  Case inside = box_case(Vector3d(2, 1, 1), 0.6, 0.1);
  BodyCase block;
  block.name = "block";
  block.shape = Box{Vector3d(0, 0.2, 0), Vector3d(0.5, 0.8, 0.9)};
  inside.bodies = {block};
  inside.openings = {hole(Vector3d(0, 0.5, 0.4), Vector3d::UnitX(), 0.4, 0.4)};
  EXPECT_ERROR(lay_out(inside), "opens into body 'block'");
}

TEST_F(OpeningsTest, PocketsOfBodiesStayInTheTank) {
  Case scene = box_case(Vector3d(2, 0, 1), 0.6, 0.1);
  scene.fluid.fill = {Box{Vector3d(0.5, 0, 0), Vector3d(2, 0, 0.6)}};
  BodyCase piston;
  piston.name = "piston";
  piston.shape = Box{Vector3d(-0.8, 0, 0), Vector3d(0.2, 0, 0.9)};
  scene.bodies = {piston};
  scene.openings = {hole(Vector3d(0.2, 0, 0.3), Vector3d::UnitX(), 1, 0.4)};
  scene.openings[0].body = "piston";
  EXPECT_ERROR(lay_out(scene), "takes a pocket of 0.6 m behind it, which passes through a wall of the tank");
}

/// A box tank of 2 m × 1 m × 1 m as a file, whose wall at x = 0 has a part "port" of these corners (y, z), and whatever is left of it as
/// another.
class PartsTest : public GeometryTest {
 protected:
  using Corners = std::vector<std::array<double, 2>>;

  Case tank_with_port(const std::string& port_faces, const Corners& port, int dimensions = 3) const {
    const int last = static_cast<int>(port.size());
    std::string text = "o walls\n";
    for (const double x : {0.0, 2.0})
      for (const double y : {-0.5, 0.5})
        for (const double z : {0.0, 1.0}) text += "v " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
    for (const auto& [y, z] : port) text += "v 0 " + std::to_string(y) + " " + std::to_string(z) + "\n";
    text += "f 1 5 7 3\nf 1 2 6 5\nf 3 7 8 4\nf 5 6 8 7\n";  // floor, sides, far end; the top is open
    // the wall about the port, as a fan from its corners: a quadrilateral between each side and the one of the wall that it faces
    const int wall[4] = {1, 3, 4, 2};
    for (int k = 0; k < 4; ++k) {
      const int a = wall[k], b = wall[(k + 1) % 4];
      const int p = 9 + k * last / 4, q = 9 + (k + 1) * last / 4 % last;
      text += "f " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(q);
      for (int v = (q == 9 ? 9 + last : q) - 1; v >= p; --v) text += " " + std::to_string(v);
      text += "\n";
    }
    text += "o port\n" + port_faces;
    Case scene = box_case(Vector3d(2, dimensions == 2 ? 0.0 : 1.0, 1), 0.6, 0.1);
    scene.fluid.fill = {Box{Vector3d(0, dimensions == 2 ? 0 : -0.5, 0), Vector3d(2, dimensions == 2 ? 0 : 0.5, 0.6)}};
    scene.tank.shape = source(write("tank.obj", text));
    OpeningCase opening;
    opening.name = "hole";
    opening.velocity = "1";
    opening.part = "port";
    scene.openings = {opening};
    return scene;
  }

  const Corners square{{-0.2, 0.2}, {0.2, 0.2}, {0.2, 0.6}, {-0.2, 0.6}};
};

TEST_F(PartsTest, ARectangleIsAsIfItWereGivenByItsSize) {
  for (const int dimensions : {2, 3}) {
    const Case by_part = tank_with_port("f 9 10 11 12\n", square, dimensions);
    Case by_size = by_part;
    by_size.openings = {hole(Vector3d(0, 0, 0.4), Vector3d::UnitX(), 0.4, 0.4)};
    const Layout a = lay_out(by_part), b = lay_out(by_size);
    const Opening &part = a.openings[0], &size = b.openings[0];
    EXPECT_EQ(part.shape, Opening::Shape::rectangle);
    EXPECT_LT((part.normal - Vector3d::UnitX()).norm(), 1e-9);
    EXPECT_LT((part.centre - size.centre).norm(), 1e-6);
    EXPECT_NEAR(part.area, size.area, 1e-6);
    EXPECT_EQ(part.columns.size(), size.columns.size());
    EXPECT_NEAR(wall_at(a, 0, 0, dimensions), wall_at(b, 0, 0, dimensions), 1e-6);
    EXPECT_EQ(a.particles.size(), b.particles.size());
  }
}

TEST_F(PartsTest, APolygonHasColumnsOfItsArea) {
  const Corners octagon{{-0.25, 0.2}, {0.0, 0.1}, {0.25, 0.2}, {0.3, 0.5}, {0.2, 0.7}, {-0.2, 0.7}, {-0.3, 0.6}, {-0.3, 0.4}};
  const Layout layout = lay_out(tank_with_port("f 9 10 11 12 13 14 15 16\n", octagon));
  const Opening& opening = layout.openings[0];
  EXPECT_EQ(opening.shape, Opening::Shape::polygon);
  double area = 0;
  for (std::size_t k = 0; k < octagon.size(); ++k) {
    const auto &p = octagon[k], &q = octagon[(k + 1) % octagon.size()];
    area += 0.5 * (p[0] * q[1] - q[0] * p[1]);
  }
  EXPECT_NEAR(opening.area, area, 1e-6);
  EXPECT_NEAR(wall_at(layout, 0, 0, 3), 1 - area, 1e-6);
  EXPECT_NEAR(wall_at(layout, 0, -0.5, 3), area, 1e-6);
}

// Outside of a body is the water, whichever way its faces are wound in the file; and a part may have its own direction up.
TEST_F(PartsTest, OfABodyFacesOutwards) {
  const auto box_with_port = [](bool inside_out) {
    std::string text;
    for (const double x : {0.4, 1.2})
      for (const double y : {-0.3, 0.3})
        for (const double z : {0.5, 1.0}) text += "v " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
    for (const auto& [y, z] : Corners{{-0.15, 0.6}, {0.15, 0.6}, {0.15, 0.9}, {-0.15, 0.9}})
      text += "v 1.2 " + std::to_string(y) + " " + std::to_string(z) + "\n";
    const std::vector<std::array<int, 4>> faces{{1, 2, 4, 3},  {1, 5, 6, 2},   {3, 4, 8, 7},   {1, 3, 7, 5},  {2, 6, 8, 4},
                                                {5, 7, 10, 9}, {7, 8, 11, 10}, {8, 6, 12, 11}, {6, 5, 9, 12}, {9, 10, 11, 12}};
    text += "o hull\n";
    for (std::size_t f = 0; f < faces.size(); ++f) {
      auto [a, b, c, d] = faces[f];
      if (inside_out) std::swap(b, d);
      if (f + 1 == faces.size()) text += "o port\n";
      text += "f " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + " " + std::to_string(d) + "\n";
    }
    return text;
  };
  for (const bool inside_out : {false, true}) {
    Case scene = box_case(Vector3d(3, 1, 1.5), 0.3, 0.1);
    BodyCase nozzle;
    nozzle.name = "nozzle";
    MeshSource mesh = source(write(inside_out ? "out.obj" : "in.obj", box_with_port(inside_out)));
    mesh.translation = Vector3d(0, 0.5, 0);
    nozzle.shape = mesh;
    scene.bodies = {nozzle};
    OpeningCase opening;
    opening.name = "hole";
    opening.body = "nozzle";
    opening.velocity = "1";
    opening.part = "port";
    opening.up = Vector3d::UnitY();
    scene.openings = {opening};
    const Opening found = lay_out(scene).openings[0];
    EXPECT_LT((found.normal - Vector3d::UnitX()).norm(), 1e-9) << inside_out;
    EXPECT_LT((found.up - Vector3d::UnitY()).norm(), 1e-9);
    EXPECT_LT((found.centre - Vector3d(1.2, 0.5, 0.75)).norm(), 1e-6);
    EXPECT_NEAR(found.area, 0.09, 1e-6);
    scene.openings[0].up = Vector3d::UnitX();
    EXPECT_ERROR(lay_out(scene), "faces along up, which must be a direction within it");
  }
}

TEST_F(PartsTest, ThatCannotBeAreRefused) {
  Case scene = tank_with_port("f 9 10 11 12\n", square);
  scene.openings[0].part = "prot";
  EXPECT_ERROR(lay_out(scene), "opening 'hole' is to be part 'prot' of mesh 'tank.obj', which has the parts");
  EXPECT_ERROR(lay_out(scene), "port");
  scene.openings[0].part = "port";
  scene.openings[0].normal = Vector3d::UnitZ();
  EXPECT_ERROR(lay_out(scene), "not along the normal given");
  scene.openings[0].normal = -Vector3d::UnitX();
  EXPECT_ERROR(lay_out(scene), "its normal must point into the water");
  EXPECT_ERROR(lay_out(tank_with_port("f 9 10 11 12\nf 1 3 9\n", square)), "it must be convex and without holes");
  EXPECT_ERROR(lay_out(tank_with_port("f 9 10 11 12\nf 9 10 5\n", square)), "is not flat: its corner at");
}

}  // namespace
}  // namespace wavetank::openings_test

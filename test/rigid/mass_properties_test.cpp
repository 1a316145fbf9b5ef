// Volume, centre and inertia of meshes against formulae, and what a case may say of a body's mass.
#include "wavetank/rigid/mass_properties.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <map>

#include "../geometry/geometry_fixture.h"

namespace wavetank::mass_properties_test {
namespace {

using Eigen::Matrix3d;

// Sums of a dozen terms of the size of the result: a few units of rounding each.
constexpr double rounding = 1e-14;

TriangleMesh box(const Vector3d& min, const Vector3d& max) { return box_mesh({min, max}, false, "box"); }

/// Of a solid box of density 1 about its centre.
Matrix3d box_inertia(const Vector3d& size) {
  const Vector3d squares = size.cwiseProduct(size);
  return size.prod() / 12.0 * Matrix3d((squares.sum() * Vector3d::Ones() - squares).asDiagonal());
}

/// An icosahedron whose triangles are cut in four again and again, its corners on a sphere of radius 1.
TriangleMesh icosphere(int cuts) {
  TriangleMesh mesh;
  mesh.name = "icosphere";
  const double golden = 0.5 * (1 + std::sqrt(5.0));
  for (const double a : {-1.0, 1.0}) {
    for (const double b : {-golden, golden}) {
      mesh.vertices.push_back(Vector3d(0, a, b).normalized());
      mesh.vertices.push_back(Vector3d(a, b, 0).normalized());
      mesh.vertices.push_back(Vector3d(b, 0, a).normalized());
    }
  }
  const double edge = 2 / std::sqrt(golden * golden + 1);
  const auto joined = [&](int i, int j) { return std::abs((mesh.vertices[i] - mesh.vertices[j]).norm() - edge) < 1e-9; };
  for (int i = 0; i < 12; ++i) {
    for (int j = i + 1; j < 12; ++j) {
      for (int k = j + 1; k < 12; ++k) {
        if (!joined(i, j) || !joined(j, k) || !joined(i, k)) continue;
        const bool outwards = mesh.vertices[i].dot(mesh.vertices[j].cross(mesh.vertices[k])) > 0;
        mesh.triangles.emplace_back(i, outwards ? j : k, outwards ? k : j);
      }
    }
  }
  for (int cut = 0; cut < cuts; ++cut) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [entry, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<int>(mesh.vertices.size()));
      if (is_new) mesh.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]).normalized());
      return entry->second;
    };
    std::vector<Vector3i> finer;
    for (const Vector3i& t : mesh.triangles) {
      const int a = middle(t[0], t[1]), b = middle(t[1], t[2]), c = middle(t[2], t[0]);
      finer.insert(finer.end(), {{t[0], a, c}, {a, t[1], b}, {c, b, t[2]}, {a, b, c}});
    }
    mesh.triangles = finer;
  }
  return mesh;
}

void turn_over(TriangleMesh& mesh) {
  for (Vector3i& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
}

TEST(VolumeProperties, OfABox) {
  const Vector3d size(0.4, 1.1, 2.3), min(-0.1, 0.2, -3.0);
  const VolumeProperties found = volume_properties(box(min, min + size));
  EXPECT_NEAR(found.volume, size.prod(), rounding * size.prod());
  EXPECT_LT((found.centre - min - 0.5 * size).norm(), rounding);
  EXPECT_LT((found.inertia - box_inertia(size)).norm(), rounding * box_inertia(size).norm());
}

TEST(VolumeProperties, OfATetrahedron) {
  const double a = 0.7, b = 1.3, c = 0.9, volume = a * b * c / 6;
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {a, 0, 0}, {0, b, 0}, {0, 0, c}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  const VolumeProperties found = volume_properties(mesh);
  Matrix3d inertia;  // ∫x² dV = 3 a² V/80 and ∫x y dV = −a b V/80 about the centre
  inertia << 3 * (b * b + c * c), a * b, a * c, a * b, 3 * (a * a + c * c), b * c, a * c, b * c, 3 * (a * a + b * b);
  inertia *= volume / 80;
  EXPECT_NEAR(found.volume, volume, rounding * volume);
  EXPECT_LT((found.centre - Vector3d(a, b, c) / 4).norm(), rounding);
  EXPECT_LT((found.inertia - inertia).norm(), rounding * inertia.norm());
}

TEST(VolumeProperties, OfASphereOfTrianglesFallShortByTheSegmentsCutOff) {
  const TriangleMesh mesh = icosphere(3);
  const VolumeProperties found = volume_properties(mesh);
  double deficit = 0, longest = 0;  // a triangle of sides a, b, c lies (a² + b² + c²)/24 below the sphere on average, to the first order
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vector3d a = mesh.corner(t, 1) - mesh.corner(t, 0), b = mesh.corner(t, 2) - mesh.corner(t, 1), c = a + b;
    deficit += 0.5 * a.cross(b).norm() * (a.squaredNorm() + b.squaredNorm() + c.squaredNorm()) / 24;
    longest = std::max({longest, a.norm(), b.norm(), c.norm()});
  }
  const double next_order = longest * longest;  // relative to the deficit
  EXPECT_NEAR(4 * M_PI / 3 - found.volume, deficit, next_order * deficit);
  const double inertia = 8 * M_PI / 15 - 2.0 / 3.0 * deficit;  // a thin layer of volume V at radius 1 has 2/3 V
  EXPECT_LT((found.inertia - inertia * Matrix3d::Identity()).norm(), next_order * deficit);
  // The icosahedron's symmetry leaves no axis preferred; 1280 triangles' rounding.
  EXPECT_LT((found.inertia - found.inertia(0, 0) * Matrix3d::Identity()).norm(), 100 * rounding);
  EXPECT_LT(found.centre.norm(), 100 * rounding);
}

TEST(VolumeProperties, OfATiltedBoxTurnWithIt) {
  const Vector3d size(0.4, 1.1, 2.3);
  const Matrix3d rotation =
      (Eigen::AngleAxisd(0.7, Vector3d(1, -2, 0.5).normalized()) * Eigen::AngleAxisd(0.3, Vector3d::UnitX())).matrix();
  TriangleMesh mesh = box(-0.5 * size, 0.5 * size);
  const Vector3d place(3, -2, 1);
  for (Vector3d& vertex : mesh.vertices) vertex = rotation * vertex + place;
  const VolumeProperties found = volume_properties(mesh);
  const Matrix3d inertia = box_inertia(size);
  EXPECT_LT((found.centre - place).norm(), 10 * rounding);
  EXPECT_LT((found.inertia - rotation * inertia * rotation.transpose()).norm(), 10 * rounding * inertia.norm());
  Vector3d moments = inertia.diagonal();
  std::sort(moments.data(), moments.data() + 3);
  EXPECT_LT((Eigen::SelfAdjointEigenSolver<Matrix3d>(found.inertia).eigenvalues() - moments).norm(), 10 * rounding * inertia.norm());
}

TEST(VolumeProperties, FarFromTheOriginLoseNoDigits) {
  const Vector3d size(0.5, 0.25, 2), far(1e6, -3e6, 2e6);  // the corners are exact binary numbers; their cubes would have lost all digits
  const VolumeProperties found = volume_properties(box(far, far + size));
  EXPECT_NEAR(found.volume, size.prod(), rounding * size.prod());
  EXPECT_LT((found.centre - far - 0.5 * size).norm(), 1e-9);  // the last digit of 3e6
  EXPECT_LT((found.inertia - box_inertia(size)).norm(), rounding * box_inertia(size).norm());
}

/// Of boxes of density 1, by signed terms that count once what they have in common.
VolumeProperties sum_of_boxes(const std::vector<std::pair<double, Box>>& terms) {
  VolumeProperties sum;
  Vector3d moment = Vector3d::Zero();
  for (const auto& [sign, box] : terms) {
    const Vector3d size = box.max - box.min;
    sum.volume += sign * size.prod();
    moment += sign * size.prod() * 0.5 * (box.min + box.max);
  }
  sum.centre = moment / sum.volume;
  for (const auto& [sign, box] : terms) {
    const Vector3d size = box.max - box.min, arm = 0.5 * (box.min + box.max) - sum.centre;
    sum.inertia += sign * (box_inertia(size) + size.prod() * (arm.squaredNorm() * Matrix3d::Identity() - arm * arm.transpose()));
  }
  return sum;
}

/// Bars that cross, solids that touch, that hold one another, or lie on each other, each with what it is in boxes that count once.
struct Joined {
  std::string what;
  std::vector<Box> solids, cavities;
  std::vector<std::pair<double, Box>> once;
};
std::vector<Joined> joined_solids() {
  const Box bar{{-0.2, -0.05, -0.05}, {0.2, 0.05, 0.05}}, across{{-0.05, -0.2, -0.05}, {0.05, 0.2, 0.05}},
      post{{-0.03, -0.04, -0.3}, {0.07, 0.03, 0.2}}, cube{{0, -0.5, 0}, {1, 0.5, 1}}, next{{1, -0.5, 0}, {2, 0.5, 1}},
      foot{{1, -0.3, 0.2}, {2, 0.1, 0.7}}, further{{0.5, -0.5, 0}, {1.5, 0.5, 1}}, within{{0.2, -0.3, 0.2}, {0.8, 0.3, 0.8}},
      flush{{0, -0.3, 0.2}, {0.8, 0.3, 0.8}}, pin{{0.4, -0.1, 0.4}, {0.6, 0.1, 1.5}}, inner_pin{{0.4, -0.1, 0.4}, {0.6, 0.1, 0.8}},
      outer_pin{{0.4, -0.1, 1}, {0.6, 0.1, 1.5}};
  return {{"bars that cross in one plane", {bar, across}, {}, {{1, bar}, {1, across}, {-1, {{-0.05, -0.05, -0.05}, {0.05, 0.05, 0.05}}}}},
          {"bars that cross", {bar, post}, {}, {{1, bar}, {1, post}, {-1, {{-0.03, -0.04, -0.05}, {0.07, 0.03, 0.05}}}}},
          {"cubes side by side", {cube, next}, {}, {{1, cube}, {1, next}}},
          {"a foot on a cube", {cube, foot}, {}, {{1, cube}, {1, foot}}},
          {"cubes that overlap", {cube, further, next}, {}, {{1, cube}, {1, next}}},
          {"a cube in a cube", {cube, within}, {}, {{1, cube}}},
          {"a cube flush in a cube", {cube, flush}, {}, {{1, cube}}},
          {"a cube twice", {cube, cube}, {}, {{1, cube}}},
          {"a cavity", {cube}, {within}, {{1, cube}, {-1, within}}},
          {"a pin through the wall of a cavity", {cube, pin}, {within}, {{1, cube}, {-1, within}, {1, inner_pin}, {1, outer_pin}}}};
}

TEST(VolumeProperties, CountOnceWhatSolidsHaveInCommon) {
  for (const Joined& joined : joined_solids())
    for (const bool tilted : {false, true}) {
      TriangleMesh mesh;
      for (const Box& solid : joined.solids) append(mesh, box_mesh(solid, false, ""));
      for (const Box& cavity : joined.cavities) {
        TriangleMesh hole = box_mesh(cavity, false, "");
        turn_over(hole);
        append(mesh, hole);
      }
      VolumeProperties right = sum_of_boxes(joined.once);
      if (tilted) {  // and rounded, as float32 files have it
        const Matrix3d turn = Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
        for (Vector3d& vertex : mesh.vertices) vertex = (turn * vertex).cast<float>().cast<double>();
        right.centre = turn * right.centre;
        right.inertia = turn * right.inertia * turn.transpose();
      }
      const VolumeProperties found = volume_properties(mesh);
      const double tolerance = tilted ? 1e-6 : 1e-12;
      EXPECT_NEAR(found.volume, right.volume, tolerance * right.volume) << joined.what << (tilted ? ", tilted" : "");
      EXPECT_LT((found.centre - right.centre).norm(), tolerance) << joined.what << (tilted ? ", tilted" : "");
      EXPECT_LT((found.inertia - right.inertia).norm(), 3 * tolerance * right.inertia.norm()) << joined.what << (tilted ? ", tilted" : "");
    }
}

TEST(VolumeProperties, OfBallsThatOverlap) {
  const double apart = 0.8;
  const TriangleMesh ball = icosphere(4);
  TriangleMesh both = ball, other = ball;
  for (Vector3d& vertex : other.vertices) vertex.x() += apart;
  append(both, other);
  const double one = 4 * M_PI / 3, lens = M_PI / 12 * (4 + apart) * std::pow(2 - apart, 2), lack = 1 - volume_properties(ball).volume / one;
  const VolumeProperties found = volume_properties(both);
  EXPECT_NEAR(found.volume, 2 * one - lens, 1.2 * lack * (2 * one - lens)) << "lack of a ball: " << lack;
  EXPECT_LT((found.centre - Vector3d(0.5 * apart, 0, 0)).norm(), 1e-3);
}

TEST(AreaProperties, CountOnceWhatSolidsHaveInCommon) {
  TriangleMesh mesh = box({-0.2, -0.05, -0.05}, {0.2, 0.05, 0.05});
  append(mesh, box({-0.03, -0.02, -0.3}, {0.07, 0.03, 0.2}));
  const VolumeProperties found = area_properties(mesh);
  const double area = 0.04 + 0.05 - 0.01;
  EXPECT_NEAR(found.volume, area, 1e-12);
  EXPECT_LT((found.centre - Vector3d(0.02 * 0.05 - 0.02 * 0.01, 0, -0.05 * 0.05) / area).norm(), 1e-12);
}

TEST(AreaProperties, OfABoxesSectionWhereverItsWidthLies) {
  const double a = 0.4, c = 2.3;
  const Vector3d low(1, 0, -3);
  for (const auto& [from, to] : {std::pair(-0.3, 0.2), {0.0, 0.5}, {-0.5, 0.0}}) {  // across the plane, and with a side in it
    const VolumeProperties found = area_properties(box(low + Vector3d(0, from, 0), low + Vector3d(a, to, c)));
    EXPECT_NEAR(found.volume, a * c, rounding);
    EXPECT_LT((found.centre - low - Vector3d(a / 2, 0, c / 2)).norm(), 10 * rounding);
    EXPECT_NEAR(found.inertia(1, 1), a * c * (a * a + c * c) / 12, rounding);
    Matrix3d rest = found.inertia;
    rest(1, 1) = 0;
    EXPECT_EQ(rest.norm(), 0.0);
  }
}

TEST(AreaProperties, LeaveOutAHole) {
  TriangleMesh ring = box({-1, -0.5, -1}, {1, 0.5, 1}),
               hole = box({0, -0.25, -0.5}, {0.5, 0.25, 0.5});  // a cavity: the section cannot tell
  turn_over(hole);
  append(ring, hole);
  const VolumeProperties found = area_properties(ring);
  const double area = 4 - 0.5, centre = -0.5 * 0.25 / area;
  const double inertia = 4 * 8.0 / 12 - (0.5 * 1.25 / 12 + 0.5 * 0.25 * 0.25) - area * centre * centre;
  EXPECT_NEAR(found.volume, area, 10 * rounding);
  EXPECT_LT((found.centre - Vector3d(centre, 0, 0)).norm(), 10 * rounding);
  EXPECT_NEAR(found.inertia(1, 1), inertia, 10 * rounding);
}

TEST(AreaProperties, OfABallAreThoseOfAPolygonInACircle) {
  const VolumeProperties found = area_properties(icosphere(4));
  // The section's corners lie on chords of the mesh, whose edges are at most 0.09 long: no deeper than 0.09²/4 below the circle.
  const double depth = 0.002;
  EXPECT_LT(found.volume, M_PI);
  EXPECT_GT(found.volume, M_PI * std::pow(1 - depth, 2));
  EXPECT_LT(found.inertia(1, 1), M_PI / 2);
  EXPECT_GT(found.inertia(1, 1), M_PI / 2 * std::pow(1 - depth, 4));
  EXPECT_LT(found.centre.norm(), 100 * rounding);
}

TEST(AreaProperties, RefuseAMeshBesideThePlane) {
  EXPECT_ERROR(area_properties(box({0, 0.1, 0}, {1, 0.6, 1})), "mesh 'box' has no section with the plane y = 0");
  EXPECT_ERROR(area_properties(box({0, 0.1, 0}, {1, 0.6, 1})), "from 0.1 to 0.6 m");
}

class MassPropertiesOfABox : public ::testing::Test {
 protected:
  const Vector3d size{0.4, 1.0, 2.0};
  const TriangleMesh mesh = box({1, -0.5, 0}, {1.4, 0.5, 2});
  RigidCase rigid;

  MassProperties found(int dimensions = 3, bool free = true) const { return mass_properties(rigid, mesh, dimensions, "body 'hull'", free); }
  std::string refusal(int dimensions = 3) const {
    return error_of([&] { mass_properties(rigid, mesh, dimensions, "body 'hull'"); });
  }
};

TEST_F(MassPropertiesOfABox, FromItsDensityOrItsMass) {
  rigid.density = 500;
  const MassProperties dense = found();
  EXPECT_NEAR(dense.volume, 0.8, rounding);
  EXPECT_NEAR(dense.mass, 400, 1e3 * rounding);
  EXPECT_LT((dense.centre - Vector3d(1.2, 0, 1)).norm(), 10 * rounding);
  EXPECT_LT((dense.inertia - 500 * box_inertia(size)).norm(), 1e3 * rounding);
  rigid.density = {};
  rigid.mass = 100;
  EXPECT_EQ(found().mass, 100.0);
  EXPECT_LT((found().inertia - 125 * box_inertia(size)).norm(), 1e3 * rounding);
}

TEST_F(MassPropertiesOfABox, PerMetreOfWidthInTwoDimensions) {
  rigid.density = 500;
  const MassProperties flat = found(2);
  EXPECT_NEAR(flat.volume, 0.8, rounding);
  EXPECT_NEAR(flat.mass, 400, 1e3 * rounding);
  EXPECT_EQ(flat.centre.y(), 0.0);
  EXPECT_NEAR(flat.inertia(1, 1), 400 * (0.4 * 0.4 + 4) / 12, 1e3 * rounding);
  EXPECT_EQ(flat.inertia.norm(), flat.inertia(1, 1));
  rigid.inertia = {0, 7, 0, 0, 0, 0};  // only yy counts
  rigid.centre_of_mass = Vector3d(1.1, 0.3, 0.5);
  EXPECT_EQ(found(2).inertia(1, 1), 7.0);
  EXPECT_EQ(found(2).inertia.norm(), 7.0);
  EXPECT_EQ(found(2).centre, Vector3d(1.1, 0, 0.5));
}

TEST_F(MassPropertiesOfABox, TakesTheCentreAndInertiaThatAreGiven) {
  rigid.mass = 100;
  rigid.centre_of_mass = Vector3d(1.1, 0, 0.5);
  EXPECT_EQ(found().centre, Vector3d(1.1, 0, 0.5));
  EXPECT_LT((found().inertia - 125 * box_inertia(size)).norm(), 1e3 * rounding);  // that about the centre of volume
  rigid.inertia = {3, 4, 5, 0.1, -0.2, 0.3};
  Matrix3d inertia;
  inertia << 3, 0.1, -0.2, 0.1, 4, 0.3, -0.2, 0.3, 5;
  EXPECT_EQ(found().inertia, inertia);
}

TEST_F(MassPropertiesOfABox, NeedsNoMassWhereItIsNotFree) {
  const MassProperties driven = found(3, false);
  EXPECT_EQ(driven.mass, 0.0);
  EXPECT_EQ(driven.inertia.norm(), 0.0);
  EXPECT_LT((driven.centre - Vector3d(1.2, 0, 1)).norm(), 10 * rounding);
  EXPECT_NEAR(driven.volume, 0.8, rounding);
  rigid.mass = 5;
  EXPECT_EQ(found(3, false).mass, 5.0);
}

TEST_F(MassPropertiesOfABox, RefusesAMassThatIsNotOne) {
  EXPECT_EQ(refusal(), "body 'hull' has neither a mass nor a density; give one of them");
  rigid.mass = 1;
  rigid.density = 1;
  EXPECT_EQ(refusal(), "body 'hull' has both a mass and a density; give one of them");
  rigid.density = {};
  rigid.mass = 0;
  EXPECT_EQ(refusal(), "body 'hull': the mass is 0; it must be greater than 0");
  rigid.mass = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refusal().find("must be greater than 0"), std::string::npos);
  rigid.density = rigid.mass;
  rigid.mass = {};
  EXPECT_EQ(refusal(), "body 'hull': the density is nan; it must be greater than 0");
}

TEST_F(MassPropertiesOfABox, RefusesAnInertiaThatNoBodyHas) {
  rigid.mass = 1;
  const auto refused = [&](const std::array<double, 6>& inertia, const std::string& part, int dimensions = 3) {
    rigid.inertia = inertia;
    const std::string message = refusal(dimensions);
    EXPECT_NE(message.find(part), std::string::npos) << "the message is: " << message;
  };
  refused({1, 1, 2.1, 0, 0, 0}, "principal moments are 1, 1 and 2.1 kg·m²; no distribution of mass has them");
  refused({1, 1, 1, 0.9, 0, 0}, "are 0.1, 1 and 1.9 kg·m²; no distribution");  // its diagonal alone would do
  refused({1, 1, 1, 1.1, 0, 0}, "are -0.1, 1 and 2.1 kg·m²; they must all be greater than 0");
  refused({1, 0, 1, 0, 0, 0}, "they must all be greater than 0");
  refused({1, 1, 1, 0, 0, std::numeric_limits<double>::infinity()}, "not a finite number");
  refused({1, 0, 1, 0, 0, 0}, "the inertia's yy is 0; it must be greater than 0", 2);
  rigid.inertia = {0.0833, 0.0833, 0.1667, 0, 0, 0};  // a thin plate's, rounded upwards
  EXPECT_EQ(found().inertia(2, 2), 0.1667);
}

TEST(MassProperties, OfAnOpenTankThatIsNotFreeAreWhatIsGiven) {
  const TriangleMesh open = box_mesh({{0, -0.5, 0}, {2, 0.5, 1}}, true, "tank");
  for (const int dimensions : {2, 3}) {
    RigidCase rigid;
    rigid.mass = 10;
    EXPECT_EQ(mass_properties(rigid, open, dimensions, "tank", false).mass, 10.0);
    EXPECT_EQ(mass_properties(rigid, open, dimensions, "tank", false).inertia.norm(), 0.0);
    rigid.inertia = {1, 2, 2, 0, 0, 0};
    EXPECT_EQ(mass_properties(rigid, open, dimensions, "tank", false).inertia(1, 1), 2.0);
    rigid.mass = -1;
    EXPECT_ERROR(mass_properties(rigid, open, dimensions, "tank", false), "must be greater than 0");
  }
}

TEST(MassProperties, OfASurfaceThatEnclosesNothingMustAllBeGiven) {
  const TriangleMesh open = box_mesh({{0, -0.5, 0}, {2, 0.5, 1}}, true, "tank");
  TriangleMesh inwards = box({0, -0.5, 0}, {2, 0.5, 1});
  turn_over(inwards);
  RigidCase rigid;
  for (const TriangleMesh& mesh : {open, inwards}) {
    for (const int dimensions : {2, 3}) {
      const MassProperties standing = mass_properties({}, mesh, dimensions, "tank", false);
      EXPECT_EQ(standing.centre, Vector3d(1, 0, 0.5));
      EXPECT_EQ(standing.volume, 0.0);
      rigid.mass = 10;
      rigid.inertia = {};
      rigid.centre_of_mass = {};
      EXPECT_ERROR(mass_properties(rigid, mesh, dimensions, "tank"), "is not closed, is wound inwards or encloses next to nothing");
      rigid.inertia = {1, 1, 1, 0, 0, 0};
      EXPECT_ERROR(mass_properties(rigid, mesh, dimensions, "tank"), "give all three");
      rigid.centre_of_mass = Vector3d(1, 0, 0.2);
      EXPECT_EQ(mass_properties(rigid, mesh, dimensions, "tank").mass, 10.0);
      EXPECT_EQ(mass_properties(rigid, mesh, dimensions, "tank").inertia(1, 1), 1.0);
    }
  }
}

}  // namespace
}  // namespace wavetank::mass_properties_test

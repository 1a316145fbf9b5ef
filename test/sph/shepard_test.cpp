// γ as the device computes it, on walls of square elements of side h/2, against exact values.
#include <functional>

#include "sph_fixture.h"

namespace wavetank::shepard_test {
namespace {

constexpr double spacing = 0.1;
constexpr double smoothing = 2 * spacing;  // support 4: elements of side h/2
constexpr double tolerance = 2e-3;

struct Reference {
  double distance;  ///< r/h
  double shepard;
};

// made from ∫ W dV over the fluid's side, in double precision
constexpr Reference flat_2d[] = {{0.01, 0.50743}, {0.05, 0.53708}, {0.125, 0.59195}, {0.25, 0.67888},
                                 {0.5, 0.82350},  {1.0, 0.97149},  {1.5, 0.99913}};
constexpr Reference flat_3d[] = {{0.01, 0.50750}, {0.05, 0.53745}, {0.1, 0.574566}, {0.125, 0.59290},
                                 {0.25, 0.68093}, {0.5, 0.82758},  {1.0, 0.97461},  {1.5, 0.99940}};
constexpr Reference edge_3d[] = {{0.1, 0.33006779}, {0.5, 0.68364294}};
constexpr Reference corner_3d[] = {{0.1, 0.18958594}, {0.5, 0.56376664}};

/// Elements of a wall through the origin over tangential coordinates in [from_a, to_a] × [from_b, to_b] elements; 2-D: a alone. Each is
/// `narrow` times as wide along b as along a.
std::vector<WallElement> wall(const Vector3d& normal, const Vector3d& a, int from_a, int to_a, const Vector3d& b, int from_b, int to_b,
                              double narrow = 1) {
  std::vector<WallElement> elements;
  const bool flat = b.isZero();
  for (int i = from_a; i < to_a; ++i)
    for (int k = flat ? 0 : from_b; k < (flat ? 1 : to_b); ++k) {
      WallElement element;
      element.centre = spacing * ((i + 0.5) * a + narrow * (k + 0.5) * b);
      element.normal = normal;
      element.tangent = a;
      element.area = flat ? spacing : narrow * spacing * spacing;
      element.elongation = 1 / narrow;
      elements.push_back(element);
    }
  return elements;
}

const Vector3d X = Vector3d::UnitX(), Y = Vector3d::UnitY(), Z = Vector3d::UnitZ(), none = Vector3d::Zero();
constexpr int reach = 8;  // elements, more than the support of 4

std::vector<WallElement> operator+(std::vector<WallElement> a, const std::vector<WallElement>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// γ at the points from the device's own kernel.
std::vector<double> shepard(int dimensions, Precision precision, const std::vector<WallElement>& walls,
                            const std::vector<Vector3d>& points) {
  Case scene;
  scene.dimensions = dimensions;
  scene.fluid.sound_speed = 10;
  scene.numerics.support = 4;
  scene.numerics.walls.elements = WallElements::numerical;
  scene.numerics.precision = precision;
  const double half = dimensions == 3 ? 1.0 : 0.0;
  const Box domain{Vector3d(-1, -half, -0.5), Vector3d(1, half, 2)};
  Layout layout = loose_particles(domain, spacing, {Vector3d(0.9, 0.9 * half, 1.9)}, dimensions);
  layout.walls = walls;
  Tank tank(scene, layout);
  std::vector<double> values;
  for (const PointValue& value : tank.solver->evaluate(*tank.solver->make_points(points))) values.push_back(value.shepard);
  return values;
}

/// Checks γ at r (direction) + offset for each reference and offset; prints and returns nothing but the greatest error.
void compare(const char* what, int dimensions, Precision precision, const std::vector<WallElement>& walls, const Vector3d& direction,
             const std::vector<Vector3d>& offsets, const std::vector<Reference>& references) {
  if (!has_precision(precision)) GTEST_SKIP() << "the device has no double precision";
  std::vector<Vector3d> points;
  for (const Reference& reference : references)
    for (const Vector3d& offset : offsets) points.push_back(reference.distance * smoothing * direction + spacing * offset);
  const std::vector<double> values = shepard(dimensions, precision, walls, points);
  double greatest = 0, where = 0;
  std::size_t k = 0;
  for (const Reference& reference : references)
    for (const Vector3d& offset : offsets) {
      const double error = std::abs(values[k++] - reference.shepard);
      if (error > greatest) {
        greatest = error;
        where = reference.distance;
      }
      EXPECT_LT(error, tolerance) << what << ", r/h = " << reference.distance << ", offset " << offset.transpose()
                                  << " elements: γ = " << values[k - 1] << " instead of " << reference.shepard;
    }
  std::printf("%-24s %s: greatest error of γ %.1e (at r/h = %g)\n", what, precision == Precision::single ? "single" : "double", greatest,
              where);
}

/// ∫ W dV over the quarter plane x > 0, z > 0 seen from (r, r), both in units of h, by the midpoint rule.
double quarter_plane(double r) {
  const double pi = std::acos(-1.0), scale = 7.0 / (4.0 * pi);
  constexpr int cells = 800;
  const double step = (2.0 + r) / cells;
  double sum = 0;
  for (int i = 0; i < cells; ++i)
    for (int k = 0; k < cells; ++k) {
      const double q = std::hypot((i + 0.5) * step - r, (k + 0.5) * step - r);
      if (q < 2) sum += std::pow(1 - 0.5 * q, 4) * (1 + 2 * q);
    }
  return scale * sum * step * step;
}

std::vector<WallElement> flat_wall(int dimensions) {
  return dimensions == 2 ? wall(-Z, X, -reach, reach, none, 0, 0) : wall(-Z, X, -reach, reach, Y, -reach, reach);
}

/// Over an element's centre, over the border of two (and the corner of four), and anywhere.
std::vector<Vector3d> flat_offsets(int dimensions) {
  if (dimensions == 2) return {0.5 * X, none, 0.01 * X, 0.02 * X, 0.31 * X, 0.77 * X};
  return {0.5 * (X + Y), none, 0.5 * X, 0.01 * X + 0.5 * Y, 0.02 * X - 0.015 * Y, 0.31 * X + 0.17 * Y, 0.77 * X + 0.45 * Y};
}

class ShepardFactor : public ::testing::TestWithParam<Precision> {};

TEST_P(ShepardFactor, FlatWall) {
  compare("flat wall, 2-D", 2, GetParam(), flat_wall(2), Z, flat_offsets(2), {std::begin(flat_2d), std::end(flat_2d)});
  compare("flat wall, 3-D", 3, GetParam(), flat_wall(3), Z, flat_offsets(3), {std::begin(flat_3d), std::end(flat_3d)});
}

TEST_P(ShepardFactor, FlatWallOfNarrowElements) {
  for (const double narrow : {0.5, 0.2}) {
    const int more = static_cast<int>(std::lround(reach / narrow));
    compare("narrow elements, 3-D", 3, GetParam(), wall(-Z, X, -reach, reach, Y, -more, more, narrow), Z,
            {0.5 * (X + Y), 0.5 * X, 0.31 * X + 0.17 * Y, 0.77 * X + 0.45 * Y}, {std::begin(flat_3d), std::end(flat_3d)});
    compare("narrow elements, 3-D, turned", 3, GetParam(), wall(-Z, Y, -reach, reach, X, -more, more, narrow), Z,
            {0.5 * (X + Y), 0.5 * X, 0.31 * X + 0.17 * Y, 0.77 * X + 0.45 * Y}, {std::begin(flat_3d), std::end(flat_3d)});
  }
}

TEST_P(ShepardFactor, RightAngle) {
  std::vector<Reference> corner_2d;
  for (const double r : {0.05, 0.1, 0.25, 0.5, 1.0, 1.5}) corner_2d.push_back({r, quarter_plane(r)});
  compare("corner, 2-D", 2, GetParam(), wall(-Z, X, 0, reach, none, 0, 0) + wall(-X, Z, 0, reach, none, 0, 0), X + Z, {none}, corner_2d);
  compare("edge of 90 degrees, 3-D", 3, GetParam(), wall(-Z, X, 0, reach, Y, -reach, reach) + wall(-X, Z, 0, reach, Y, -reach, reach),
          X + Z, {none, 0.5 * Y, 0.31 * Y}, {std::begin(edge_3d), std::end(edge_3d)});
  compare("corner of a cube, 3-D", 3, GetParam(),
          wall(-Z, X, 0, reach, Y, 0, reach) + wall(-X, Y, 0, reach, Z, 0, reach) + wall(-Y, Z, 0, reach, X, 0, reach), X + Y + Z, {none},
          {std::begin(corner_3d), std::end(corner_3d)});
}

TEST_P(ShepardFactor, IsHalfOnTheWallAndContinuousAcrossIt) {
  std::vector<Reference> near;
  for (const double r : {-1e-4, -3e-5, -1e-5, -1e-6, 0.0, 1e-6, 1e-5, 3e-5, 1e-4}) near.push_back({r, 0.5});
  compare("on the wall, 2-D", 2, GetParam(), flat_wall(2), Z, flat_offsets(2), near);
  compare("on the wall, 3-D", 3, GetParam(), flat_wall(3), Z, flat_offsets(3), near);
}

TEST_P(ShepardFactor, InEdgesAndCornersIsThatOfTheFluidBesideThem) {
  compare("in a corner, 2-D", 2, GetParam(), wall(-Z, X, 0, reach, none, 0, 0) + wall(-X, Z, 0, reach, none, 0, 0), X + Z, {none},
          {{0.0, 0.25}});
  compare("in an edge, 3-D", 3, GetParam(), wall(-Z, X, 0, reach, Y, -reach, reach) + wall(-X, Z, 0, reach, Y, -reach, reach), X + Z,
          {none, 0.5 * Y, 0.31 * Y}, {{0.0, 0.25}});
  compare("in a cube's corner, 3-D", 3, GetParam(),
          wall(-Z, X, 0, reach, Y, 0, reach) + wall(-X, Y, 0, reach, Z, 0, reach) + wall(-Y, Z, 0, reach, X, 0, reach), X + Y + Z, {none},
          {{0.0, 0.125}});
}

TEST_P(ShepardFactor, FollowsTheDistanceWithoutSteps) {
  if (!has_precision(GetParam())) GTEST_SKIP() << "the device has no double precision";
  for (const int dimensions : {2, 3}) {
    std::vector<Vector3d> points;
    constexpr int samples = 400;
    for (int k = 0; k <= samples; ++k)
      points.push_back(spacing * (0.31 * X + (dimensions == 3 ? 0.17 : 0.0) * Y) + (2.2 * k / samples) * smoothing * Z);
    const std::vector<double> values = shepard(dimensions, GetParam(), flat_wall(dimensions), points);
    // dγ/d(r/h) is at most ∫ W dS h = 0.75 on the wall; beyond the support γ is one
    double steepest = 0;
    for (int k = 1; k <= samples; ++k) steepest = std::max(steepest, std::abs(values[k] - values[k - 1]));
    std::printf("%d-D: greatest step of γ over r/h = %.4f: %.5f\n", dimensions, 2.2 / samples, steepest);
    EXPECT_LT(steepest, 0.8 * 2.2 / samples + 5e-4);
    EXPECT_EQ(values.back(), 1.0);
  }
}

TEST_P(ShepardFactor, IsOneFarFromWalls) {
  if (!has_precision(GetParam())) GTEST_SKIP() << "the device has no double precision";
  for (const int dimensions : {2, 3})
    for (const double value : shepard(dimensions, GetParam(), flat_wall(dimensions), {2.01 * smoothing * Z, 1.5 * Z, 0.2 * X + 0.9 * Z}))
      EXPECT_EQ(value, 1.0);
}

INSTANTIATE_TEST_SUITE_P(Precisions, ShepardFactor, ::testing::Values(Precision::single, Precision::double_),
                         [](const auto& info) { return info.param == Precision::single ? "Single" : "Double"; });

}  // namespace
}  // namespace wavetank::shepard_test

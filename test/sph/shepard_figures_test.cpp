// γ by every kind of wall against exact values: the figures of Calderon-Sanchez et al. (2, 4 to 7), and facets of any size on flat walls,
// wedges, a re-entrant edge, a cube's corner and circles. With WAVETANK_SHEPARD_CSV=FILE the curves are written there, for
// scripts/plot_shepard.
#include <cstdlib>
#include <fstream>
#include <functional>

#include "sph_fixture.h"

namespace wavetank::shepard_figures_test {
namespace {

constexpr double smoothing = 0.2;  // h, m
constexpr double facet_tolerance = 1e-4;
const double pi = std::acos(-1.0);

/// A straight wall in 2-D from one point to another, with the fluid on the left; lengths in h.
struct Wall {
  Eigen::Vector2d from, to;
};

Vector3d in_space(const Eigen::Vector2d& p) { return Vector3d(smoothing * p.x(), 0, smoothing * p.y()); }

enum class Method { monolithic, numerical, semi_analytical, facet };

Facet segment(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Wall& wall) {
  Facet facet;
  const Eigen::Vector2d way = (wall.to - wall.from).normalized();
  facet.corners[0] = in_space(from);
  facet.corners[1] = facet.corners[2] = in_space(to);
  facet.normal = Vector3d(way.y(), 0, -way.x());
  facet.plane_point = in_space(wall.from);
  return facet;
}

/// γ on the device at points in 2-D (in h), the walls cut into elements of h/`resolution`.
std::vector<double> shepard(Method method, Precision precision, const std::vector<Wall>& walls, double resolution,
                            const std::vector<Eigen::Vector2d>& points) {
  Case scene;
  scene.dimensions = 2;
  scene.fluid.sound_speed = 10;
  scene.numerics.support = 2 * resolution;
  scene.numerics.precision = precision;
  scene.numerics.walls.shepard = method == Method::monolithic ? ShepardFactor::monolithic : ShepardFactor::geometric;
  scene.numerics.walls.elements = method == Method::facet             ? WallElements::facet
                                  : method == Method::semi_analytical ? WallElements::semi_analytical
                                                                      : WallElements::numerical;
  const double half = 7 * smoothing;
  Layout layout = loose_particles({Vector3d(-half, 0, -half), Vector3d(half, 0, half)}, smoothing / resolution,
                                  {Vector3d(0.95 * half, 0, 0.95 * half)}, 2);
  for (const Wall& wall : walls) {
    layout.facets.push_back(segment(wall.from, wall.to, wall));
    const int pieces = std::max(1, static_cast<int>(std::lround((wall.to - wall.from).norm() * resolution)));
    for (int k = 0; k < pieces; ++k) {
      const Eigen::Vector2d from = wall.from + (wall.to - wall.from) * k / pieces,
                            to = wall.from + (wall.to - wall.from) * (k + 1) / pieces;
      layout.triangles.push_back(segment(from, to, wall));
      WallElement element;
      element.centre = in_space(0.5 * (from + to));
      element.normal = layout.triangles.back().normal;
      element.tangent = (in_space(to) - in_space(from)).normalized();
      element.area = smoothing * (to - from).norm();
      layout.walls.push_back(element);
    }
  }
  Tank tank(scene, layout);
  std::vector<Vector3d> places;
  for (const Eigen::Vector2d& point : points) places.push_back(in_space(point));
  std::vector<double> values;
  for (const PointValue& value : tank.solver->evaluate(*tank.solver->make_points(places))) values.push_back(value.shepard);
  return values;
}

/// ∫ W ρ dρ from q to 2, in units of h, of the 2-D kernel.
double beyond(double q) {
  if (q >= 2) return 0;
  const double t = q * q * (0.5 + q * q * (-0.625 + q * (0.5 + q * (-0.15625 + q / 56.0))));
  return 7.0 / (4.0 * pi) * (2.0 / 7.0 - t);
}

/// γ = 1 − Σ_walls ∫ ∫_ρ(θ)^2h W ρ dρ dθ over the directions θ in which a wall is seen, from behind with the other sign: a sum over rays
/// that knows nothing of the method's potential.
double exact(const std::vector<Wall>& walls, const Eigen::Vector2d& point) {
  double value = 1;
  for (const Wall& wall : walls) {
    const Eigen::Vector2d way = (wall.to - wall.from).normalized(), left(-way.y(), way.x());
    const double distance = left.dot(point - wall.from);
    const double from = way.dot(wall.from - point), to = way.dot(wall.to - point);
    if (std::abs(distance) < 1e-12) {
      if (from < 0 && to > 0) value -= 0.5;
      continue;
    }
    const double first = std::atan2(from, std::abs(distance)), last = std::atan2(to, std::abs(distance));
    const double reach = std::abs(distance) < 2 ? std::acos(std::abs(distance) / 2) : 0;
    const double a = std::clamp(first, -reach, reach), b = std::clamp(last, -reach, reach);
    constexpr int rays = 4000;
    double sum = 0;
    for (int k = 0; k < rays; ++k) sum += beyond(std::abs(distance) / std::cos(a + (b - a) * (k + 0.5) / rays));
    value -= (distance > 0 ? 1 : -1) * sum * (b - a) / rays;
  }
  return value;
}

/// Fluid between two walls that meet in the origin at an angle (rad), one of them along +x.
std::vector<Wall> wedge(double angle, double length = 6) {
  const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
  return {{Eigen::Vector2d(0, 0), Eigen::Vector2d(length, 0)}, {length * direction, Eigen::Vector2d(0, 0)}};
}

std::vector<Wall> flat() { return {{Eigen::Vector2d(-6, 0), Eigen::Vector2d(6, 0)}}; }

/// Inside of a regular polygon in a circle about the origin.
std::vector<Wall> polygon(double radius, int sides) {
  std::vector<Wall> walls;
  const auto corner = [&](int k) { return Eigen::Vector2d(radius * std::cos(2 * pi * k / sides), radius * std::sin(2 * pi * k / sides)); };
  for (int k = 0; k < sides; ++k) walls.push_back({corner(k), corner((k + 1) % sides)});
  return walls;
}

double in_circle(double radius, double from_wall) {
  const double away = radius - from_wall;
  constexpr int rays = 20000;
  double sum = 0;
  for (int k = 0; k < rays; ++k) {
    const double cosine = std::cos(2 * pi * (k + 0.5) / rays);
    sum += beyond(-away * cosine + std::sqrt(radius * radius - away * away * (1 - cosine * cosine)));
  }
  return 1 - sum * 2 * pi / rays;
}

class Curves {
 public:
  Curves() {
    if (const char* path = std::getenv("WAVETANK_SHEPARD_CSV")) {
      file_.open(path);
      file_ << "figure,method,abscissa,shepard\n";
    }
  }
  void add(const std::string& figure, const std::string& method, double abscissa, double value) {
    if (file_.is_open()) file_ << figure << "," << method << "," << abscissa << "," << value << "\n";
  }

 private:
  std::ofstream file_;
};

Curves& curves() {
  static Curves instance;
  return instance;
}

struct Named {
  Method method;
  const char* name;
};
constexpr Named every_method[] = {{Method::monolithic, "monolithic"},
                                  {Method::numerical, "numerical"},
                                  {Method::semi_analytical, "semi_analytical"},
                                  {Method::facet, "facet"}};

/// One figure: γ along points that belong to abscissae; prints each method's greatest error and returns facets'. `own`: what a wall that
/// the points lie on takes, which the monolithic form does not know of.
double draw(const std::string& figure, const std::vector<Wall>& walls, double resolution, const std::vector<double>& abscissae,
            const std::function<Eigen::Vector2d(double)>& place, double own, const std::function<double(double)>& shown) {
  std::vector<Eigen::Vector2d> points;
  for (const double a : abscissae) points.push_back(place(a));
  double of_facets = 0;
  for (const auto& [method, name] : every_method) {
    const std::vector<double> values = shepard(method, Precision::single, walls, resolution, points);
    double greatest = 0, shown_greatest = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
      const double value = values[k] - (method == Method::monolithic ? own : 0);
      greatest = std::max(greatest, std::abs(value - exact(walls, points[k])));
      shown_greatest = std::max(shown_greatest, std::abs(value - shown(abscissae[k])));
      curves().add(figure, name, abscissae[k], value);
    }
    std::printf("%-14s %-16s h/dx = %g: greatest error of γ %.1e\n", figure.c_str(), name, resolution, greatest);
    if (method == Method::facet) of_facets = greatest;
    if (method == Method::numerical || method == Method::semi_analytical) {
      EXPECT_LT(greatest, 2e-3) << figure << ", " << name;
    }
  }
  for (const double a : abscissae) curves().add(figure, "exact", a, shown(a));
  return of_facets;
}

std::vector<double> steps(double from, double to, int count) {
  std::vector<double> values;
  for (int k = 0; k <= count; ++k) values.push_back(from + (to - from) * k / count);
  return values;
}

TEST(ShepardFigures, Figure2MonolithicIsOffByTheSameAtAnyResolution) {
  const std::vector<Wall> corner = wedge(pi / 2);
  for (const double resolution : {2.0, 4.0, 8.0}) {
    std::vector<Eigen::Vector2d> points;
    std::vector<double> abscissae;
    for (double r = 0.5 / resolution; r < 2; r += 1 / resolution) abscissae.push_back(r);  // from one element's middle to the next
    for (const double r : abscissae) points.emplace_back(r, 0);
    const std::vector<double> values = shepard(Method::monolithic, Precision::single, corner, resolution, points);
    char method[32];
    std::snprintf(method, sizeof method, "monolithic h/dx=%g", resolution);
    for (std::size_t k = 0; k < points.size(); ++k) curves().add("fig2", method, abscissae[k], values[k] - 0.5);
    const double error = values[0] - 0.5 - exact(corner, points[0]);
    std::printf("fig2           h/dx = %g: nearest the corner γ is off by %.4f\n", resolution, error);
    // the singular part at the elements' middles there: Σ 1/2 / (1/4 + (k + 1/2)²) / 2π = tanh(π/2)/4 instead of 1/4
    EXPECT_NEAR(error, 0.25 * (1 - std::tanh(pi / 2)), 2e-3);
  }
  for (const double r : steps(0.02, 2, 99)) curves().add("fig2", "exact", r, exact(corner, {r, 0}));
}

TEST(ShepardFigures, Figure4FlatWall) {
  const auto reference = [](double r) { return exact(flat(), {0.113, r}); };
  EXPECT_LT(draw(
                "fig4", flat(), 4, steps(0, 2, 200), [](double r) { return Eigen::Vector2d(0.113, r); }, 0, reference),
            facet_tolerance);
}

TEST(ShepardFigures, Figure5Corner) {
  const std::vector<Wall> corner = wedge(pi / 2);
  EXPECT_LT(draw(
                "fig5_wall", corner, 4, steps(0.01, 2, 199), [](double r) { return Eigen::Vector2d(r, 0); }, 0.5,
                [&](double r) {
                  return exact(corner, {r, 0});
                }),
            facet_tolerance);
  EXPECT_LT(draw(
                "fig5_diagonal", corner, 4, steps(0.01, 2, 199), [](double r) { return Eigen::Vector2d(r, r); }, 0,
                [&](double r) {
                  return exact(corner, {r, r});
                }),
            facet_tolerance);
}

TEST(ShepardFigures, Figure6Circle) {
  constexpr double radius = 5;
  const std::vector<Wall> walls = polygon(radius, 126);  // sides of h/4
  // towards the middle of a side, from its own distance on: the polygon is what the facets are
  const double turn = pi / 126, sagitta = radius * (1 - std::cos(turn));
  EXPECT_LT(draw(
                "fig6", walls, 4, steps(0.001 + sagitta, 2, 199),
                [&](double r) { return Eigen::Vector2d((radius - r) * std::cos(turn), (radius - r) * std::sin(turn)); }, 0,
                [&](double r) { return in_circle(radius, r); }),
            facet_tolerance);
}

TEST(ShepardFigures, Figure7ErrorByResolution) {
  const std::vector<Wall> corner = wedge(pi / 2);
  double worst_facet = 0, worst_split = 0, least_monolithic = 1;
  for (const double resolution : {1.0, 1.25, 1.5, 1.75, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0}) {
    const Eigen::Vector2d point(0.5 / resolution, 0);
    const double reference = exact(corner, point);
    for (const auto& [method, name] : every_method) {
      const double value = shepard(method, Precision::single, corner, resolution, {point})[0] - (method == Method::monolithic ? 0.5 : 0.0);
      const double error = std::abs(value / reference - 1);
      curves().add("fig7", name, resolution, std::max(error, 1e-8));
      if (method == Method::facet) worst_facet = std::max(worst_facet, error);
      if (method == Method::monolithic) least_monolithic = std::min(least_monolithic, error);
      if ((method == Method::numerical || method == Method::semi_analytical) && resolution >= 1.5)
        worst_split = std::max(worst_split, error);
    }
  }
  std::printf(
      "fig7           relative errors nearest a corner: facet at most %.1e, split elements from h/dx = 1.5 on at most %.1e, monolithic at "
      "least %.1e\n",
      worst_facet, worst_split, least_monolithic);
  EXPECT_LT(worst_facet, facet_tolerance);
  EXPECT_LT(worst_split, 5e-3);
  EXPECT_GT(least_monolithic, 5 * worst_split);
}

class ExactFacets : public ::testing::TestWithParam<Precision> {};

TEST_P(ExactFacets, WedgesAndReentrantEdgeIn2D) {
  if (!has_precision(GetParam())) GTEST_SKIP() << "the device has no double precision";
  for (const double degrees : {60.0, 90.0, 120.0, 180.0, 270.0}) {
    const double angle = degrees * pi / 180;
    const std::vector<Wall> walls = wedge(angle);
    std::vector<Eigen::Vector2d> points;
    for (const double r : {0.01, 0.05, 0.1, 0.3, 0.7, 1.2, 1.9})
      for (const double share : {0.0, 0.02, 0.25, 0.5, 0.9, 1.0})
        points.emplace_back(r * std::cos(share * angle), r * std::sin(share * angle));
    const std::vector<double> values = shepard(Method::facet, GetParam(), walls, 2, points);
    double greatest = 0;
    for (std::size_t k = 0; k < points.size(); ++k) greatest = std::max(greatest, std::abs(values[k] - exact(walls, points[k])));
    std::printf("2-D wedge of %3.0f degrees: greatest error of γ %.1e\n", degrees, greatest);
    EXPECT_LT(greatest, facet_tolerance) << degrees;
  }
}

/// Triangles of a parallelogram from `corner` along a and b, cut into n × n pairs.
std::vector<Facet> tiles(const Vector3d& corner, const Vector3d& a, const Vector3d& b, const Vector3d& normal, int n) {
  std::vector<Facet> facets;
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < n; ++k) {
      const auto at = [&](int u, int v) { return Vector3d(smoothing * (corner + a * (i + u) / n + b * (k + v) / n)); };
      Facet facet;
      facet.normal = normal;
      facet.plane_point = smoothing * corner;
      facet.corners[0] = at(0, 0), facet.corners[1] = at(1, 0), facet.corners[2] = at(1, 1);
      facets.push_back(facet);
      facet.corners[1] = at(1, 1), facet.corners[2] = at(0, 1);
      facets.push_back(facet);
    }
  return facets;
}

std::vector<double> shepard_3d(Precision precision, const std::vector<Facet>& facets, const std::vector<Vector3d>& points) {
  Case scene;
  scene.fluid.sound_speed = 10;
  scene.numerics.support = 3;
  scene.numerics.precision = precision;
  scene.numerics.walls.elements = WallElements::facet;
  const Vector3d half = Vector3d::Constant(3 * smoothing);
  Layout layout = loose_particles({-half, half}, smoothing / 1.5, {0.9 * half}, 3);
  layout.facets = facets;
  Tank tank(scene, layout);
  std::vector<Vector3d> places;
  for (const Vector3d& point : points) places.push_back(smoothing * point);
  std::vector<double> values;
  for (const PointValue& value : tank.solver->evaluate(*tank.solver->make_points(places))) values.push_back(value.shepard);
  return values;
}

struct WedgeReference {
  double r, share, shepard;  ///< distance from the edge in h, angle over the opening, γ
};
// by quadrature in polar coordinates, to 1e-8
constexpr WedgeReference wedge_60[] = {{0.01, 0.02, 0.16996560}, {0.01, 0.5, 0.17044073}, {0.05, 0.25, 0.18528917}, {0.1, 0.5, 0.20651295},
                                       {0.1, 0.9, 0.20241271},   {0.3, 0.02, 0.27261739}, {0.3, 0.25, 0.29115967},  {0.7, 0.5, 0.50844601},
                                       {0.7, 0.9, 0.43330207},   {1.2, 0.25, 0.67051975}};
constexpr WedgeReference wedge_90[] = {{0.01, 0.02, 0.25386747}, {0.01, 0.5, 0.25533100}, {0.05, 0.25, 0.27496659}, {0.1, 0.5, 0.30564689},
                                       {0.1, 0.9, 0.29354981},   {0.3, 0.02, 0.36189767}, {0.3, 0.25, 0.40902869},  {0.7, 0.5, 0.67957185},
                                       {0.7, 0.9, 0.52652533},   {1.2, 0.25, 0.79504471}};
constexpr WedgeReference wedge_270[] = {{0.01, 0.02, 0.74662498}, {0.01, 0.5, 0.75527530}, {0.05, 0.25, 0.76061902}, {0.1, 0.5, 0.80011088},
                                        {0.1, 0.9, 0.73598470},   {0.3, 0.02, 0.65854589}, {0.3, 0.25, 0.82358086},  {0.7, 0.5, 0.97065468},
                                        {0.7, 0.9, 0.75666949},   {1.2, 0.25, 0.98810758}};

TEST_P(ExactFacets, AnyTriangleSizeIn3D) {
  if (!has_precision(GetParam())) GTEST_SKIP() << "the device has no double precision";
  const auto check_wedge = [&](double degrees, const auto& references) {
    const double angle = degrees * pi / 180;
    const Vector3d along(std::cos(angle), 0, std::sin(angle)), out(-std::sin(angle), 0, std::cos(angle));
    for (const auto& [length, n] : {std::make_pair(100.0, 1), std::make_pair(5.0, 1), std::make_pair(4.0, 7), std::make_pair(3.0, 30)}) {
      const Vector3d corner(0, -length, 0), across(0, 2 * length, 0);
      std::vector<Facet> facets = tiles(corner, length * Vector3d::UnitX(), across, -Vector3d::UnitZ(), n);
      const std::vector<Facet> other = tiles(corner, length * along, across, out, n);
      facets.insert(facets.end(), other.begin(), other.end());
      double greatest = 0;
      for (const double y : {0.0, 0.1, -0.237}) {
        std::vector<Vector3d> points;
        for (const WedgeReference& reference : references)
          points.emplace_back(reference.r * std::cos(reference.share * angle), y, reference.r * std::sin(reference.share * angle));
        const std::vector<double> values = shepard_3d(GetParam(), facets, points);
        std::size_t k = 0;
        for (const WedgeReference& reference : references) greatest = std::max(greatest, std::abs(values[k++] - reference.shepard));
      }
      std::printf("3-D wedge of %3.0f degrees, triangles of %5.2f h: greatest error of γ %.1e\n", degrees, length / n, greatest);
      EXPECT_LT(greatest, facet_tolerance) << degrees << " degrees, triangles of " << length / n << " h";
    }
  };
  check_wedge(60, wedge_60);
  check_wedge(90, wedge_90);
  check_wedge(270, wedge_270);
}

TEST_P(ExactFacets, FlatWallAndCubeCornerIn3D) {
  if (!has_precision(GetParam())) GTEST_SKIP() << "the device has no double precision";
  constexpr double flat_wall[][2] = {{0, 0.5},           {1e-6, 0.5},       {0.01, 0.50749956}, {0.05, 0.53744541}, {0.125, 0.59290471},
                                     {0.25, 0.68093458}, {0.5, 0.82758331}, {1, 0.97460937},    {1.5, 0.99939728}};
  constexpr double cube[][2] = {{0.01, 0.13070864}, {0.1, 0.18958594}, {0.5, 0.56376664}, {1, 0.92463140}};
  const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY(), z = Vector3d::UnitZ();
  for (const auto& [length, n] : {std::make_pair(100.0, 1), std::make_pair(4.0, 1), std::make_pair(3.0, 4), std::make_pair(2.5, 50)}) {
    double greatest = 0, in_corner = 0;
    std::vector<Vector3d> points;
    // over edges and corners of triangles, and anywhere
    for (const auto& reference : flat_wall)
      for (const Vector3d& beside : {Vector3d(0, 0, 0), Vector3d(0.1, 0.1, 0), Vector3d(-0.3, 0, 0), Vector3d(0.31, -0.17, 0)})
        points.push_back(reference[0] * z + beside);
    std::vector<double> values = shepard_3d(GetParam(), tiles(-length * (x + y), 2 * length * x, 2 * length * y, -z, n), points);
    for (std::size_t k = 0; k < points.size(); ++k) greatest = std::max(greatest, std::abs(values[k] - flat_wall[k / 4][1]));
    std::vector<Facet> corner = tiles(Vector3d::Zero(), length * x, length * y, -z, n);
    for (const std::vector<Facet>& other :
         {tiles(Vector3d::Zero(), length * y, length * z, -x, n), tiles(Vector3d::Zero(), length * z, length * x, -y, n)})
      corner.insert(corner.end(), other.begin(), other.end());
    points.clear();
    for (const auto& reference : cube) points.push_back(reference[0] * (x + y + z));
    values = shepard_3d(GetParam(), corner, points);
    for (std::size_t k = 0; k < points.size(); ++k) in_corner = std::max(in_corner, std::abs(values[k] - cube[k][1]));
    std::printf("3-D, triangles of %6.2f h: greatest error of γ on a flat wall %.1e, in a cube's corner %.1e\n", length / n, greatest,
                in_corner);
    EXPECT_LT(greatest, facet_tolerance) << "triangles of " << length / n << " h";
    EXPECT_LT(in_corner, facet_tolerance) << "triangles of " << length / n << " h";
  }
}

INSTANTIATE_TEST_SUITE_P(Precisions, ExactFacets, ::testing::Values(Precision::single, Precision::double_),
                         [](const auto& info) { return info.param == Precision::single ? "Single" : "Double"; });

}  // namespace
}  // namespace wavetank::shepard_figures_test

// The fit of second-order moving least squares by the kernels' own functions, on clouds of particles: derivatives of quadratics are exact,
// on disordered, one-sided and corner neighbourhoods; those of smooth fields converge; and few neighbours give what they hold.
#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <random>

#include "../../src/sph/tables/device_sizes.h"
#include "../../src/sph/tables/rows.h"
#include "sph_fixture.h"
#include "wavetank/compute/buffer.h"
#include "wavetank/compute/program.h"
#include "wavetank/sph/kernel_sources.h"

namespace wavetank::least_squares_fit_test {
namespace {

/// The fit of the first particles of a cloud to fields that all of its particles have.
const char* const fit_cloud = R"(
#include "tile.cl"
#include "mls_basis.cl"
#include "mls_solution.cl"

__kernel void fit_cloud(__constant const parameters_t* p, int count, int fields, __global const real* cloud, long stride, __global real* found, __global real* level) {
  moments_t moments = {{(tile)(R(0.0))}};
  const tile x = own_values(cloud, 0), y = own_values(cloud + stride, 0), z = own_values(cloud + 2 * stride, 0);
  for (int j = 0; j < count; j += TILE_NEAR) {
    const tile rx = near_values(cloud, j) - x, ry = near_values(cloud + stride, j) - y, rz = near_values(cloud + 2 * stride, j) - z;
    tile b[BASIS];
    basis_at(p, rx, ry, rz, b);
    add_to_moments(&moments, mls_weights(p, sqrt(rx * rx + ry * ry + rz * rz)) * near_values(cloud + 3 * stride, j), b);
  }
  fit_t fit;
  solve_fit(p, &moments, &fit);
  for (int f = 0; f < fields; ++f) {
    __global const real* of = cloud + (4 + f) * stride;
    tile sums[BASIS];
    for (int l = 0; l < BASIS; ++l) sums[l] = (tile)(R(0.0));
    for (int j = 0; j < count; j += TILE_NEAR) {
      const tile rx = near_values(cloud, j) - x, ry = near_values(cloud + stride, j) - y, rz = near_values(cloud + 2 * stride, j) - z;
      tile b[BASIS];
      basis_at(p, rx, ry, rz, b);
      const tile weight = mls_weights(p, sqrt(rx * rx + ry * ry + rz * rz)) * near_values(cloud + 3 * stride, j);
      for (int l = 0; l < BASIS; ++l) sums[l] += weight * (near_values(of, j) - own_values(of, 0)) * b[l];
    }
    own_t right[BASIS];
    for (int l = 0; l < BASIS; ++l) right[l] = own_total(sums[l]);
    for (int r = 0; r < ROWS; ++r) {
      real lanes[TILE_OWN];
      own_lanes(row_times(fit.row[r], right), lanes);
      for (int k = 0; k < TILE_OWN; ++k) found[(f * ROWS + r) * TILE_OWN + k] = lanes[k];
    }
  }
  for (int k = 0; k < TILE_OWN; ++k) level[k] = fit.level[k];
}
)";

using Field = std::function<double(const Vector3d&)>;

struct Tiles {
  int own, near;
};

/// Of one field at one particle: ∂_a f times h_m, and ∇²f times h_m².
struct Derivatives {
  Vector3d gradient = Vector3d::Zero();
  double laplacian = 0;
};

/// The device's fit in tanks of so many dimensions with weights of the radius 2 h_m, in spacings of 1.
template <class Real>
class Fit {
 public:
  Fit(int dimensions, double support, double pivot, Tiles tiles) : dimensions_(dimensions), length_(0.5 * support), tiles_(tiles) {
    Case scene = box_case(Vector3d(8, dimensions == 2 ? 0 : 8, 8), 8, 1.0);
    scene.numerics.gradients = Gradients::mls_corrected;
    scene.numerics.support = 8;
    scene.numerics.mls.support = support;
    scene.numerics.mls.pivot = pivot;
    scene.fluid.sound_speed = 100;
    const Box domain{Vector3d::Zero(), Vector3d(8, dimensions == 2 ? 0 : 8, 8)};
    const Layout layout = loose_particles(domain, 1.0, {Vector3d(4, 0, 4)}, dimensions);
    scene = settled(scene, layout);
    const Discretisation discretisation = discretise(scene, layout);
    const SolverRows rows = rows_for(scene);
    const ParameterBlock block(rows.parameters, ParameterSource{scene, layout, discretisation, {}, 0});
    parameters_ = compute::Buffer<char>(test_device(), block.bytes<Real>());
    compute::SourceFiles files = kernel_sources();
    files["parameters.cl"] = parameters_header(rows.parameters);
    files["sizes.cl"] = sizes_header();
    files["fields.cl"] = FieldTable(rows.fields).header();
    files["fit_cloud.cl"] = fit_cloud;
    const std::string options = "-DMLS_DIRECT=0 -DDIMENSIONS=" + std::to_string(dimensions) +
                                " -DUSE_DOUBLE=" + std::to_string(sizeof(Real) == sizeof(double) ? 1 : 0) +
                                " -DTILE_OWN=" + std::to_string(tiles.own) + " -DTILE_NEAR=" + std::to_string(tiles.near) +
                                " -cl-fast-relaxed-math";
    program_.emplace(test_device(), files, "fit_cloud.cl", options);
  }

  int own() const { return tiles_.own; }
  double length() const { return length_; }

  /// By own particle and field. Every particle has the volume of a spacing.
  std::vector<std::vector<Derivatives>> operator()(const std::vector<Vector3d>& cloud, const std::vector<Field>& fields) {
    const std::size_t stride = cloud.size() + 16;
    std::vector<Real> values((4 + fields.size()) * stride, Real(0));
    for (std::size_t j = 0; j < stride; ++j) {
      const bool real = j < cloud.size();
      for (int axis = 0; axis < 3; ++axis) values[axis * stride + j] = static_cast<Real>(real ? cloud[j][axis] : 1e6);
      values[3 * stride + j] = Real(real ? 1 : 0);
      for (std::size_t f = 0; real && f < fields.size(); ++f) values[(4 + f) * stride + j] = static_cast<Real>(fields[f](cloud[j]));
    }
    const std::size_t rows = dimensions_ + 1;
    compute::Buffer<Real> device_cloud(test_device(), values), found(test_device(), fields.size() * rows * own()),
        level(test_device(), own());
    program_->kernel("fit_cloud")
        .launch(1, parameters_, static_cast<int>(cloud.size()), static_cast<int>(fields.size()), device_cloud,
                static_cast<std::int64_t>(stride), found, level);
    const std::vector<Real> results = found.download();
    const std::vector<Real> levels = level.download();
    level_.assign(levels.begin(), levels.end());
    std::vector<std::vector<Derivatives>> all(own(), std::vector<Derivatives>(fields.size()));
    for (int k = 0; k < own(); ++k)
      for (std::size_t f = 0; f < fields.size(); ++f) {
        const auto value = [&](std::size_t row) { return static_cast<double>(results[(f * rows + row) * own() + k]); };
        for (int a = 0; a < dimensions_; ++a) all[k][f].gradient[dimensions_ == 2 ? 2 * a : a] = length_ * value(a);
        all[k][f].laplacian = length_ * length_ * value(dimensions_);
      }
    return all;
  }
  /// Of own particle k in the last fit: 0 of second order, 1 without its Laplacian, 2 of first order, 3 less.
  double level(int k) const { return level_.at(k); }

 private:
  int dimensions_;
  double length_;
  Tiles tiles_;
  compute::Buffer<char> parameters_;
  std::optional<compute::Program> program_;
  std::vector<double> level_;
};

enum class Side { inside, one_sided, corner };

/// Particles of a lattice of spacing 1, displaced by up to a quarter: around the middle, on one side of it, or in a quadrant or octant.
/// Those that the fit is of come first.
std::vector<Vector3d> make_cloud(int dimensions, Side side, std::mt19937& random) {
  std::uniform_real_distribution<double> any(-0.25, 0.25);
  constexpr int reach = 5;
  std::vector<Vector3d> cloud;
  for (int i = side == Side::corner ? 0 : -reach; i <= reach; ++i)
    for (int j = dimensions == 2 ? 0 : side == Side::corner ? 0 : -reach; j <= (dimensions == 2 ? 0 : reach); ++j)
      for (int k = side == Side::inside ? -reach : 0; k <= reach; ++k)
        cloud.emplace_back(i + any(random), dimensions == 2 ? 0.0 : j + any(random), k + any(random));
  std::sort(cloud.begin(), cloud.end(), [](const Vector3d& a, const Vector3d& b) { return a.norm() < b.norm(); });
  if (side != Side::inside) {  // the owners in the outermost row alone
    std::stable_partition(cloud.begin(), cloud.end(),
                          [side](const Vector3d& x) { return x.z() < 0.3 && (side != Side::corner || x.x() < 0.3 || x.norm() < 0.5); });
  }
  return cloud;
}

/// Σ of coefficients times 1 and the basis functions of the scaled place.
struct Quadratic {
  std::array<double, 10> c;  ///< 1, x, y, z, x²/2, y²/2, z²/2, xy, xz, yz
  double length;
  int dimensions;

  double operator()(const Vector3d& at) const {
    const Vector3d x = at / length;
    return c[0] + c[1] * x[0] + c[2] * x[1] + c[3] * x[2] + 0.5 * (c[4] * x[0] * x[0] + c[5] * x[1] * x[1] + c[6] * x[2] * x[2]) +
           c[7] * x[0] * x[1] + c[8] * x[0] * x[2] + c[9] * x[1] * x[2];
  }
  Derivatives derivatives(const Vector3d& at) const {
    const Vector3d x = at / length;
    Derivatives d;
    d.gradient = Vector3d(c[1] + c[4] * x[0] + c[7] * x[1] + c[8] * x[2], c[2] + c[5] * x[1] + c[7] * x[0] + c[9] * x[2],
                          c[3] + c[6] * x[2] + c[8] * x[0] + c[9] * x[1]);
    if (dimensions == 2) d.gradient.y() = 0;
    d.laplacian = c[4] + c[6] + (dimensions == 3 ? c[5] : 0);
    return d;
  }
};

/// The greatest error of any derivative, in coefficients of up to 1.
template <class Real>
double error_on_quadratics(int dimensions, double support, Side side, Tiles tiles, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-1, 1);
  Fit<Real> fit(dimensions, support, 1e-6, tiles);
  double worst = 0;
  for (int trial = 0; trial < 6; ++trial) {
    std::vector<Vector3d> cloud = make_cloud(dimensions, side, random);
    for (Vector3d& place : cloud)
      for (int axis = 0; axis < 3; ++axis) place[axis] = static_cast<Real>(place[axis]);  // as the device has it
    std::vector<Quadratic> quadratics(4);
    std::vector<Field> fields;
    for (Quadratic& q : quadratics) {
      for (double& c : q.c) c = any(random);
      q.length = fit.length();
      q.dimensions = dimensions;
      fields.emplace_back(q);
    }
    const auto found = fit(cloud, fields);
    for (int k = 0; k < tiles.own; ++k) {
      EXPECT_LE(fit.level(k), 1) << "fell back";
      if (fit.level(k) > 1) continue;
      for (std::size_t f = 0; f < fields.size(); ++f) {
        const Derivatives exact = quadratics[f].derivatives(cloud[k]);
        worst = std::max(worst, (found[k][f].gradient - exact.gradient).cwiseAbs().maxCoeff());
        if (fit.level(k) == 0) worst = std::max(worst, std::abs(found[k][f].laplacian - exact.laplacian));
      }
    }
  }
  return worst;
}

std::vector<Tiles> tiles_of(Precision precision) {
  if (precision == Precision::single) return {{1, 1}, {2, 2}, {2, 4}, {4, 4}};
  return {{1, 1}, {2, 2}, {2, 4}};
}

class LeastSquares : public ::testing::TestWithParam<int> {};

TEST_P(LeastSquares, AreExactOnQuadratics) {
  const int dimensions = GetParam();
  for (const Side side : {Side::inside, Side::one_sided, Side::corner})
    for (const double support : dimensions == 2 ? std::vector<double>{3, 3.4, 4} : std::vector<double>{2.6, 3})
      for (const Precision precision : {Precision::single, Precision::double_}) {
        if (!has_precision(precision)) continue;
        double worst = 0;
        const unsigned seed = 11;
        for (const Tiles tiles : tiles_of(precision))
          worst = std::max(worst, precision == Precision::single ? error_on_quadratics<float>(dimensions, support, side, tiles, seed)
                                                                 : error_on_quadratics<double>(dimensions, support, side, tiles, seed));
        std::printf("%d-D, %s, R_m/dx %.1f, seed %u, %s: greatest error %.1e\n", dimensions,
                    side == Side::inside      ? "inside"
                    : side == Side::one_sided ? "one-sided"
                                              : "corner",
                    support, seed, precision == Precision::single ? "single" : "double", worst);
        EXPECT_LT(worst, precision == Precision::single ? 2e-4 : 1e-11);
      }
}

/// Of sin(x + 0.3) sin(z + 0.7) cos(y): errors of the gradient and the Laplacian at the middle of a cloud whose spacing is that part of 1.
std::array<double, 2> smooth_errors(int dimensions, Side side, double spacing, unsigned seed) {
  Fit<double> fit(dimensions, dimensions == 2 ? 3.4 : 3, 1e-6, {1, 1});
  std::array<double, 2> sum{};
  std::mt19937 random(seed);
  constexpr int trials = 40;
  for (int trial = 0; trial < trials; ++trial) {
    const std::vector<Vector3d> cloud = make_cloud(dimensions, side, random);
    const auto field = [&](const Vector3d& at) {
      const Vector3d x = spacing * at;
      return std::sin(x.x() + 0.3) * std::cos(x.y()) * std::sin(x.z() + 0.7);
    };
    const Derivatives found = fit(cloud, {field})[0][0];
    const Vector3d x = spacing * cloud[0];
    const Vector3d gradient(std::cos(x.x() + 0.3) * std::cos(x.y()) * std::sin(x.z() + 0.7),
                            -std::sin(x.x() + 0.3) * std::sin(x.y()) * std::sin(x.z() + 0.7),
                            std::sin(x.x() + 0.3) * std::cos(x.y()) * std::cos(x.z() + 0.7));
    const double scale = spacing * fit.length();
    sum[0] += std::pow((found.gradient / scale - gradient).norm(), 2) / trials;
    if (fit.level(0) == 0) sum[1] += std::pow(found.laplacian / (scale * scale) + dimensions * field(cloud[0]), 2) / trials;
  }
  return {std::sqrt(sum[0]), std::sqrt(sum[1])};
}

TEST_P(LeastSquares, ConvergeOnASmoothField) {
  if (!has_precision(Precision::double_)) GTEST_SKIP();
  for (const Side side : {Side::inside, Side::one_sided}) {
    constexpr unsigned seed = 5;
    const std::array<double, 2> coarse = smooth_errors(GetParam(), side, 0.1, seed), fine = smooth_errors(GetParam(), side, 0.05, seed);
    const double gradient = std::log2(coarse[0] / fine[0]), laplacian = std::log2(coarse[1] / fine[1]);
    std::printf("%d-D, %s, seed %u: order %.2f of the gradient, %.2f of the Laplacian\n", GetParam(),
                side == Side::inside ? "inside" : "one-sided", seed, gradient, laplacian);
    EXPECT_GT(gradient, 1.85);
    EXPECT_GT(laplacian, 0.85);
  }
}

TEST_P(LeastSquares, TellWhatFewNeighboursHold) {
  const int dimensions = GetParam();
  Fit<float> fit(dimensions, 3, 0.05, {1, 1});
  const Vector3d slope(2, dimensions == 2 ? 0 : -1, 3);
  const Field field = [&](const Vector3d& x) { return 5 + slope.dot(x); };
  const double h = fit.length();
  // none
  const Derivatives alone = fit({Vector3d::Zero()}, {field})[0][0];
  EXPECT_EQ(fit.level(0), 3);
  EXPECT_EQ(alone.gradient.norm(), 0);
  EXPECT_EQ(alone.laplacian, 0);
  // one: the slope along the line to it
  const Vector3d way(0.6, 0, 0.8);
  const Derivatives one = fit({Vector3d::Zero(), way}, {field})[0][0];
  EXPECT_EQ(fit.level(0), 3);
  EXPECT_NEAR((one.gradient / h - slope.dot(way) * way).norm(), 0, 1e-5);
  EXPECT_EQ(one.laplacian, 0);
  // as many as there are dimensions, not on a line: the slope
  std::vector<Vector3d> few{Vector3d::Zero(), Vector3d(0.9, 0, 0.1), Vector3d(0.2, 0, 1)};
  if (dimensions == 3) few.emplace_back(-0.1, 0.8, 0.3);
  const Derivatives some = fit(few, {field})[0][0];
  EXPECT_EQ(fit.level(0), 2);
  EXPECT_NEAR((some.gradient / h - slope).norm(), 0, 1e-4);
  EXPECT_EQ(some.laplacian, 0);
  // a thin jet along x: the slope along it
  std::vector<Vector3d> jet;
  for (int i = 0; i < 5; ++i) jet.emplace_back(i == 0 ? 0 : (i % 2 == 0 ? 0.5 : -0.5) * (i + 1) / 2 * 1.1, 0, 0);
  const Derivatives along = fit(jet, {field})[0][0];
  EXPECT_EQ(fit.level(0), 3);
  EXPECT_NEAR(along.gradient.x() / h, slope.x(), 1e-4);
  EXPECT_EQ(along.gradient.z(), 0);
}

/// At the corner of a regular lattice the Laplacian's own coefficient is of the wrong sign, as in u0 - 2 u1 + u2: no viscosity may come of
/// it.
TEST_P(LeastSquares, DropTheLaplacianWhereItWouldLetVelocitiesGrow) {
  const int dimensions = GetParam();
  const auto sorted_lattice = [&](int from) {
    std::vector<Vector3d> cloud;
    for (int i = from; i <= 4; ++i)
      for (int j = dimensions == 2 ? 0 : from; j <= (dimensions == 2 ? 0 : 4); ++j)
        for (int k = from; k <= 4; ++k) cloud.emplace_back(i, j, k);
    std::sort(cloud.begin(), cloud.end(), [](const Vector3d& a, const Vector3d& b) { return a.norm() < b.norm(); });
    return cloud;
  };
  const Field square = [](const Vector3d& x) { return x.squaredNorm(); };
  Fit<float> fit(dimensions, 3.4, 1e-3, {1, 1});
  const Derivatives at_corner = fit(sorted_lattice(0), {square})[0][0];
  EXPECT_EQ(fit.level(0), 1);
  EXPECT_EQ(at_corner.laplacian, 0);
  EXPECT_NEAR(at_corner.gradient.norm(), 0, 1e-3);
  const Derivatives inside = fit(sorted_lattice(-4), {square})[0][0];
  EXPECT_EQ(fit.level(0), 0);
  EXPECT_NEAR(inside.laplacian, 2 * dimensions * fit.length() * fit.length(), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Dimensions, LeastSquares, ::testing::Values(2, 3),
                         [](const auto& info) { return std::to_string(info.param) + "D"; });

}  // namespace
}  // namespace wavetank::least_squares_fit_test

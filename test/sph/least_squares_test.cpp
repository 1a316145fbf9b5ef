// Rates by second-order moving least squares, through the solver: exact for quadratic fields, in balance where they should be, and water
// that rests on walls that carry its weight.
#include <random>

#include "sph_fixture.h"

namespace wavetank::least_squares_test {
namespace {

struct Variant {
  int dimensions;
  Precision precision;
  Gradients gradients;
  MlsPressure pressure;
  Integrator integrator;
};

std::string name_of(const ::testing::TestParamInfo<Variant>& info) {
  const Variant& v = info.param;
  return std::to_string(v.dimensions) + "D_" + (v.precision == Precision::single ? "single_" : "double_") + word_of(v.gradients) + "_" +
         word_of(v.pressure) + "_" + word_of(v.integrator);
}

/// A drop of displaced particles without walls and gravity.
struct Drop {
  static constexpr double spacing = 0.1, viscosity = 1.0, sound_speed = 10, step = 1e-8;

  Drop(const Variant& variant, unsigned seed, double half_width = 0.55) {
    const bool flat = variant.dimensions == 2;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-0.2, 0.2);
    std::vector<Vector3d> particles;
    const int reach = static_cast<int>(half_width / spacing);
    for (int i = -reach; i <= reach; ++i)
      for (int j = flat ? 0 : -reach; j <= (flat ? 0 : reach); ++j)
        for (int k = -reach; k <= reach; ++k)
          particles.emplace_back(spacing * Vector3d(i + any(random), flat ? 0.0 : j + any(random), k + any(random)));
    const Box domain{Vector3d(-2, flat ? 0 : -2, -2), Vector3d(2, flat ? 0 : 2, 2)};
    scene = box_case(domain.max - domain.min, 4, spacing);
    scene.gravity = Vector3d::Zero();
    scene.fluid.sound_speed = sound_speed;
    scene.fluid.density = 1;
    scene.fluid.viscosity = viscosity;
    NumericsCase& numerics = scene.numerics;
    numerics.gradients = variant.gradients;
    numerics.mls.pressure = variant.pressure;
    numerics.mls.pivot = 1e-6;
    numerics.precision = variant.precision;
    numerics.integrator = variant.integrator;
    numerics.negative_pressure = NegativePressure::allowed;
    numerics.density_diffusion = DensityDiffusion::none;
    numerics.artificial_viscosity = 0;
    layout = loose_particles(domain, spacing, particles, variant.dimensions);
    layout.open_top = false;
    scene = settled(scene, layout);
    solver = make_solver(test_device(), scene, layout, discretise(scene, layout), {Vector3d::Zero()});
    solver->start();
  }

  /// Of velocity and compression as they are given by place, by id: acceleration and ds/dt. From a short step, after another that finds the
  /// rates that a step may begin with.
  std::vector<std::array<double, 4>> rates(const std::function<std::array<double, 4>(const Vector3d&)>& values) {
    StateBytes<double> given(*solver);
    for (std::size_t i = 0; i < given.count; ++i) {
      const std::array<double, 4> own = values(layout.particles[i]);
      for (int axis = 0; axis < 3; ++axis) given.set(velocities[axis], i, own[axis]);
      given.set("compression", i, own[3]);
      given.set("pressure", i, sound_speed * sound_speed * own[3]);
      given.set("mass", i, (1 + own[3]) * layout.volumes[i]);
    }
    solver->restore(given.bytes());
    solver->shorten_step(step);
    solver->advance();
    StateBytes<double> before(*solver);
    EXPECT_EQ(solver->shorten_step(step), step);
    report = solver->advance();
    StateBytes<double> after(*solver);
    const auto change = [&](const std::string& of, std::size_t i) { return (after.get(of, i) - before.get(of, i)) / step; };
    std::vector<std::array<double, 4>> rates(given.count);
    for (std::size_t i = 0; i < given.count; ++i) rates[i] = {change("u", i), change("v", i), change("w", i), change("compression", i)};
    return rates;
  }

  Case scene;
  Layout layout;
  std::unique_ptr<Solver> solver;
  StepReport report;
};

class Rates : public ::testing::TestWithParam<Variant> {};

/// The sums are the device's; the exact derivatives those of u = (a x² + b x z, 0, c z² + d x z + …) in 2-D.
TEST_P(Rates, AreThoseOfQuadraticFields) {
  const Variant variant = GetParam();
  if (!has_precision(Precision::double_)) GTEST_SKIP();
  constexpr unsigned seed = 3;
  Drop drop(variant, seed);
  std::mt19937 random(seed + 1);
  std::uniform_real_distribution<double> any(-1, 1);
  const bool flat = variant.dimensions == 2;
  // u_c = linear · x + xᵀ second x; s a hundredth of the like, so that pressures are of order 1
  std::array<Vector3d, 4> linear;
  std::array<Eigen::Matrix3d, 4> second;
  for (int c = 0; c < 4; ++c) {
    linear[c] = Vector3d(any(random), any(random), any(random));
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) second[c](a, b) = any(random);
    second[c] = (second[c] + second[c].transpose()).eval();
    if (flat) {
      linear[c].y() = 0;
      second[c].row(1).setZero();
      second[c].col(1).setZero();
    }
  }
  const auto rates = drop.rates([&](const Vector3d& x) {
    std::array<double, 4> values{};
    for (int c = 0; c < 4; ++c) values[c] = (c == 3 ? 0.01 : 1.0) * (linear[c].dot(x) + x.dot(second[c] * x));
    if (flat) values[1] = 0;
    return values;
  });
  double divergence_error = 0, acceleration_error = 0;
  for (std::size_t i = 0; i < rates.size(); ++i) {
    const Vector3d x = drop.layout.particles[i];
    double divergence = 0;
    for (int c = 0; c < 3; ++c) divergence += flat && c == 1 ? 0.0 : linear[c][c] + 2 * second[c].row(c).dot(x);
    const double density = 1 + 0.01 * (linear[3].dot(x) + x.dot(second[3] * x));
    divergence_error = std::max(divergence_error, std::abs(rates[i][3] + density * divergence));
    if (x.cwiseAbs().maxCoeff() > 0.35) continue;  // near the surface viscosity may be Morris' sum
    const Vector3d slope = linear[3] + 2 * second[3] * x;
    for (int c = 0; c < 3; ++c) {
      if (flat && c == 1) continue;
      const double exact = Drop::viscosity * 2 * second[c].trace() - slope[c] / density;
      acceleration_error = std::max(acceleration_error, std::abs(rates[i][c] - exact));
    }
  }
  std::printf("seed %u: greatest error of the divergence %.1e, of the acceleration %.1e\n", seed, divergence_error, acceleration_error);
  EXPECT_LT(divergence_error, 1e-4);
  EXPECT_LT(acceleration_error, 1e-3);
  EXPECT_EQ(drop.report.counted("fits_below_first_order"), 0U);
}

INSTANTIATE_TEST_SUITE_P(
    Variants, Rates,
    ::testing::Values(Variant{2, Precision::double_, Gradients::mls_corrected, MlsPressure::difference, Integrator::symplectic},
                      Variant{2, Precision::double_, Gradients::mls, MlsPressure::difference, Integrator::predictor_corrector},
                      Variant{3, Precision::double_, Gradients::mls, MlsPressure::difference, Integrator::symplectic},
                      Variant{3, Precision::double_, Gradients::mls_corrected, MlsPressure::difference, Integrator::predictor_corrector}),
    name_of);

class Adjoint : public ::testing::TestWithParam<Variant> {};

/// What pairs do to each other is equal and opposite, along no line in particular, and yet turns nothing: ∇·(ω × x) is zero exactly.
TEST_P(Adjoint, MovesAndTurnsNoDropAsAWhole) {
  if (!has_precision(Precision::double_)) GTEST_SKIP();
  constexpr unsigned seed = 9;
  Drop drop(GetParam(), seed);
  std::mt19937 random(seed + 1);
  std::uniform_real_distribution<double> any(0, 1);
  const auto rates = drop.rates([&](const Vector3d&) { return std::array<double, 4>{0, 0, 0, 1e-6 * any(random)}; });
  Vector3d force = Vector3d::Zero(), torque = Vector3d::Zero();
  double size = 0, turning = 0;
  for (std::size_t i = 0; i < rates.size(); ++i) {
    const Vector3d own(rates[i][0], rates[i][1], rates[i][2]);
    force += own;  // all particles are of one mass, but for 1e-6
    torque += drop.layout.particles[i].cross(own);
    size += own.norm();
    turning += own.norm() * drop.layout.particles[i].norm();
  }
  std::printf("seed %u: net force %.1e, torque %.1e of their sizes\n", seed, force.norm() / size, torque.norm() / turning);
  EXPECT_GT(size, 0);
  EXPECT_LT(force.norm() / size, 1e-5);
  EXPECT_LT(torque.norm() / turning, 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Variants, Adjoint,
                         ::testing::Values(Variant{2, Precision::double_, Gradients::mls, MlsPressure::adjoint, Integrator::symplectic},
                                           Variant{3, Precision::double_, Gradients::mls_corrected, MlsPressure::adjoint,
                                                   Integrator::predictor_corrector}),
                         name_of);

TEST(FewParticles, AreCountedByWhatTheirFitsAre) {
  Case scene = box_case(Vector3d(4, 0, 4), 4, 0.1);
  scene.numerics.gradients = Gradients::mls_corrected;
  scene.numerics.density_diffusion = DensityDiffusion::none;  // it would make a pressure that is hydrostatic
  std::vector<Vector3d> particles;
  particles.emplace_back(1, 0, 1);                                        // alone
  for (int i = 0; i < 2; ++i) particles.emplace_back(2 + 0.1 * i, 0, 1);  // a pair
  particles.emplace_back(3, 0, 3);                                        // a triangle
  particles.emplace_back(3.1, 0, 3);
  particles.emplace_back(3, 0, 3.1);
  Layout layout = loose_particles({Vector3d::Zero(), Vector3d(4, 0, 4)}, 0.1, particles, 2);
  for (std::size_t i = 0; i < particles.size(); ++i) layout.levels[i] = particles[i].z();  // without pressure
  scene = settled(scene, layout);
  const auto solver = make_solver(test_device(), scene, layout, discretise(scene, layout), {Vector3d::Zero()});
  const double step = solver->start().time_step;
  const StepReport report = solver->advance();
  EXPECT_EQ(report.counted("fits_below_first_order"), 3U);
  EXPECT_EQ(report.counted("fits_of_first_order"), 3U);
  // nothing but gravity moves them
  for (const Vector3d& velocity : solver->download().velocity) EXPECT_NEAR((velocity - step * scene.gravity).norm(), 0, 1e-4 * step);
}

struct Form {
  int dimensions;
  Gradients gradients;
  MlsPressure pressure;
  WallMethod walls;
  Integrator integrator;
};

std::string form_name(const ::testing::TestParamInfo<Form>& info) {
  const Form& f = info.param;
  return std::to_string(f.dimensions) + "D_" + word_of(f.gradients) + "_" + word_of(f.pressure) + "_" +
         (f.walls == WallMethod::ghost ? "ghosts_" : "integrals_") + word_of(f.integrator);
}

class StillWater : public ::testing::TestWithParam<Form> {};

TEST_P(StillWater, RestsAndWeighsOnItsTank) {
  const Form form = GetParam();
  const bool flat = form.dimensions == 2;
  const double depth = 0.5, spacing = 0.05;
  Case scene = box_case(Vector3d(1, flat ? 0 : 0.5, 0.8), depth, spacing);
  scene.fluid.sound_speed = 30;
  NumericsCase& numerics = scene.numerics;
  numerics.gradients = form.gradients;
  numerics.mls.pressure = form.pressure;
  numerics.integrator = form.integrator;
  if (form.integrator == Integrator::predictor_corrector) numerics.courant = 0.3;
  numerics.artificial_viscosity = 0.1;
  numerics.walls.method = form.walls;
  numerics.walls.repulsion = 0.1;
  numerics.packing.settling = 3;
  Tank tank(scene);
  tank.solver->pack(100, {});
  tank.solver->settle(3, {});
  const double duration = (flat ? 3 : 1) * std::sqrt(depth / 9.81);
  double time = 0, step = tank.solver->start().time_step;
  double weight = 0, samples = 0;
  StepReport report;
  while (time < duration) {
    report = tank.solver->advance();
    ASSERT_TRUE(report.valid());
    time += step;
    step = report.time_step;
    if (static_cast<int>(time / duration * 20) > samples) {
      const WallWrench wrench = tank.solver->wrenches()[0];
      weight -= wrench[0].z() + wrench[1].z();
      ++samples;
    }
  }
  const FluidState fluid = tank.solver->download();
  double error = 0, speed = 0;
  for (std::size_t i = 0; i < fluid.id.size(); ++i) {
    error += std::pow(fluid.pressure[i] - 1000 * 9.81 * (depth - fluid.position[i].z()), 2) / static_cast<double>(fluid.id.size());
    speed = std::max(speed, fluid.velocity[i].norm());
  }
  error = std::sqrt(error) / (1000 * 9.81 * depth);
  const double all = 9.81 * total(fluid.mass);
  std::printf(
      "L2 error of the pressure %.4f rho g H, greatest speed %.4f m/s, weight on the tank %.4f of the water's; %llu fits of first order, "
      "%llu below\n",
      error, speed, weight / samples / all, static_cast<unsigned long long>(report.counted("fits_of_first_order")),
      static_cast<unsigned long long>(report.counted("fits_below_first_order")));
  EXPECT_LT(error, 0.08);
  EXPECT_LT(speed, 0.3);
  EXPECT_NEAR(weight / samples / all, 1, 0.03);
}

INSTANTIATE_TEST_SUITE_P(
    Forms, StillWater,
    ::testing::Values(Form{2, Gradients::mls_corrected, MlsPressure::sum, WallMethod::ghost, Integrator::symplectic},
                      Form{2, Gradients::mls, MlsPressure::adjoint, WallMethod::ghost, Integrator::predictor_corrector},
                      Form{2, Gradients::mls_corrected, MlsPressure::sum, WallMethod::boundary_integral, Integrator::symplectic},
                      Form{2, Gradients::mls, MlsPressure::sum, WallMethod::boundary_integral, Integrator::runge_kutta_4},
                      Form{3, Gradients::mls_corrected, MlsPressure::sum, WallMethod::boundary_integral, Integrator::predictor_corrector}),
    form_name);

}  // namespace
}  // namespace wavetank::least_squares_test

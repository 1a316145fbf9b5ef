// Friction on walls by a law: the stress of a logarithmic profile, smooth and rough, and by a coefficient, for every kind of wall; of
// bodies that have their own; and what the walls get is what the water loses.
#include <algorithm>
#include <array>

#include "sph_fixture.h"

namespace wavetank {
namespace {

constexpr double length = 1, depth = 0.6, spacing = 0.03, friction_velocity = 0.05;

/// Water over a floor, periodic along the floor, with a velocity along x.
Case stream(int dimensions, WallElements elements, const std::string& velocity) {
  Case scene = box_case(Vector3d(length, dimensions == 3 ? 0.3 : 0, 1.5), depth, spacing);
  scene.gravity = Vector3d::Zero();
  scene.fluid.sound_speed = 20;
  scene.fluid.initial.u = velocity;
  scene.tank.periodic = {true, dimensions == 3, false};
  scene.numerics.walls.elements = elements;
  scene.numerics.packing.iterations = 0;
  return scene;
}

/// u/u_τ by the logarithmic law, as an expression of z.
std::string profile(double per_length, double constant) {
  return std::to_string(friction_velocity) + "*(ln(" + std::to_string(per_length) + "*z)/0.41+" + std::to_string(constant) + ")";
}

/// Force along x on an owner a square metre (2-D: metre) of floor over what it is to be.
double relative_drag(const Case& scene, double stress, std::size_t owner = 0) {
  Tank tank(scene);
  tank.solver->start();
  const double area = length * (scene.dimensions == 3 ? 0.3 : 1);
  return tank.solver->wrenches().at(owner)[1].x() / (stress * area);
}

struct Walls {
  int dimensions;
  WallElements elements;
};

class Friction : public testing::TestWithParam<Walls> {
 protected:
  // Σ 2 ∫ W dS V over rows of particles is 1 but for what the rows sample of it: 0.6 % with R/Δx = 3
  static constexpr double tolerance = 0.015;
  Case scene(const std::string& velocity) const { return stream(GetParam().dimensions, GetParam().elements, velocity); }
};

TEST_P(Friction, ALogarithmicProfileHasItsStress) {
  const double stress = 1000 * friction_velocity * friction_velocity;
  Case smooth = scene(profile(friction_velocity / 1e-6, 5.2));
  smooth.numerics.walls.friction.law = FrictionLaw::law_of_the_wall;
  const double found = relative_drag(smooth, stress);
  Case rough = scene(profile(1 / 0.005, 8.5));
  rough.numerics.walls.friction.law = FrictionLaw::law_of_the_wall;
  rough.numerics.walls.friction.roughness = 0.005;
  const double found_rough = relative_drag(rough, stress);
  Case boulders = scene(profile(1 / 0.05, 8.5));  // the first rows lie within the grains' height
  boulders.numerics.walls.friction = rough.numerics.walls.friction;
  boulders.numerics.walls.friction.roughness = 0.05;
  const double found_boulders = relative_drag(boulders, stress);
  std::printf("stress of a logarithmic profile, smooth, rough and very rough: %.4f, %.4f, %.4f of the exact one\n", found, found_rough,
              found_boulders);
  EXPECT_NEAR(found_boulders, 1, tolerance);
  EXPECT_NEAR(found, 1, tolerance);
  EXPECT_NEAR(found_rough, 1, tolerance);
}

TEST_P(Friction, ACoefficientOfABodyIsItsOwn) {
  Case bed = scene("2");
  bed.fluid.fill = {Box{Vector3d::Zero(), Vector3d(length, 0.3, 0.3 + depth)}};
  BodyCase body;
  body.name = "bed";
  body.shape = Box{Vector3d::Zero(), Vector3d(0.5 * length, 0.3, 0.3)};
  body.skin_friction.law = FrictionLaw::coefficient;
  body.skin_friction.coefficient = 0.02;
  bed.bodies.push_back(body);
  bed.numerics.walls.friction.law = FrictionLaw::none;
  // on its top, half as long as the tank; its ends stand across the stream, and the floor beside it has no friction
  EXPECT_NEAR(relative_drag(bed, 0.5 * 0.02 * 1000 * 2 * 2, 1), 0.5, 0.5 * tolerance);
  EXPECT_EQ(relative_drag(bed, 1, 0), 0.0);
}

TEST_P(Friction, WallsGetWhatTheWaterLoses) {
  Case scene = this->scene("1");
  scene.numerics.walls.friction.law = FrictionLaw::law_of_the_wall;
  scene.numerics.walls.friction.roughness = 0.01;
  Tank tank(scene);
  double step = tank.solver->start().time_step;
  const auto momentum = [&tank] {
    const FluidState fluid = tank.solver->download();
    double sum = 0;
    for (std::size_t i = 0; i < fluid.id.size(); ++i) sum += fluid.mass[i] * fluid.velocity[i].x();
    return sum;
  };
  const double before = momentum();
  double taken = 0;
  for (int k = 0; k < 40; ++k) {
    const double force = tank.solver->wrenches()[0][1].x();
    const StepReport report = tank.solver->advance();
    taken += 0.5 * step * (force + tank.solver->wrenches()[0][1].x());
    step = report.time_step;
  }
  std::printf("momentum lost over that taken by the walls: %.6f\n", (before - momentum()) / taken);
  // what remains is that forces of a step are those of its middle, and rounding of a sum of 1e3 times the loss
  EXPECT_NEAR((before - momentum()) / taken, 1, 2e-3);
}

INSTANTIATE_TEST_SUITE_P(EveryKind, Friction,
                         testing::Values(Walls{2, WallElements::numerical}, Walls{2, WallElements::semi_analytical},
                                         Walls{3, WallElements::facet}));

TEST(LawOfTheWall, IsViscousInTheSublayer) {
  // y⁺ of 0.75 at the first row, and of 6 at the support's end: u = u_τ² z/ν
  const double viscosity = 0.4;  // Pa·s
  Case scene = stream(2, WallElements::facet, "z");
  scene.fluid.viscosity = viscosity;
  scene.numerics.walls.friction.law = FrictionLaw::law_of_the_wall;
  EXPECT_NEAR(relative_drag(scene, viscosity), 1, 0.015);
}

/// Mean acceleration along x far from walls over the exact one, of u = z²/2: of all water, or of `columns`, the least and the greatest.
std::array<double, 2> relative_accelerations(Case scene, double (*exact)(double z), int columns = 1) {
  scene.numerics.walls.friction.law = FrictionLaw::none;
  scene.numerics.artificial_viscosity = 0;
  scene.numerics.density_diffusion = DensityDiffusion::none;
  Tank tank(scene);
  const double step = tank.solver->start().time_step;
  std::map<std::uint32_t, double> speeds;
  const FluidState before = tank.solver->download();
  for (std::size_t i = 0; i < before.id.size(); ++i) speeds[before.id[i]] = before.velocity[i].x();
  tank.solver->advance();
  const FluidState after = tank.solver->download();
  std::vector<double> gained(columns, 0.0), expected(columns, 0.0);
  for (std::size_t i = 0; i < after.id.size(); ++i) {
    const double z = after.position[i].z();
    if (z < 0.2 || z > 0.4) continue;
    const int column = std::clamp(static_cast<int>(after.position[i].x() / length * columns), 0, columns - 1);
    gained[column] += (after.velocity[i].x() - speeds.at(after.id[i])) / step;
    expected[column] += exact(z);
  }
  std::array<double, 2> range{1e9, -1e9};
  for (int column = 0; column < columns; ++column) {
    range[0] = std::min(range[0], gained[column] / expected[column]);
    range[1] = std::max(range[1], gained[column] / expected[column]);
  }
  return range;
}

double relative_acceleration(const Case& scene, double (*exact)(double z)) { return relative_accelerations(scene, exact)[0]; }

TEST(Eddies, HaveSmagorinskysViscosity) {
  // S = z and ν_t = (C_s Δx)² z, so that u gains 2 (C_s Δx)² z; of a viscosity of 1e-3 m²/s it gains that, and what the lattice's sum
  // makes of a viscosity is the same
  Case scene = stream(2, WallElements::facet, "0.5*z*z");
  scene.fluid.viscosity = 1;
  const double viscous = relative_acceleration(scene, [](double) { return 1e-3; });
  scene.fluid.viscosity = 0;
  scene.numerics.turbulence = Turbulence::smagorinsky;
  scene.numerics.smagorinsky_coefficient = 1;
  const double by_eddies = relative_acceleration(scene, [](double z) { return 2 * spacing * spacing * z; });
  std::printf("acceleration by a viscosity and by eddies over the exact ones: %.4f, %.4f\n", viscous, by_eddies);
  EXPECT_NEAR(viscous, 1, 0.06);
  EXPECT_NEAR(by_eddies / viscous, 1, 0.01);
}

// Towards a wall eddies are no longer than κ times its distance z, as far as the support reaches: in a shear u = a z their viscosity is
// (κ z)² a. A particle beyond the support feels it by its neighbours nearer to the wall. What it gains by the formula is summed here over
// the same places: of the pair's viscosity (ν_i + ν_j)/2 in Monaghan and Gingold's form.
TEST(Eddies, AreNoLongerThanTheMixingLengthOfAWall) {
  constexpr double karman = 0.41, shear = 2, support = 4 * spacing;
  const auto viscosity = [&](double z) { return std::pow(karman * std::min(z, support), 2) * shear; };
  struct Kind {
    const char* name;
    WallMethod method;
    WallElements elements;
  };
  for (const Kind& kind : {Kind{"facets", WallMethod::boundary_integral, WallElements::facet},
                           Kind{"numerical elements", WallMethod::boundary_integral, WallElements::numerical},
                           Kind{"semi-analytical elements", WallMethod::boundary_integral, WallElements::semi_analytical},
                           Kind{"ghosts", WallMethod::ghost, WallElements::facet}}) {
    Case scene = stream(2, kind.elements, std::to_string(shear) + "*z");
    scene.numerics.walls.method = kind.method;
    scene.numerics.walls.slip = Slip::free_slip;  // by which images of a wall go along with the water
    scene.numerics.turbulence = Turbulence::smagorinsky;
    scene.numerics.smagorinsky_coefficient = 3;  // 0.09 m: κ times the distance is less within all of the support
    scene.fluid.viscosity = 0;
    scene.numerics.artificial_viscosity = 0;
    scene.numerics.density_diffusion = DensityDiffusion::none;
    Tank tank(scene);
    const double step = tank.solver->start().time_step;
    const FluidState before = tank.solver->download();
    tank.solver->advance();
    const FluidState after = tank.solver->download();
    std::map<std::uint32_t, double> speeds;
    for (std::size_t i = 0; i < after.id.size(); ++i) speeds[after.id[i]] = after.velocity[i].x();
    const double h = 0.5 * support, alpha = 7 / (4 * std::acos(-1.0) * h * h);
    double gained = 0, expected = 0, undamped = 0;
    for (std::size_t i = 0; i < before.id.size(); ++i) {
      const Vector3d& at = before.position[i];
      if (at.z() < support || at.z() > 1.4 * support) continue;
      gained += (speeds.at(before.id[i]) - before.velocity[i].x()) / step;
      for (std::size_t j = 0; j < before.id.size(); ++j) {
        const double x = std::remainder(before.position[j].x() - at.x(), length), z = before.position[j].z() - at.z();
        const double r2 = x * x + z * z, q = std::sqrt(r2) / h;
        if (j == i || q >= 2) continue;
        const double slope = 5 * alpha / (h * h) * std::pow(1 - 0.5 * q, 3);
        const double term = 4 * shear * z * x / (r2 + 1e-4 * h * h) * slope * before.mass[j] / 1000;
        expected += term * x * (viscosity(at.z()) + viscosity(before.position[j].z()));
        undamped += term * x * 2 * viscosity(support);
      }
    }
    std::printf("%s: acceleration by eddies that a wall keeps small over the formula's: %.4f\n", kind.name, gained / expected);
    EXPECT_NEAR(gained / expected, 1, 0.02) << kind.name;
    EXPECT_GT(std::abs(expected), 2 * std::abs(undamped)) << "in a shear nothing but the change of viscosity moves the water";
  }
}

// An end that repeats itself is no wall: between ghosts every column of the water has the same eddies.
TEST(Eddies, BetweenGhostsDoNotEndAtPeriodicEnds) {
  Case scene = stream(2, WallElements::facet, "0.5*z*z");
  scene.numerics.walls.method = WallMethod::ghost;
  scene.numerics.turbulence = Turbulence::smagorinsky;
  scene.numerics.smagorinsky_coefficient = 1;  // 0.03 m, which would be κ times a distance of 0.07 m
  const auto [least, most] = relative_accelerations(
      scene, [](double z) { return 2 * spacing * spacing * z; }, 11);
  std::printf("acceleration by eddies of columns of water along periodic ghosts: %.4f to %.4f of the exact one\n", least, most);
  EXPECT_LT(most - least, 0.02);
}

}  // namespace
}  // namespace wavetank

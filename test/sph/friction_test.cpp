// Friction on walls by a law: the stress of a logarithmic profile, smooth and rough, and by a coefficient, for every kind of wall; of
// bodies that have their own; and what the walls get is what the water loses.
#include "sph_fixture.h"

namespace wavetank::friction_test {
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

/// Mean acceleration along x far from walls over the exact one, of u = z²/2.
double relative_acceleration(Case scene, double (*exact)(double z)) {
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
  double gained = 0, expected = 0;
  for (std::size_t i = 0; i < after.id.size(); ++i) {
    const double z = after.position[i].z();
    if (z < 0.2 || z > 0.4) continue;
    gained += (after.velocity[i].x() - speeds.at(after.id[i])) / step;
    expected += exact(z);
  }
  return gained / expected;
}

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

}  // namespace
}  // namespace wavetank::friction_test

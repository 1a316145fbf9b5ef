// Forces on walls that face each other through water narrower than the support: each wall feels the pressure on it.
#include <algorithm>
#include <cstdlib>

#include "simulation_fixture.h"

namespace wavetank::facing_walls_test {
namespace {

constexpr double density = 1000, gravity = 9.81;

/// The force on a body: least, mean and greatest of the second half of the samples.
struct Force {
  Vector3d least, mean, greatest;
};

Force force_on(const Samples& samples, std::size_t owner, double from) {
  Force force{Vector3d::Constant(1e300), Vector3d::Zero(), Vector3d::Constant(-1e300)};
  int count = 0;
  for (const WrenchSample& sample : samples.wrenches) {
    if (sample.time < from) continue;
    const Vector3d& now = sample.wrenches[owner].pressure_force;
    force.least = force.least.cwiseMin(now);
    force.greatest = force.greatest.cwiseMax(now);
    force.mean += now;
    ++count;
  }
  force.mean /= count;
  return force;
}

struct Variant {
  const char* name;
  int dimensions;
  WallElements elements;
  ShepardFactor shepard;
};

/// A fixed box six spacings high, `gap` spacings over the floor, in still water.
Case box_over_floor(const Variant& variant, double gap) {
  const bool flat = variant.dimensions == 2;
  const double spacing = 0.02, width = flat ? 0.0 : 0.4;
  Case scene = box_case(Vector3d(flat ? 0.8 : 0.4, width, 0.5), 0.3, spacing);
  scene.fluid.density = density;
  const double half = flat ? 0.2 : 0.1, low = gap * spacing, high = low + 0.12;
  const Vector3d middle(flat ? 0.4 : 0.2, 0.5 * width, 0);
  scene.bodies.push_back({"box", Box{middle + Vector3d(-half, flat ? 0 : -half, low), middle + Vector3d(half, flat ? 0 : half, high)}});
  scene.numerics.walls.elements = variant.elements;
  scene.numerics.walls.shepard = variant.shepard;
  scene.numerics.packing.settling = 3;
  scene.instruments.rate = 100;
  return scene;
}

void feels_archimedes_over_the_floor(const Variant& variant, double gap) {
  const Case scene = box_over_floor(variant, gap);
  Simulation simulation(scene);
  const Force force = force_on(run_to(simulation, 0.2), 1, 0.05);
  const Box& box = std::get<Box>(scene.bodies[0].shape);
  const double archimedes = density * gravity * (variant.dimensions == 2 ? 0.4 : 0.2 * 0.2) * (box.max.z() - box.min.z());
  std::printf("%s, %g spacings over the floor: %+.1f %% of Archimedes' %.1f N (%+.1f to %+.1f %%), sideways %.2f %%\n", variant.name, gap,
              100 * (force.mean.z() / archimedes - 1), archimedes, 100 * (force.least.z() / archimedes - 1),
              100 * (force.greatest.z() / archimedes - 1), 100 * std::hypot(force.mean.x(), force.mean.y()) / archimedes);
  // 2.5 % was measured; in a gap just wide enough for a row of particles, which is half film, 4.2 %
  EXPECT_NEAR(force.mean.z(), archimedes, (gap > 0.9 && gap < 1.1 ? 0.05 : 0.03) * archimedes);
  EXPECT_LT(std::hypot(force.mean.x(), force.mean.y()), 0.02 * archimedes);
}

class BoxOverFloor : public ::testing::TestWithParam<Variant> {};

TEST_P(BoxOverFloor, FeelsArchimedesForce) {
  std::vector<double> gaps{0.25, 0.5, 0.75, 1, 1.5, 2, 3};
  if (GetParam().dimensions == 3) gaps = {0.25, 0.75, 1.5};
  if (std::getenv("WAVETANK_LONG_TESTS") != nullptr)
    gaps = {0.05, 0.1, 0.25, 0.4, 0.5, 0.6, 0.75, 0.85, 0.95, 1, 1.25, 1.5, 1.75, 2, 2.25, 2.5, 3, 3.5, 4};  // `scripts/validate reported`
  for (const double gap : gaps) feels_archimedes_over_the_floor(GetParam(), gap);
}

INSTANTIATE_TEST_SUITE_P(Walls, BoxOverFloor,
                         ::testing::Values(Variant{"facet", 2, WallElements::facet, ShepardFactor::geometric},
                                           Variant{"numerical", 2, WallElements::numerical, ShepardFactor::geometric},
                                           Variant{"volumetric", 2, WallElements::facet, ShepardFactor::volumetric},
                                           Variant{"facet_3d", 3, WallElements::facet, ShepardFactor::geometric}),
                         [](const auto& info) { return info.param.name; });

/// A box comes down to a fifth of a spacing over the floor, with rows of particles under it at first: they leave, and what does not is in
/// the film. Before, the last ones were pressed without end: the box felt 38 times Archimedes' force.
TEST(BoxThatComesDown, PushesTheWaterUnderItOut) {
  Case scene = box_over_floor({"facet", 2, WallElements::facet, ShepardFactor::geometric}, 1.5);
  scene.bodies[0].motion = Motion::prescribed;
  scene.bodies[0].rigid.prescribed.harmonics = {{Direction::heave, -0.026, 0.25, 0.0, 0.1}};
  Simulation simulation(scene);
  Samples samples = run_to(simulation, 1);
  EXPECT_NEAR(simulation.bodies().state(1).position.z(), 0.004 + 0.06, 0.001);
  const Samples later = run_to(simulation, 2);
  samples.wrenches.insert(samples.wrenches.end(), later.wrenches.begin(), later.wrenches.end());
  const double archimedes = density * gravity * 0.4 * 0.12;
  constexpr int parts = 8;
  for (int part = 0; part < parts; ++part) {
    double sum = 0, most = 0;
    int count = 0;
    for (const WrenchSample& sample : samples.wrenches) {
      if (sample.time < 0.25 * part || sample.time >= 0.25 * (part + 1)) continue;
      sum += sample.wrenches[1].pressure_force.z();
      most = std::max(most, std::abs(sample.wrenches[1].pressure_force.z()));
      ++count;
    }
    std::printf("from %.2f s: %.2f of Archimedes' force, %.2f at the most\n", 0.25 * part, sum / count / archimedes, most / archimedes);
    EXPECT_NEAR(sum / count, archimedes, 0.45 * archimedes);  // 0.23 was measured
    EXPECT_LT(most, 10 * archimedes);                         // 3.3 on the way down, 4.9 when water comes back in
  }
}

/// What a sample says depends on nothing but the state that it is of.
TEST(BoxOverAFilm, FeelsTheSameAfterAReset) {
  Simulation simulation(box_over_floor({"facet", 2, WallElements::facet, ShepardFactor::geometric}, 0.5));
  const Samples first = run_to(simulation, 0.03);
  simulation.reset();
  const Samples second = run_to(simulation, 0.03);
  ASSERT_EQ(first.wrenches.size(), second.wrenches.size());
  ASSERT_GE(first.wrenches.size(), 3u);
  for (std::size_t k = 0; k < first.wrenches.size(); ++k)
    EXPECT_EQ(first.wrenches[k].wrenches[1].pressure_force, second.wrenches[k].wrenches[1].pressure_force) << "sample " << k;
}

/// A plate under water, half a spacing over the floor: the water above it feels the film under it at its edges alone.
TEST(PlateOverAFilm, FeelsArchimedesForce) {
  Case scene = box_over_floor({"facet", 2, WallElements::facet, ShepardFactor::geometric}, 0.5);
  std::get<Box>(scene.bodies[0].shape).max.z() = 0.03;
  Simulation simulation(scene);
  const Force force = force_on(run_to(simulation, 0.2), 1, 0.05);
  const double weight_above = density * gravity * 0.4 * 0.27, archimedes = density * gravity * 0.4 * 0.02;
  std::printf("plate a spacing thick: %+.2f %% of the weight above it beside Archimedes' %.1f N\n",
              100 * (force.mean.z() - archimedes) / weight_above, archimedes);
  EXPECT_NEAR(force.mean.z(), archimedes, 0.06 * weight_above);
}

/// A box beside a wall of the tank, two spacings from it: the wall does not push it off.
TEST(BoxBesideAWall, IsNotPushedOff) {
  Case scene = box_case(Vector3d(0.8, 0, 0.5), 0.3, 0.02);
  scene.fluid.density = density;
  scene.bodies.push_back({"box", Box{Vector3d(0.04, 0, 0.1), Vector3d(0.24, 0, 0.22)}});
  scene.numerics.packing.settling = 3;
  scene.instruments.rate = 100;
  Simulation simulation(scene);
  const Force force = force_on(run_to(simulation, 0.2), 1, 0.05);
  const double archimedes = density * gravity * 0.2 * 0.12;
  std::printf("beside a wall: %+.1f %% of Archimedes' %.1f N, sideways %.2f %%\n", 100 * (force.mean.z() / archimedes - 1), archimedes,
              100 * force.mean.x() / archimedes);
  EXPECT_NEAR(force.mean.z(), archimedes, 0.05 * archimedes);
  EXPECT_NEAR(force.mean.x(), 0, 0.02 * archimedes);
}

/// Two boxes side by side, a spacing and a half apart: neither is pushed, and what one gets the other gets.
TEST(BoxesSideBySide, DoNotRepel) {
  Case scene = box_case(Vector3d(0.8, 0, 0.5), 0.3, 0.02);
  scene.fluid.density = density;
  scene.bodies.push_back({"left", Box{Vector3d(0.2, 0, 0.1), Vector3d(0.38, 0, 0.2)}});
  scene.bodies.push_back({"right", Box{Vector3d(0.42, 0, 0.1), Vector3d(0.6, 0, 0.2)}});
  scene.numerics.packing.settling = 3;
  scene.instruments.rate = 100;
  Simulation simulation(scene);
  const Samples samples = run_to(simulation, 0.2);
  const double archimedes = density * gravity * 0.18 * 0.1;
  for (const std::size_t owner : {1, 2}) {
    const Force force = force_on(samples, owner, 0.05);
    std::printf("side by side: %+.1f %% of Archimedes' %.1f N, sideways %.2f %%\n", 100 * (force.mean.z() / archimedes - 1), archimedes,
                100 * force.mean.x() / archimedes);
    EXPECT_NEAR(force.mean.z(), archimedes, 0.05 * archimedes);
    EXPECT_NEAR(force.mean.x(), 0, 0.02 * archimedes);
  }
}

}  // namespace
}  // namespace wavetank::facing_walls_test

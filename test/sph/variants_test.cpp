// Every value of every option builds and runs: each pair of values of two options at least once in 2-D, each value in 3-D.
#include <algorithm>
#include <set>
#include <sstream>
#include <utility>

#include "sph_fixture.h"

namespace wavetank {
namespace {

constexpr int option_count = 7;
constexpr int value_count[option_count] = {3, 2, 2, 2, 2, 2, 3};

/// One value an option: density diffusion, equation of state, viscosity model, slip, negative pressure, precision, wall elements.
using Choice = std::array<int, option_count>;

Case with(Case scene, const Choice& choice) {
  NumericsCase& numerics = scene.numerics;
  numerics.density_diffusion = static_cast<DensityDiffusion>(choice[0]);
  numerics.equation_of_state = static_cast<EquationOfState>(choice[1]);
  numerics.viscosity_model = static_cast<ViscosityModel>(choice[2]);
  numerics.walls.slip = static_cast<Slip>(choice[3]);
  numerics.negative_pressure = static_cast<NegativePressure>(choice[4]);
  numerics.precision = static_cast<Precision>(choice[5]);
  numerics.walls.elements = static_cast<WallElements>(choice[6]);
  return scene;
}

std::string describe(const Choice& choice) {
  std::ostringstream text;
  text << "diffusion " << choice[0] << ", state " << choice[1] << ", viscosity " << choice[2] << ", slip " << choice[3]
       << ", negative pressure " << choice[4] << ", precision " << choice[5] << ", elements " << choice[6];
  return text.str();
}

/// Pairs of values of two options, as (option, value, option, value).
using Pair = std::array<int, 4>;

std::set<Pair> pairs_of(const Choice& choice) {
  std::set<Pair> pairs;
  for (int a = 0; a < option_count; ++a)
    for (int b = a + 1; b < option_count; ++b) pairs.insert({a, choice[a], b, choice[b]});
  return pairs;
}

/// Few choices that hold every pair of values: the greedy cover of all choices.
std::vector<Choice> covering_choices() {
  std::vector<Choice> all(1, Choice{});
  for (int option = 0; option < option_count; ++option) {
    std::vector<Choice> longer;
    for (Choice choice : all)
      for (choice[option] = 0; choice[option] < value_count[option]; ++choice[option]) longer.push_back(choice);
    all = longer;
  }
  std::set<Pair> missing;
  for (const Choice& choice : all) missing.merge(pairs_of(choice));
  std::vector<Choice> cover;
  while (!missing.empty()) {
    const auto gain = [&](const Choice& choice) {
      const std::set<Pair> pairs = pairs_of(choice);
      return std::count_if(pairs.begin(), pairs.end(), [&](const Pair& pair) { return missing.count(pair) != 0; });
    };
    const Choice best = *std::max_element(all.begin(), all.end(), [&](const Choice& a, const Choice& b) { return gain(a) < gain(b); });
    for (const Pair& pair : pairs_of(best)) missing.erase(pair);
    cover.push_back(best);
  }
  return cover;
}

void runs_three_steps(const Case& scene) {
  Tank tank(scene);
  tank.pack_and_start(5);
  for (int step = 0; step < 3; ++step) {
    const StepReport report = tank.solver->advance();
    EXPECT_EQ(report.offender, -1);
    EXPECT_GT(report.time_step, tank.discretisation.least_time_step);
  }
  const FluidState fluid = tank.solver->download();
  EXPECT_TRUE(all_finite(fluid));
  const double mass = scene.fluid.density * total(tank.layout.volumes);
  EXPECT_NEAR(total(fluid.mass), mass, 1e-6 * mass);
  EXPECT_NEAR(tank.solver->energies().mass, mass, 1e-6 * mass);
  double moved = 0;
  for (const Vector3d& velocity : fluid.velocity) moved = std::max(moved, velocity.norm());
  EXPECT_GT(moved, 0.0) << "three steps in which nothing moved";
}

/// A column that begins to fall, so that every term takes part.
Case column(const Vector3d& size, double spacing) {
  Case scene = box_case(size, 0.4, spacing);
  scene.fluid.fill = {Box{Vector3d::Zero(), Vector3d(0.3, size.y(), 0.4)}};
  return scene;
}

TEST(Variants, EveryPairOfOptionsRunsIn2D) {
  int count = 0;
  for (const Choice& choice : covering_choices()) {
    const Case scene = with(column(Vector3d(0.6, 0, 0.6), 0.05), choice);
    if (!has_precision(scene.numerics.precision)) continue;
    SCOPED_TRACE(describe(choice));
    runs_three_steps(scene);
    ++count;
  }
  std::printf("%d choices in 2-D hold every pair of values\n", count);
  EXPECT_GE(count, 3);
}

TEST(Variants, EveryKindOfWallRuns) {
  for (const int dimensions : {2, 3})
    for (const auto elements : {WallElements::numerical, WallElements::semi_analytical, WallElements::facet})
      for (const auto shepard : {ShepardFactor::none, ShepardFactor::volumetric, ShepardFactor::monolithic, ShepardFactor::geometric}) {
        if (shepard == ShepardFactor::monolithic && elements == WallElements::facet) continue;  // refused when the case is read
        Case scene = column(dimensions == 2 ? Vector3d(0.6, 0, 0.6) : Vector3d(0.4, 0.2, 0.6), 0.05);
        scene.numerics.walls.elements = elements;
        scene.numerics.walls.shepard = shepard;
        scene.numerics.walls.renormalise_divergence = shepard != ShepardFactor::volumetric || dimensions == 2;
        SCOPED_TRACE(std::to_string(dimensions) + "-D, elements " + std::to_string(static_cast<int>(elements)) + ", factor " +
                     std::to_string(static_cast<int>(shepard)));
        runs_three_steps(scene);
      }
}

TEST(Variants, EveryOptionRunsIn3D) {
  for (const Choice& choice : {Choice{0, 1, 0, 1, 0, 1}, Choice{2, 0, 1, 0, 1, 0}, Choice{1, 1, 1, 1, 0, 0}}) {
    const Case scene = with(column(Vector3d(0.4, 0.2, 0.6), 0.05), choice);
    if (!has_precision(scene.numerics.precision)) continue;
    SCOPED_TRACE(describe(choice));
    runs_three_steps(scene);
  }
}

}  // namespace
}  // namespace wavetank

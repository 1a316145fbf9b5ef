// Every value of every option builds and runs: each pair of values of two options at least once in 2-D, each value in 3-D.
#include <algorithm>
#include <array>
#include <functional>
#include <set>
#include <utility>

#include "sph_fixture.h"

namespace wavetank {
namespace {

/// A key of the case, and how it is given each of its values.
struct Option {
  std::string name;
  std::vector<std::pair<std::string, std::function<void(NumericsCase&)>>> values;
};

template <class Choice>
Option option_of(const std::string& name, Choice NumericsCase::*member) {
  Option option{name, {}};
  for (const MethodWord<Choice>& known : method_words<Choice>())
    option.values.emplace_back(known.word, [member, choice = known.choice](NumericsCase& numerics) { numerics.*member = choice; });
  return option;
}

template <class Value>
Option walls_option(const std::string& name, Value WallCase::*member, const std::vector<std::pair<std::string, Value>>& values) {
  Option option{name, {}};
  for (const auto& [word, value] : values)
    option.values.emplace_back(word, [member, value = value](NumericsCase& numerics) { numerics.walls.*member = value; });
  return option;
}

/// Every word of every key by which a case chooses its method, and what else kernels are compiled for.
const std::vector<Option>& options() {
  static const std::vector<Option> all{
      option_of("scheme", &NumericsCase::scheme),
      option_of("density_diffusion", &NumericsCase::density_diffusion),
      option_of("integrator", &NumericsCase::integrator),
      walls_option<WallElements>(
          "elements", &WallCase::elements,
          {{"numerical", WallElements::numerical}, {"semi_analytical", WallElements::semi_analytical}, {"facet", WallElements::facet}}),
      option_of("equation_of_state", &NumericsCase::equation_of_state),
      option_of("viscosity_model", &NumericsCase::viscosity_model),
      walls_option<Slip>("slip", &WallCase::slip, {{"no_slip", Slip::no_slip}, {"free_slip", Slip::free_slip}}),
      {"negative_pressure",
       {{"allowed", [](NumericsCase& numerics) { numerics.negative_pressure = NegativePressure::allowed; }},
        {"clamped", [](NumericsCase& numerics) { numerics.negative_pressure = NegativePressure::clamped; }}}},
      {"precision",
       {{"single", [](NumericsCase& numerics) { numerics.precision = Precision::single; }},
        {"double", [](NumericsCase& numerics) { numerics.precision = Precision::double_; }}}}};
  return all;
}

/// A value of each option.
using Choice = std::vector<int>;

Case with(Case scene, const Choice& choice) {
  for (std::size_t k = 0; k < choice.size(); ++k) options()[k].values[choice[k]].second(scene.numerics);
  return scene;
}

std::string describe(const Choice& choice) {
  std::string text;
  for (std::size_t k = 0; k < choice.size(); ++k)
    text += (k == 0 ? "" : ", ") + options()[k].name + " " + options()[k].values[choice[k]].first;
  return text;
}

/// Pairs of values of two options, as (option, value, option, value).
using Pair = std::array<int, 4>;

/// Of shifting laws, which have kernels of their own, each in turn.
template <class Choice>
Choice nth(std::size_t k) {
  return method_words<Choice>()[k % method_words<Choice>().size()].choice;
}

/// Few choices that hold every pair of values of two options: each begins with a pair that is still missing, and goes on, option by option,
/// with the value that brings most others.
std::vector<Choice> covering_choices() {
  const int count = static_cast<int>(options().size());
  const auto size = [](int option) { return static_cast<int>(options()[option].values.size()); };
  std::set<Pair> missing;
  for (int a = 0; a < count; ++a)
    for (int b = a + 1; b < count; ++b)
      for (int x = 0; x < size(a); ++x)
        for (int y = 0; y < size(b); ++y) missing.insert({a, x, b, y});
  const auto pair = [](int a, int x, int b, int y) { return a < b ? Pair{a, x, b, y} : Pair{b, y, a, x}; };
  std::vector<Choice> cover;
  while (!missing.empty()) {
    const Pair first = *missing.begin();
    Choice choice(count, -1);
    choice[first[0]] = first[1];
    choice[first[2]] = first[3];
    for (int option = 0; option < count; ++option) {
      if (choice[option] >= 0) continue;
      int best = 0, most = -1;
      for (int value = 0; value < size(option); ++value) {
        int gain = 0;
        for (int other = 0; other < count; ++other)
          if (choice[other] >= 0 && missing.count(pair(option, value, other, choice[other])) != 0) ++gain;
        if (gain > most) {
          most = gain;
          best = value;
        }
      }
      choice[option] = best;
    }
    for (int a = 0; a < count; ++a)
      for (int b = a + 1; b < count; ++b) missing.erase({a, choice[a], b, choice[b]});
    cover.push_back(choice);
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
  // where volumes evolve, the mass at the start is that of the volume under the hydrostatic pressure
  const double tolerance = scene.numerics.scheme == Scheme::riemann_ale ? 0.02 : 1e-6;
  EXPECT_NEAR(total(fluid.mass), mass, tolerance * mass);
  EXPECT_NEAR(tank.solver->energies().mass, total(fluid.mass), 1e-6 * mass);
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
  std::set<std::string> laws;
  for (const Choice& choice : covering_choices()) {
    Case scene = with(column(Vector3d(0.6, 0, 0.6), 0.05), choice);
    scene.numerics.shifting = nth<Shifting>(count);
    if (!has_precision(scene.numerics.precision)) continue;
    laws.insert(word_of(scene.numerics.shifting));
    SCOPED_TRACE(describe(choice) + ", shifting " + word_of(scene.numerics.shifting));
    runs_three_steps(scene);
    ++count;
  }
  std::printf("%d choices in 2-D hold every pair of values\n", count);
  EXPECT_GE(count, 3);
  if (has_precision(Precision::double_)) EXPECT_EQ(laws.size(), method_words<Shifting>().size());
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

/// Every value once: the k-th of each option, as far as it has so many.
TEST(Variants, EveryValueRunsIn3D) {
  std::size_t most = 0;
  for (const Option& option : options()) most = std::max(most, option.values.size());
  most = std::max(most, method_words<Shifting>().size());
  for (std::size_t k = 0; k < most; ++k) {
    Choice choice;
    for (const Option& option : options()) choice.push_back(static_cast<int>(k % option.values.size()));
    Case scene = with(column(Vector3d(0.4, 0.2, 0.6), 0.05), choice);
    scene.numerics.precision = Precision::single;
    scene.numerics.shifting = nth<Shifting>(k);
    SCOPED_TRACE(describe(choice));
    runs_three_steps(scene);
  }
}

}  // namespace
}  // namespace wavetank

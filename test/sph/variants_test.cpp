// Every value of every option builds and runs: each pair of values of two options at least once in 2-D, each value in 3-D.
#include <algorithm>
#include <array>
#include <functional>
#include <random>
#include <set>
#include <tuple>
#include <utility>

#include "sph_fixture.h"

namespace wavetank::variants_test {
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
      walls_option<ShepardFactor>("shepard", &WallCase::shepard,
                                  {{"none", ShepardFactor::none},
                                   {"volumetric", ShepardFactor::volumetric},
                                   {"geometric", ShepardFactor::geometric},
                                   {"monolithic", ShepardFactor::monolithic}}),
      walls_option<bool>("renormalise_divergence", &WallCase::renormalise_divergence, {{"true", true}, {"false", false}}),
      option_of("equation_of_state", &NumericsCase::equation_of_state),
      option_of("viscosity_model", &NumericsCase::viscosity_model),
      option_of("turbulence", &NumericsCase::turbulence),
      {"friction",
       {{"viscous", [](NumericsCase& numerics) { numerics.walls.friction.law = FrictionLaw::viscous; }},
        {"law_of_the_wall", [](NumericsCase& numerics) { numerics.walls.friction.law = FrictionLaw::law_of_the_wall; }},
        {"coefficient", [](NumericsCase& numerics) { numerics.walls.friction.law = FrictionLaw::coefficient; }}}},
      walls_option<Slip>("slip", &WallCase::slip, {{"no_slip", Slip::no_slip}, {"free_slip", Slip::free_slip}}),
      {"acoustic_damping",
       {{"0", [](NumericsCase& numerics) { numerics.acoustic_damping = 0; }},
        {"2", [](NumericsCase& numerics) { numerics.acoustic_damping = 2; }}}},
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

int size_of(int option) { return static_cast<int>(options()[option].values.size()); }

Pair pair_of(int a, int x, int b, int y) { return a < b ? Pair{a, x, b, y} : Pair{b, y, a, x}; }

int option_called(const std::string& name) {
  const auto found = std::find_if(options().begin(), options().end(), [&](const Option& option) { return option.name == name; });
  return static_cast<int>(found - options().begin());
}

int value_called(int option, const std::string& word) {
  const auto& values = options()[option].values;
  return static_cast<int>(std::find_if(values.begin(), values.end(), [&](const auto& value) { return value.first == word; }) -
                          values.begin());
}

/// What is refused when the case is read.
Pair refused() {
  const int elements = option_called("elements"), shepard = option_called("shepard");
  return pair_of(elements, value_called(elements, "facet"), shepard, value_called(shepard, "monolithic"));
}

std::set<Pair> every_pair() {
  std::set<Pair> pairs;
  for (int a = 0; a < static_cast<int>(options().size()); ++a)
    for (int b = a + 1; b < static_cast<int>(options().size()); ++b)
      for (int x = 0; x < size_of(a); ++x)
        for (int y = 0; y < size_of(b); ++y) pairs.insert({a, x, b, y});
  pairs.erase(refused());
  return pairs;
}

/// Choices that hold every pair of values of two options: each begins with a pair that is still missing, and goes on, option by option in a
/// random order, with the value that brings most others.
std::vector<Choice> some_covering_choices(std::mt19937& random) {
  const int count = static_cast<int>(options().size());
  const Pair never = refused();
  std::set<Pair> missing = every_pair();
  std::vector<int> order(count);
  for (int k = 0; k < count; ++k) order[k] = k;
  std::vector<Choice> cover;
  while (!missing.empty()) {
    std::shuffle(order.begin(), order.end(), random);
    const Pair first = *std::next(missing.begin(), static_cast<long>(random() % missing.size()));
    Choice choice(count, -1);
    choice[first[0]] = first[1];
    choice[first[2]] = first[3];
    for (const int option : order) {
      if (choice[option] >= 0) continue;
      int best = 0, most = -1;
      for (int value = 0; value < size_of(option); ++value) {
        int gain = 0;
        for (int other = 0; other < count; ++other) {
          if (choice[other] < 0) continue;
          const Pair pair = pair_of(option, value, other, choice[other]);
          gain += pair == never ? -count : static_cast<int>(missing.count(pair));
        }
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

/// The fewest of many tries: a driver's compiler takes seconds for each choice.
std::vector<Choice> covering_choices() {
  constexpr unsigned seed = 1;
  constexpr int tries = 500;
  std::mt19937 random(seed);
  std::vector<Choice> fewest = some_covering_choices(random);
  for (int k = 1; k < tries; ++k) {
    std::vector<Choice> cover = some_covering_choices(random);
    if (cover.size() < fewest.size()) fewest = std::move(cover);
  }
  return fewest;
}

/// Whether particles are to be packed: once for each kind of walls and precision. What else packing's kernel is compiled for is in what it
/// shares with those of every step.
bool packs(const Case& scene) {
  static std::set<std::tuple<int, WallElements, Precision>> packed;
  return packed.insert({scene.dimensions, scene.numerics.walls.elements, scene.numerics.precision}).second;
}

void runs_three_steps(const Case& scene) {
  Tank tank(scene);
  if (packs(scene)) tank.solver->pack(5, {});
  tank.solver->start();
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
  std::set<Pair> missing = every_pair();
  std::set<std::string> laws;
  std::size_t count = 0;
  for (const Choice& choice : covering_choices()) {
    Case scene = with(column(Vector3d(0.6, 0, 0.6), 0.05), choice);
    // each law once: what they have in common is compiled anew for each choice
    scene.numerics.shifting = count < method_words<Shifting>().size() ? nth<Shifting>(count) : Shifting::none;
    if (!has_precision(scene.numerics.precision)) continue;
    laws.insert(word_of(scene.numerics.shifting));
    SCOPED_TRACE(describe(choice) + ", shifting " + word_of(scene.numerics.shifting));
    runs_three_steps(scene);
    for (int a = 0; a < static_cast<int>(choice.size()); ++a)
      for (int b = a + 1; b < static_cast<int>(choice.size()); ++b) missing.erase({a, choice[a], b, choice[b]});
    ++count;
  }
  std::printf("%zu choices in 2-D hold every pair of values\n", count);
  if (!has_precision(Precision::double_)) return;
  EXPECT_TRUE(missing.empty()) << missing.size() << " pairs were not run";
  EXPECT_EQ(laws.size(), method_words<Shifting>().size());
}

/// The k-th value of every option in turn, and the k-th law; which kinds of walls go with which factors is the pairs' matter.
TEST(Variants, EveryValueRunsIn3D) {
  const int precision = option_called("precision");
  std::set<std::pair<int, int>> missing;
  std::size_t most = method_words<Shifting>().size();
  for (int option = 0; option < static_cast<int>(options().size()); ++option) {
    most = std::max(most, options()[option].values.size());
    for (int value = 0; value < size_of(option); ++value) missing.emplace(option, value);
  }
  missing.erase({precision, value_called(precision, "double")});  // its kernels are those of 2-D
  for (std::size_t k = 0; k < most; ++k) {
    Choice choice;
    for (const Option& option : options()) choice.push_back(static_cast<int>(k % option.values.size()));
    choice[precision] = value_called(precision, "single");
    const int elements = option_called("elements"), shepard = option_called("shepard");
    ASSERT_NE(pair_of(elements, choice[elements], shepard, choice[shepard]), refused());
    Case scene = with(column(Vector3d(0.4, 0.2, 0.6), 0.05), choice);
    scene.numerics.shifting = nth<Shifting>(k);
    SCOPED_TRACE(describe(choice) + ", shifting " + word_of(scene.numerics.shifting));
    runs_three_steps(scene);
    for (int option = 0; option < static_cast<int>(choice.size()); ++option) missing.erase({option, choice[option]});
  }
  EXPECT_TRUE(missing.empty()) << missing.size() << " values were not run";
}

}  // namespace
}  // namespace wavetank::variants_test

#include "../../src/bench/bench_case.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "../common/error_of.h"
#include "wavetank/geometry/layout.h"
#include "wavetank/scene/case_reader.h"

namespace wavetank::bench::bench_case_test {
namespace {

std::vector<std::string> names_of(const std::vector<BenchCase>& cases) {
  std::vector<std::string> names;
  for (const BenchCase& bench_case : cases) names.push_back(bench_case.name);
  return names;
}

}  // namespace

TEST(BenchCases, HaveNamesOfTheirOwn) {
  const std::vector<std::string> names = names_of(all_cases());
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
  EXPECT_EQ(names.size(), 2U * 5U * 3U * 3U * 7U + 1U + 2U * 2U * 3U * 6U * 3U);
  EXPECT_EQ(case_named("dam_break_3d/100k/h1.73/fourtakas/facet").smoothing, 1.73);
  EXPECT_NE(error_of([] { case_named("dam_break_4d"); }).find("dam_break_4d"), std::string::npos);
}

TEST(BenchCases, AreChosenByPartsOfTheirNames) {
  EXPECT_EQ(chosen_cases({}).size(), default_cases().size());
  EXPECT_EQ(names_of(short_cases()),
            (std::vector<std::string>{"dam_break_3d/100k/h1.5/fourtakas/facet", "dam_break_3d/1M/h1.5/fourtakas/facet"}));
  EXPECT_EQ(names_of(chosen_cases({"spheric2"})), std::vector<std::string>{"spheric2_45"});
  EXPECT_EQ(chosen_cases({"3d/", "/1M/", "h2", "antuono"}).size(), 7U);
  EXPECT_EQ(names_of(chosen_cases({"/ghost", "2d/10k/h1.5/none"})), std::vector<std::string>{"dam_break_2d/10k/h1.5/none/ghost"});
  const std::string refused = error_of([] { chosen_cases({"3d", "7k"}); });
  EXPECT_NE(refused.find("'3d' and '7k'"), std::string::npos) << refused;
}

TEST(BenchCases, HaveEverySchemeLawAndIntegrator) {
  EXPECT_EQ(chosen_cases({"methods_3d/100k"}).size(), 3U * 6U * 3U);
  const Case scene = make_case(case_named("methods_2d/30k/riemann_ale/michel/runge_kutta_4"), "auto");
  EXPECT_EQ(scene.numerics.scheme, Scheme::riemann_ale);
  EXPECT_EQ(scene.numerics.shifting, Shifting::michel);
  EXPECT_EQ(scene.numerics.integrator, Integrator::runge_kutta_4);
  EXPECT_EQ(scene.numerics.density_diffusion, DensityDiffusion::none);
  const Case usual = make_case(case_named("methods_3d/100k/delta_sph/none/symplectic"), "auto");
  EXPECT_EQ(usual.numerics.density_diffusion, DensityDiffusion::fourtakas);
}

TEST(BenchCases, OfTheDefaultVaryOneThingAtATime) {
  std::map<std::string, int> with;
  for (const std::string& name : names_of(default_cases()))
    for (const char* part : {"dam_break_2d", "dam_break_3d", "/100k/", "h1.73", "h2", "antuono", "/none/", "/ghost", "spheric2_45"})
      with[part] += name.find(part) != std::string::npos;
  EXPECT_EQ(with["dam_break_2d"], 5);
  EXPECT_EQ(with["dam_break_3d"], 5 + 2 + 2 + 6);
  EXPECT_EQ(with["/100k/"], 1 + 1 + 2 + 2 + 6);
  for (const char* part : {"h1.73", "h2", "antuono", "/none/", "/ghost", "spheric2_45"}) EXPECT_EQ(with[part], 1) << part;
}

TEST(BenchCases, HaveAsManyParticlesAsTheySay) {
  const std::map<std::string, double> sizes = {{"10k", 1e4}, {"30k", 3e4}, {"100k", 1e5}, {"300k", 3e5}, {"1M", 1e6}};
  for (const BenchCase& bench_case : all_cases()) {
    const auto particles = static_cast<double>(particles_at(bench_case.dimensions, bench_case.spacing));
    for (const auto& [name, size] : sizes)
      if (bench_case.name.find("/" + name + "/") != std::string::npos) EXPECT_NEAR(particles / size, 1, 0.03) << bench_case.name;
  }
  for (const char* name : {"dam_break_2d/10k/h1.5/fourtakas/facet", "dam_break_3d/10k/h1.5/fourtakas/facet"}) {
    const BenchCase& bench_case = case_named(name);
    EXPECT_EQ(lay_out(make_case(bench_case, "auto")).particles.size(), particles_at(bench_case.dimensions, bench_case.spacing)) << name;
  }
}

TEST(BenchCases, AreCasesThatAFileCouldHold) {
  for (const BenchCase& bench_case : all_cases()) {
    const Case scene = make_case(bench_case, "0:0");
    EXPECT_NO_THROW(read_case_text(write_case(scene), bench_case.name)) << bench_case.name;
    EXPECT_EQ(*scene.numerics.support, 2 * bench_case.smoothing);
  }
}

TEST(BenchCases, HaveSmallTwinsOfTheSameKernels) {
  for (const BenchCase& bench_case : all_cases()) {
    const BenchCase& twin = case_named(bench_case.small_twin);
    EXPECT_LT(particles_at(twin.dimensions, twin.spacing), 31000U) << bench_case.name;
    EXPECT_EQ(twin.dimensions, bench_case.dimensions);
    EXPECT_EQ(twin.smoothing, bench_case.smoothing);
    EXPECT_EQ(twin.diffusion, bench_case.diffusion);
    EXPECT_EQ(twin.walls.name, bench_case.walls.name);
  }
}

}  // namespace wavetank::bench::bench_case_test

#include "../../src/bench/report.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <limits>

#include "../../src/bench/json.h"
#include "../../src/bench/text_table.h"

namespace wavetank::bench::report_test {
namespace {

constexpr std::size_t particles = 1000;

/// Steps of 10 ms, of which momentum takes 4, continuity 2 and the watchdog 1.
Block block_of(int steps, double factor) {
  Block block;
  block.steps = steps;
  block.seconds = factor * 0.01 * steps;
  const auto launches = static_cast<std::uint64_t>(steps);
  block.kernels = {{"momentum", launches, factor * 0.004 * steps},
                   {"continuity", launches, factor * 0.002 * steps},
                   {"watch_total", launches, factor * 0.001 * steps}};
  block.pairs = {30 * particles, 90 * particles};
  return block;
}

Measurement measured() { return summarised(case_named("dam_break_2d/10k/h1.5/none/facet"), particles, {block_of(10, 1), block_of(8, 2)}); }

Report report_of(const Measurement& measurement) {
  Report report;
  report.device = "0:0 a \"device\"\\";
  report.repeats = 2;
  report.limits = {1e9, 2e9, 3e9};
  report.cases = {measurement};
  report.skipped = {{"dam_break_3d/1M/h2/none/facet", "it needs more than there is"}};
  return report;
}

TEST(Measurement, HasRatesOfWholeStepsAndOfEvaluations) {
  const Measurement m = measured();
  EXPECT_EQ(m.steps, 8);
  ASSERT_EQ(m.particle_steps.values.size(), 2U);
  EXPECT_NEAR(m.particle_steps.values[0], 1e5, 1e-6);
  EXPECT_NEAR(m.evaluations.values[0], particles / 0.006, 1e-6);
  EXPECT_NEAR(m.pairs.values[1], 30 * particles / 0.012, 1e-6);
  EXPECT_EQ(m.pairs_per_particle.median(), 30);
  EXPECT_EQ(m.candidates_per_particle.median(), 90);
  EXPECT_NEAR(m.step_milliseconds.median(), 15, 1e-9);
  EXPECT_NEAR(m.host_milliseconds.values[0], 3, 1e-9);
  EXPECT_NEAR(m.host_percent.values[0], 30, 1e-9);
}

TEST(Measurement, HasTheDearestKernelFirstAndItsShareOfTheLimits) {
  const Measurement m = measured();
  ASSERT_EQ(m.kernels.size(), 3U);
  EXPECT_EQ(m.kernels[0].kernel, "momentum");
  EXPECT_NEAR(m.kernels[0].milliseconds.values[1], 8, 1e-9);
  ASSERT_EQ(m.sweeps.size(), 2U);  // no density gradient without Antuono's diffusion
  EXPECT_GT(m.sweeps[0].flops_per_candidate, 0);
  EXPECT_NEAR(m.sweeps[0].flops.values[0], m.sweeps[0].flops_per_candidate * 90 * particles / 0.004, 1e-3);
}

TEST(Measurement, HasNoRateWhereThereAreNoTimes) {
  Block block = block_of(5, 1);
  block.kernels.clear();
  const Measurement m = summarised(case_named("spheric2_45"), particles, {block});
  EXPECT_NE(table_of(report_of(m)).find("–"), std::string::npos);
  EXPECT_TRUE(YAML::Load(json_of(report_of(m)))["cases"][0]["pairs_per_second"]["median"].IsNull());
}

TEST(Report, JsonHasWhatTheTableHas) {
  Measurement m = measured();
  m.bytes_per_particle = 218.7;
  m.start_up = {1, 2, 3, 4.5};
  m.cold_build = 12.34;
  const Report report = report_of(m);
  const YAML::Node json = YAML::Load(json_of(report));
  EXPECT_EQ(json["device"].as<std::string>(), report.device);
  EXPECT_EQ(json["repeats"].as<int>(), 2);
  EXPECT_FALSE(json["interrupted"].as<bool>());
  EXPECT_EQ(json["skipped"][0]["name"].as<std::string>(), report.skipped[0].name);
  ASSERT_EQ(json["cases"].size(), 1U);
  const YAML::Node one = json["cases"][0];
  EXPECT_EQ(one["name"].as<std::string>(), m.bench_case.name);
  EXPECT_EQ(one["particles"].as<std::size_t>(), particles);
  EXPECT_EQ(one["particle_steps_per_second"]["values"].size(), 2U);

  const std::string table = table_of(report);
  const auto in_table = [&](double value) {
    EXPECT_NE(table.find(" " + figure(value) + " "), std::string::npos) << value << "\n" << table;
  };
  for (const char* rate : {"particle_steps_per_second", "evaluated_particles_per_second", "pairs_per_second"})
    in_table(one[rate]["median"].as<double>() / 1e6);
  for (const char* series : {"pairs_per_particle", "candidates_per_particle", "step_ms", "host_ms", "host_percent"})
    in_table(one[series]["median"].as<double>());
  EXPECT_EQ(one["kernels_ms"].size(), 3U);
  for (const auto& kernel : one["kernels_ms"]) {
    in_table(kernel.second["median"].as<double>());
    EXPECT_NE(table.find(" " + kernel.first.as<std::string>() + " "), std::string::npos);
  }
  for (const char* part : {"total", "layout", "kernel_build", "packing", "first_step"}) in_table(one["start_up_s"][part].as<double>());
  in_table(one["cold_build_s"].as<double>());
  in_table(one["device_bytes_per_particle"].as<double>());
  in_table(json["limits"]["inverse_roots_per_second"].as<double>() / 1e9);
  for (const auto& sweep : one["sweeps"])
    for (const char* key : {"flops_per_candidate", "flops_percent_of_limit", "bytes_per_candidate", "bytes_percent_of_limit"})
      in_table(sweep.second[key].as<double>());
}

TEST(Json, KeepsEveryCharacterAndKnowsNoInfinity) {
  const std::string odd = "\"\\\n\t\x01 ö";
  const YAML::Node json = YAML::Load(
      Json::object({{"text", odd}, {"none", std::numeric_limits<double>::infinity()}, {"empty", Json::list({})}, {"truth", true}}).text());
  EXPECT_EQ(json["text"].as<std::string>(), odd);
  EXPECT_TRUE(json["none"].IsNull());
  EXPECT_EQ(json["empty"].size(), 0U);
  EXPECT_TRUE(json["truth"].as<bool>());
}

TEST(TextTable, PadsItsColumns) {
  TextTable table({"a", "long"});
  table.add({"±x", "1"});
  EXPECT_EQ(table.text(), "| a  | long |\n|----|------|\n| ±x | 1    |\n");
}

TEST(Figure, HasThreeDigits) {
  EXPECT_EQ(figure(0), "0");
  EXPECT_EQ(figure(1234.4), "1234");
  EXPECT_EQ(figure(12.345), "12.3");
  EXPECT_EQ(figure(-0.012345), "-0.0123");
  EXPECT_EQ(figure(std::numeric_limits<double>::quiet_NaN()), "–");
}

TEST(StartUp, ComesBackFromItsLine) {
  const StartUp time = start_up_of(text_of({0.25, 1.5, 0.125, 3}));
  EXPECT_EQ(time.total(), 4.875);
  EXPECT_EQ(time.without_layout(), 4.625);
  EXPECT_THROW(start_up_of("nothing"), Error);
}

}  // namespace
}  // namespace wavetank::bench::report_test

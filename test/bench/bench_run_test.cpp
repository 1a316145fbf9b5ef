#include "../../src/bench/bench_run.h"

#include <gtest/gtest.h>

namespace wavetank::bench::bench_run_test {
namespace {

Report run_on(const compute::DeviceInfo& device, const std::vector<std::string>& names, bool stopped) {
  BenchOptions options;
  options.repeats = 1;
  options.cold_build = false;
  std::vector<BenchCase> cases;
  for (const std::string& name : names) cases.push_back(case_named(name));
  return BenchRun(options, device, {}, [stopped] { return stopped; }).run(cases);
}

TEST(BenchRun, SkipsWhatTheMemoryCannotHold) {
  compute::DeviceInfo device = compute::choose_device("auto");
  device.global_memory = std::size_t{16} << 20;  // as if
  const Report report = run_on(device, {"dam_break_2d/300k/h1.5/fourtakas/facet", "dam_break_2d/10k/h1.5/fourtakas/facet"}, false);
  ASSERT_EQ(report.skipped.size(), 1U);
  EXPECT_EQ(report.skipped[0].name, "dam_break_2d/300k/h1.5/fourtakas/facet");
  EXPECT_NE(report.skipped[0].why.find("which has 0.0156 GiB"), std::string::npos) << report.skipped[0].why;
  EXPECT_NE(table_of(report).find("skipped dam_break_2d/300k"), std::string::npos);
  ASSERT_EQ(report.cases.size(), 1U);
  EXPECT_GT(report.cases[0].particle_steps.median(), 0);
  EXPECT_FALSE(report.interrupted);
}

TEST(BenchRun, EndsWhenItIsStopped) {
  const Report report = run_on(compute::choose_device("auto"), {"spheric2_45"}, true);
  EXPECT_TRUE(report.interrupted);
  EXPECT_TRUE(report.cases.empty() && report.skipped.empty());
}

}  // namespace
}  // namespace wavetank::bench::bench_run_test

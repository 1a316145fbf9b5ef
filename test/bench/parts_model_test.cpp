// The model of steps in parts: its arithmetic, and that its inputs are measured.
#include "../../src/bench/parts_model.h"

#include <gtest/gtest.h>

namespace wavetank::bench::parts_model_test {
namespace {

constexpr double micro = 1e-6;

PartsCosts costs() { return {0.4 * micro, 0.1 * micro, 200 * micro, 50 * micro, 1e-9}; }

TEST(PartsModel, AddsWhatAStepDoes) {
  const PartsLoad load{1e5, 1e4, 2, 4, 1e6};
  EXPECT_DOUBLE_EQ(step_seconds(costs(), load), 0.04 + 0.011 + 0.0004 + 0.0002 + 0.001);
  EXPECT_DOUBLE_EQ(step_seconds(costs(), {1e5, 0, 1, 0, 0}), 0.05 + 0.0002);
}

TEST(PartsModel, SlabsThatAreThinAreInefficient) {
  PartsReport report;
  report.costs = costs();
  report.halo = 5;
  report.copy_bytes = 40;
  report.messages = 4;
  const Fleet basin{"basin", 2000, 500000, 64}, flume{"flume", 40000, 25000, 64};
  const double thin = efficiency(basin, report, costs()), thick = efficiency(flume, report, costs());
  // 15 625 000 own particles of 0.5 µs; 5 million copies of 0.1 µs and 40 bytes
  EXPECT_NEAR(thin, 7.8125 / (7.8125 + 0.5 + 0.0002 + 0.0004 + 0.2), 1e-12);
  EXPECT_GT(thick, 0.99);
  EXPECT_GT(thick, thin);
  EXPECT_LT(efficiency({"one more", 2000, 500000, 128}, report, costs()), thin);
}

TEST(PartsModel, MeasuresMessages) {
  const MessageCosts messages = measure_messages(compute::choose_device("auto"));
  EXPECT_GT(messages.message, 0);
  EXPECT_LT(messages.message, 0.1);
  EXPECT_LT(messages.byte, 1e-6);
}

TEST(PartsModel, MeasuresStepsInParts) {
  const BenchCase& small = case_named("dam_break_2d/10k/h1.5/fourtakas/facet");
  const PartsReport report = measure_parts(small, compute::choose_device("auto"), {2}, 1, [] { return false; });
  ASSERT_EQ(report.measured.size(), 1U);
  const PartsMeasurement& two = report.measured[0];
  EXPECT_GT(two.seconds, 0);
  EXPECT_GT(two.by_the_model, 0);
  EXPECT_GT(two.load.messages, 2) << "particles, and a halo's rates";
  EXPECT_GT(two.load.bytes, 1000);
  EXPECT_GT(report.halo, 3) << "the support, at the least";
  EXPECT_LT(report.halo, 9);
  EXPECT_NE(table_of(report).find("2 parts"), std::string::npos);
}

}  // namespace
}  // namespace wavetank::bench::parts_model_test

// The self-check's own logic: what it tells, and that what is wrong fails.
#include "../../src/bench/check/check.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <limits>

#include "../../src/bench/check/check_options.h"
#include "../common/error_of.h"

namespace wavetank::bench::check_test {
namespace {

CheckPart part_of(const std::string& name, const std::vector<Check>& checks) {
  return {name, [checks](const compute::DeviceInfo&) { return checks; }};
}

CheckPart failing_part(const std::string& name) {
  return {name, [](const compute::DeviceInfo&) -> std::vector<Check> { throw Error("the kernel \"sums\" could not be built"); }};
}

const Check good{"front at the box", 0.42, 0.4, 0.44, "s"};

CheckReport report_of(const std::vector<CheckPart>& parts) {
  return run_parts(parts, {}, [](const CheckReport&) {});
}

CheckOptions read(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "wavetank_check");
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  return read_check_options(static_cast<int>(pointers.size()), pointers.data());
}

}  // namespace

TEST(Check, IsWithinWhatIsAllowed) {
  EXPECT_TRUE(good.ok());
  EXPECT_TRUE((Check{"edge", 2, 0, 2, ""}.ok()));
  EXPECT_FALSE((Check{"above", 2.001, 0, 2, ""}.ok()));
  EXPECT_FALSE((Check{"below", -0.001, 0, 2, ""}.ok()));
  Check one_sided{"nothing", 1e30, 0};
  EXPECT_TRUE(one_sided.ok());
  one_sided.value = std::nan("");
  EXPECT_FALSE(one_sided.ok());
}

TEST(CheckReport, IsWellOnlyIfEveryCheckOfEveryPartIs) {
  EXPECT_TRUE(report_of({part_of("one", {good}), part_of("two", {good, good})}).ok());
  Check bad = good;
  bad.value = 0.45;
  EXPECT_FALSE(report_of({part_of("one", {good, bad}), part_of("two", {good})}).ok());
  EXPECT_FALSE(report_of({part_of("one", {})}).ok()) << "a part that looked at nothing";
  EXPECT_FALSE(report_of({}).ok());
}

TEST(CheckReport, GoesOnAfterAPartThatFails) {
  std::vector<std::size_t> told;
  bool well_after_the_first = true;
  const CheckReport report =
      run_parts({part_of("one", {good}), failing_part("two"), part_of("three", {good})}, {}, [&](const CheckReport& so_far) {
        told.push_back(so_far.parts.size());
        if (so_far.parts.size() == 1) well_after_the_first = so_far.ok();
      });
  EXPECT_EQ(told, (std::vector<std::size_t>{1, 2, 3}));
  EXPECT_FALSE(well_after_the_first) << "two parts are still to come";
  EXPECT_FALSE(report.ok());
  EXPECT_EQ(report.parts[1].failure, "the kernel \"sums\" could not be built");
  EXPECT_TRUE(report.parts[2].ok());
}

TEST(CheckReport, TellsTheSameInItsTableAndInJson) {
  Check bad{"greatest speed", std::numeric_limits<double>::quiet_NaN(), 0, 0.02, "m/s"};
  const CheckReport report = report_of({part_of("dam_break", {good}), part_of("still_tank", {bad}), failing_part("tiles")});
  const std::string table = table_of(report);
  const auto line_with = [&](const std::string& text) {
    const std::size_t at = table.find(text), begin = table.rfind('\n', at) + 1;
    return at == std::string::npos ? std::string() : table.substr(begin, table.find('\n', at) - begin);
  };
  const std::string well = line_with("front at the box");
  for (const char* cell : {"| dam_break ", "| 0.42 ", "| 0.4 to 0.44 ", "| s ", "| ok "})
    EXPECT_NE(well.find(cell), std::string::npos) << well;
  for (const char* cell : {"| not a number ", "| FAILED "}) EXPECT_NE(line_with("greatest speed").find(cell), std::string::npos) << table;
  EXPECT_NE(line_with("ran to its end").find("FAILED"), std::string::npos);
  EXPECT_NE(table.find("tiles: the kernel \"sums\" could not be built\n"), std::string::npos);
  EXPECT_NE(table.find("self-check: FAILED\n"), std::string::npos);
  EXPECT_NE(table_of(report_of({part_of("one", {good})})).find("self-check: all is well\n"), std::string::npos);

  const YAML::Node json = YAML::Load(json_of(report));
  EXPECT_FALSE(json["ok"].as<bool>());
  EXPECT_TRUE(json["whole"].as<bool>());
  ASSERT_EQ(json["parts"].size(), 3U);
  EXPECT_EQ(json["parts"][0]["checks"][0]["value"].as<double>(), 0.42);
  EXPECT_TRUE(json["parts"][0]["ok"].as<bool>());
  EXPECT_TRUE(json["parts"][1]["checks"][0]["value"].IsNull());
  EXPECT_FALSE(json["parts"][1]["checks"][0]["ok"].as<bool>());
  EXPECT_EQ(json["parts"][2]["failure"].as<std::string>(), report.parts[2].failure);
}

TEST(CheckParts, AreChosenByName) {
  EXPECT_EQ(chosen_parts({}).size(), 4U);
  ASSERT_EQ(chosen_parts({"tiles", "still_tank"}).size(), 2U);
  EXPECT_EQ(chosen_parts({"tiles", "still_tank"})[0].name, "tiles");
  const std::string refused = error_of([] { chosen_parts({"tile"}); });
  EXPECT_NE(refused.find("'tile'"), std::string::npos);
  EXPECT_NE(refused.find("still_tank, dam_break, tiles, kernels"), std::string::npos);
}

TEST(CheckOptions, ReadEverythingAndRefuseWhatMakesNoSense) {
  const CheckOptions options = read({"--part", "tiles", "--part", "kernels", "--device", "0:1", "--json", "out.json"});
  EXPECT_TRUE(options.run);
  EXPECT_EQ(options.parts, (std::vector<std::string>{"tiles", "kernels"}));
  EXPECT_EQ(options.device, "0:1");
  EXPECT_EQ(options.json, "out.json");
  EXPECT_EQ(read({}).device, "auto");
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"--json"}, {"--json", ""}, {"--nonsense"}, {"case.yaml"}})
    EXPECT_THROW(read(arguments), Error) << arguments[0];
}

}  // namespace wavetank::bench::check_test

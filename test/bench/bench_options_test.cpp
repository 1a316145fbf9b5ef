#include "../../src/bench/bench_options.h"

#include <gtest/gtest.h>

#include "../common/error_of.h"
#include "../common/scratch_directory.h"

namespace wavetank::bench::bench_options_test {
namespace {

BenchOptions read(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "wavetank_bench");
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  return read_bench_options(static_cast<int>(pointers.size()), pointers.data());
}

}  // namespace

TEST(BenchOptions, ReadsEverything) {
  const BenchOptions options =
      read({"--filter", "3d", "--filter", "100k", "--device", "0:1", "--repeat", "7", "--json", "out.json", "--no-cold-build"});
  EXPECT_EQ(options.action, BenchOptions::Action::run);
  EXPECT_EQ(options.filters, (std::vector<std::string>{"3d", "100k"}));
  EXPECT_EQ(options.device, "0:1");
  EXPECT_EQ(options.repeats, 7);
  EXPECT_EQ(options.json, "out.json");
  EXPECT_FALSE(options.cold_build);
  EXPECT_TRUE(read({}).cold_build);
  EXPECT_TRUE(read({"--short"}).short_set);
  EXPECT_FALSE(options.short_set);
  EXPECT_EQ(read({}).repeats, 5);
}

TEST(BenchOptions, ChooseTheAction) {
  EXPECT_EQ(read({"--list"}).action, BenchOptions::Action::list);
  EXPECT_EQ(read({"--parts", "2,4"}).action, BenchOptions::Action::parts);
  EXPECT_EQ(read({"--parts", "2,4"}).parts, (std::vector<int>{2, 4}));
  EXPECT_EQ(read({start_up_option, "spheric2_45"}).action, BenchOptions::Action::start_up);
}

TEST(BenchOptions, RefuseWhatMakesNoSense) {
  EXPECT_NE(error_of([] { read({"--repeat", "0"}); }).find("--repeat 0"), std::string::npos);
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{{"--repeat", "-3"},
                                                                                         {"--repeat", "some"},
                                                                                         {"--json"},
                                                                                         {"--json", ""},
                                                                                         {"--nonsense"},
                                                                                         {"case.yaml"},
                                                                                         {"--parts", "1"},
                                                                                         {"--parts", "2", "--short"},
                                                                                         {"--short", "--filter", "3d"}})
    EXPECT_THROW(read(arguments), Error) << arguments[0];
}

}  // namespace wavetank::bench::bench_options_test

#include "wavetank/node/run_options.h"

#include <gtest/gtest.h>

#include "wavetank/common/error.h"
#include "wavetank/node/progress.h"
#include "wavetank/surface/surface_finder.h"

namespace wavetank::run_options_test {

namespace {

RunOptions read(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "wavetank_run");
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  return read_command_line(static_cast<int>(pointers.size()), pointers.data());
}

}  // namespace

TEST(RunOptions, ReadsEverything) {
  const RunOptions options = read(
      {"a.yaml", "--bag",     "b.bag", "--clouds", "--set", "fluid/spacing=0.02", "--set", "title=a=b", "--duration", "2.5", "--device",
       "0:1",    "--restore", "r",     "--save",   "s",     "--save-every",       "0.5",   "--profile", "--quiet"});
  EXPECT_EQ(options.action, RunOptions::Action::run);
  EXPECT_EQ(options.case_file, "a.yaml");
  EXPECT_EQ(options.bag, "b.bag");
  EXPECT_TRUE(options.clouds && options.profile && options.quiet);
  EXPECT_EQ(options.restore, "r");
  EXPECT_EQ(options.save, "s");
  EXPECT_EQ(options.save_every, 0.5);
  ASSERT_EQ(options.overrides.size(), 4U);
  EXPECT_EQ(options.overrides[0].key, "fluid/spacing");
  EXPECT_EQ(options.overrides[0].value, "0.02");
  EXPECT_EQ(options.overrides[1].value, "a=b");
  EXPECT_EQ(options.overrides[2].key, "duration");
  EXPECT_EQ(options.overrides[3].value, "\"0:1\"");
}

TEST(RunOptions, RefuseASurfaceThatCannotBeFound) {
  if (can_find_surface())
    EXPECT_TRUE(read({"a.yaml", "--bag", "b.bag", "--surface"}).surface);
  else
    EXPECT_THROW(read({"a.yaml", "--bag", "b.bag", "--surface"}), Error);
}

TEST(RunOptions, DoNotSwallowTheCaseAfterSet) {
  const RunOptions options = read({"--set", "duration=1", "--bag", "b.bag", "a.yaml"});
  EXPECT_EQ(options.case_file, "a.yaml");
  EXPECT_EQ(read({"--set", "duration=1", "a.yaml"}).case_file, "a.yaml");
}

TEST(RunOptions, ChooseTheAction) {
  EXPECT_EQ(read({"--list-devices"}).action, RunOptions::Action::list_devices);
  EXPECT_EQ(read({"--check", "a.yaml"}).action, RunOptions::Action::check);
  EXPECT_EQ(read({"--check", "a.yaml", "--parts", "4"}).parts, 4);
}

TEST(RunOptions, RefuseWhatMakesNoSense) {
  EXPECT_THROW(read({}), Error);
  EXPECT_THROW(read({"a.yaml", "--nonsense"}), Error);
  EXPECT_THROW(read({"a.yaml", "--save-every", "1"}), Error);
  EXPECT_THROW(read({"a.yaml", "--save", "s", "--save-every", "0"}), Error);
  EXPECT_THROW(read({"a.yaml", "--save", "s", "--save-every", "nan"}), Error);
  EXPECT_THROW(read({"a.yaml", "--set", "duration"}), Error);
  EXPECT_THROW(read({"a.yaml", "--clouds"}), Error);
  EXPECT_THROW(read({"a.yaml", "--particles"}), Error);
  EXPECT_THROW(read({"a.yaml", "--vtk-rate", "10"}), Error);
  EXPECT_THROW(read({"a.yaml", "--vtk", ""}), Error);
  EXPECT_THROW(read({"a.yaml", "--vtk="}), Error);
  EXPECT_THROW(read({"a.yaml", "--vtk", "out", "--vtk-rate", "nan"}), Error);
  EXPECT_THROW(read({"a.yaml", "--surface"}), Error);
  EXPECT_THROW(read({"a.yaml", "b.yaml"}), Error);
  EXPECT_THROW(read({"a.yaml", "--bag"}), Error);
  EXPECT_THROW(read({"a.yaml", "--parts", "4"}), Error);
  EXPECT_THROW(read({"a.yaml", "--check", "--parts", "0"}), Error);
}

TEST(DurationText, SuitsTheLength) {
  EXPECT_EQ(duration_text(0.25), "250 ms");
  EXPECT_EQ(duration_text(12.34), "12.3 s");
  EXPECT_EQ(duration_text(250), "4 min 10 s");
  EXPECT_EQ(duration_text(7500), "2 h 05 min");
}

}  // namespace wavetank::run_options_test

#include "../../src/bench/own_command.h"

#include <gtest/gtest.h>

namespace wavetank::bench::own_command_test {
namespace {

using Words = std::vector<std::string>;

/// As /proc/self/cmdline has them.
std::string joined(const Words& words) {
  std::string text;
  for (const std::string& word : words) text += word + '\0';
  return text;
}

}  // namespace

TEST(OwnCommand, IsTheProgram) {
  EXPECT_EQ(command_of(joined({"wavetank_bench", "--repeat", "3"}), 3, "/opt/wavetank_bench"), (Words{"/opt/wavetank_bench"}));
  EXPECT_EQ(command_of(joined({"wavetank_bench", "--json", ""}), 3, "/opt/wavetank_bench"), (Words{"/opt/wavetank_bench"}));
}

TEST(OwnCommand, TakesALoaderAlong) {
  EXPECT_EQ(command_of(joined({"lib/ld.so", "--library-path", "lib", "bin/wavetank_bench", "--repeat", "3"}), 3, "/opt/lib/ld.so"),
            (Words{"/opt/lib/ld.so", "--library-path", "lib", "bin/wavetank_bench"}));
}

}  // namespace wavetank::bench::own_command_test

// Fields times particles pass what 32 bits hold at 165 million particles: kernels take what they multiply with particles' fields as long.
#include <regex>

#include "sph_fixture.h"
#include "wavetank/sph/kernel_sources.h"

namespace wavetank::strides_test {
namespace {

TEST(Strides, AreLongInEveryKernel) {
  const std::regex stride("(\\w+)\\s+stride\\b\\s*[,;)=]");
  int found = 0;
  for (const auto& [name, text] : kernel_sources())
    for (std::sregex_iterator match(text.begin(), text.end(), stride), end; match != end; ++match) {
      EXPECT_EQ((*match)[1], "long") << name << ": " << match->str();
      ++found;
    }
  EXPECT_GT(found, 40);
}

}  // namespace
}  // namespace wavetank::strides_test

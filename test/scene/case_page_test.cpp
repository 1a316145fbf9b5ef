#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "wavetank/scene/case_reader.h"

namespace wavetank::case_page_test {

// With WAVETANK_WRITE_DOCS set in the environment, this writes the page instead of comparing it.
TEST(CasePage, IsWhatTheKeysSay) {
  const std::string path = std::string(WAVETANK_SOURCE_DIRECTORY) + "/docs/case.md";
  if (std::getenv("WAVETANK_WRITE_DOCS") != nullptr) {
    std::ofstream(path) << describe_case_keys();
  }
  std::ifstream file(path);
  ASSERT_TRUE(file) << path;
  std::ostringstream page;
  page << file.rdbuf();
  EXPECT_EQ(page.str(), describe_case_keys()) << "run scene_test with WAVETANK_WRITE_DOCS=1 to write docs/case.md anew";
}

TEST(CasePage, DefaultsAreThoseOfTheStructs) {
  const std::string page = describe_case_keys();
  EXPECT_NE(page.find("| `duration` | number | s | greater than 0 | required |"), std::string::npos);
  EXPECT_NE(page.find("| `numerics/courant` | number |  | greater than 0 and at most 1.5 | `0.5` |"), std::string::npos);
  EXPECT_NE(page.find("| `fluid/sound_speed` | number or auto | m/s | greater than 0 and at most 1000000; or auto | `auto` |"),
            std::string::npos);
  EXPECT_NE(page.find("| `numerics/density_diffusion` | word |  | none, fourtakas, antuono | `fourtakas` |"), std::string::npos);
  EXPECT_NE(page.find("| `instruments/pressure_probes/N/position` |"), std::string::npos);
}

}  // namespace wavetank::case_page_test

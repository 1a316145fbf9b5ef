#include "../../src/bench/series.h"

#include <gtest/gtest.h>

#include <cmath>

namespace wavetank::bench::series_test {

TEST(Series, HasTheMiddleOne) {
  EXPECT_EQ((Series{{3, 1, 2}}.median()), 2);
  EXPECT_EQ((Series{{4, 1, 2, 3}}.median()), 2.5);
  EXPECT_EQ((Series{{7}}.median()), 7);
}

TEST(Series, SpreadIsOfTheMedian) {
  EXPECT_DOUBLE_EQ((Series{{9, 11, 10}}.spread_percent()), 20);
  EXPECT_DOUBLE_EQ((Series{{-9, -11, -10}}.spread_percent()), 20);
  EXPECT_EQ((Series{{5}}.spread_percent()), 0);
  EXPECT_EQ((Series{{0, 0}}.spread_percent()), 0);
}

TEST(Series, OfNothingIsNoNumber) {
  EXPECT_TRUE(std::isnan(Series{}.median()));
  EXPECT_TRUE(std::isnan(Series{}.spread_percent()));
}

}  // namespace wavetank::bench::series_test

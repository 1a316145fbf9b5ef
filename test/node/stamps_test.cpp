#include "wavetank/node/stamps.h"

#include <gtest/gtest.h>

namespace wavetank::stamps_test {

TEST(StampClock, GivesSimulatedTimeToTheNanosecond) {
  const StampClock clock;
  EXPECT_EQ(clock.at(0.0), ros::Time(0, 0));
  EXPECT_EQ(clock.at(0.001), ros::Time(0, 1000000));
  EXPECT_EQ(clock.at(5.999), ros::Time(5, 999000000));
  EXPECT_EQ(clock.at(0.9999999999), ros::Time(1, 0));
}

TEST(StampClock, GivesEverySampleOfAClockItsOwnStamp) {
  const StampClock clock;
  for (int i = 0; i < 100000; ++i) ASSERT_EQ(clock.at(i / 1000.0), ros::Time(i / 1000, i % 1000 * 1000000)) << i;
}

TEST(StampClock, NeverRunsBackwardsOverARestart) {
  StampClock clock;
  const ros::Time before = clock.at(1.25);
  clock.restart_after(1.25);
  EXPECT_EQ(clock.at(0.0), ros::Time(2, 0));
  EXPECT_GT(clock.at(0.0), before);
  clock.restart_after(0.5);
  EXPECT_EQ(clock.at(0.125), ros::Time(3, 125000000));
}

TEST(StampClock, GoesOnAfterARestartAtAWholeSecond) {
  StampClock clock;
  clock.restart_after(0.0);
  EXPECT_EQ(clock.at(0.0), ros::Time(1, 0)) << "a reset at time 0 still moves on, so that no stamp comes twice";
}

TEST(Nonzero, ReplacesOnlyZero) {
  EXPECT_EQ(nonzero(ros::Time(0, 0)), ros::TIME_MIN);
  EXPECT_EQ(nonzero(ros::Time(0, 5)), ros::Time(0, 5));
}

}  // namespace wavetank::stamps_test

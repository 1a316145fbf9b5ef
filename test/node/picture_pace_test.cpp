#include "wavetank/node/picture_pace.h"

#include <gtest/gtest.h>

namespace wavetank::picture_pace_test {

constexpr double often = 1e9;  // Hz: the rate holds nothing up

TEST(PicturePace, TheFirstPictureIsDueAtOnce) { EXPECT_TRUE(PicturePace(1e-3).is_due(0)); }

TEST(PicturePace, GoesByTheRate) {
  PicturePace seldom(1e-3);
  seldom.begin(0);
  EXPECT_FALSE(seldom.is_due(0));
  PicturePace pace(often);
  pace.begin(0);
  EXPECT_TRUE(pace.is_due(0));
}

TEST(PicturePace, WaitsForWhatPicturesTakeSeveralTimes) {
  PicturePace pace(often);
  pace.begin(30);
  EXPECT_FALSE(pace.is_due(30)) << "3 % of the time: the next is due in a quarter of an hour";
}

TEST(PicturePace, IsNotHeldUpByASingleLongOne) {
  PicturePace pace(often);
  pace.begin(1e-12);
  EXPECT_TRUE(pace.is_due(30)) << "the one before was short";
  pace.begin(30);
  EXPECT_TRUE(pace.is_due(1e-12)) << "the last one was short";
}

}  // namespace wavetank::picture_pace_test

// Where a row of blocks is cut.
#include "wavetank/parallel/slabs.h"

#include <gtest/gtest.h>

#include "../common/error_of.h"

namespace wavetank::parallel::slabs_test {
namespace {

using Cuts = std::vector<int>;

TEST(Slabs, HaveAboutTheSameWeight) {
  EXPECT_EQ(cut_into_slabs({1, 1, 1, 1, 1, 1}, 1), (Cuts{0, 6}));
  EXPECT_EQ(cut_into_slabs({1, 1, 1, 1, 1, 1}, 3), (Cuts{0, 2, 4, 6}));
  EXPECT_EQ(cut_into_slabs({4, 1, 1, 1, 1, 0, 0, 0}, 2), (Cuts{0, 1, 8}));
  EXPECT_EQ(cut_into_slabs({0, 0, 0, 3, 3, 0}, 2), (Cuts{0, 4, 6}));
  const std::vector<std::int64_t> weights{5, 0, 7, 2, 2, 9, 1, 4, 4, 6};
  EXPECT_LT(imbalance(weights, cut_into_slabs(weights, 3)), 1.2);
}

TEST(Slabs, HaveTheBlocksThatTheyMustHave) {
  EXPECT_EQ(cut_into_slabs({100, 1, 1, 1}, 2, 2), (Cuts{0, 2, 4}));
  EXPECT_EQ(cut_into_slabs({1, 0, 0, 0, 0, 100}, 2, 2), (Cuts{0, 4, 6}));
  EXPECT_EQ(cut_into_slabs({9, 0, 0, 0, 1, 0}, 2), (Cuts{0, 1, 6}));
}

TEST(Slabs, MoreThanThereIsRoomForAreRefused) {
  EXPECT_NE(error_of([] { cut_into_slabs({1, 1, 0, 0}, 3); }).find("too short"), std::string::npos);
  EXPECT_NE(error_of([] { cut_into_slabs({1, 1, 1}, 2, 2); }).find("2 parts"), std::string::npos);
}

TEST(Slabs, ImbalanceIsThatOfTheHeaviest) {
  EXPECT_DOUBLE_EQ(imbalance({1, 1, 2}, {0, 2, 3}), 1.0);
  EXPECT_DOUBLE_EQ(imbalance({1, 1, 4}, {0, 2, 3}), 4.0 / 3);
  EXPECT_DOUBLE_EQ(imbalance({0, 0}, {0, 1, 2}), 1.0);
}

}  // namespace
}  // namespace wavetank::parallel::slabs_test

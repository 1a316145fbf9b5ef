#include "wavetank/node/background_work.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <future>
#include <stdexcept>
#include <thread>
#include <vector>

namespace wavetank::background_work_test {

TEST(BackgroundWork, IsDoneInOrder) {
  std::vector<int> done, expected;
  BackgroundWork work;
  for (int k = 0; k < 100; ++k) {
    work.hand_over([&done, k] { done.push_back(k); });
    expected.push_back(k);
  }
  work.finish();
  EXPECT_EQ(done, expected);
}

TEST(BackgroundWork, IsIdleOnceTheLastPieceIsDone) {
  BackgroundWork work;
  EXPECT_TRUE(work.is_idle());
  std::promise<void> may_end;
  bool was_done = false;
  work.hand_over([&] {
    may_end.get_future().wait();
    was_done = true;
  });
  EXPECT_FALSE(work.is_idle());
  may_end.set_value();
  work.wait();
  EXPECT_TRUE(was_done);
  EXPECT_TRUE(work.is_idle());
}

/// A piece waits while the one before it fails: nobody may wait for its turn, which never comes.
TEST(BackgroundWork, ThatFailsKeepsNobodyWaiting) {
  auto all = std::async(std::launch::async, [] {
    std::promise<void> may_fail;
    bool was_done = false;
    int told = 0;
    BackgroundWork work;
    const auto tell = [&](const auto& call) {
      try {
        call();
      } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(), "the disk is full");
        ++told;
      }
    };
    work.hand_over([&] {
      may_fail.get_future().wait();
      throw std::runtime_error("the disk is full");
    });
    work.hand_over([&] { was_done = true; });
    may_fail.set_value();
    for (int k = 0; k < 3; ++k) tell([&] { work.hand_over([&] { was_done = true; }); });
    tell([&] { work.finish(); });
    EXPECT_EQ(told, 1);
    EXPECT_FALSE(was_done);
  });
  if (all.wait_for(std::chrono::seconds(20)) != std::future_status::ready) {
    std::fputs("work that failed is waited for for ever\n", stderr);
    std::abort();  // the destructor of `all` would wait as well
  }
}

TEST(BackgroundWork, TellsOfAFailureWithoutMoreWork) {
  BackgroundWork work;
  work.check();
  work.hand_over([] { throw 1; });  // whatever it is
  bool told = false;
  for (int k = 0; k < 10000 && !told; ++k) {
    try {
      work.check();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    } catch (int) {
      told = true;
    }
  }
  EXPECT_TRUE(told);
  EXPECT_NO_THROW(work.finish());
}

}  // namespace wavetank::background_work_test

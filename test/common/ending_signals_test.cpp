// Ctrl-C, SIGTERM and others are heard by a thread of ours, whoever puts a handler in place of ours meanwhile.
#include "wavetank/common/ending_signals.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <future>

namespace wavetank::ending_signals_test {
namespace {

using namespace std::chrono_literals;

std::atomic<int> foreign_calls{0};

extern "C" void foreign_handler(int) { ++foreign_calls; }

TEST(EndingSignals, AreHeardThoughALibraryInstallsAHandlerAndThreadsRun) {
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGXCPU}) {
    std::promise<int> heard;
    std::promise<void> enough;
    {
      EndingSignals signals([&](int n) { heard.set_value(n); });
      std::thread bystander([&] { enough.get_future().wait(); });
      const auto before = std::signal(number, foreign_handler);
      kill(getpid(), number);
      std::future<int> first = heard.get_future();
      const bool in_time = first.wait_for(10s) == std::future_status::ready;
      EXPECT_TRUE(in_time);
      if (in_time) {
        EXPECT_EQ(first.get(), number);
      }
      std::signal(number, before);
      enough.set_value();
      bystander.join();
    }
    EXPECT_EQ(foreign_calls, 0);
  }
}

TEST(EndingSignals, AreLeftAsTheyWere) {
  sigset_t before, after;
  pthread_sigmask(SIG_SETMASK, nullptr, &before);
  {
    EndingSignals signals([](int) {});
  }
  pthread_sigmask(SIG_SETMASK, nullptr, &after);
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGXCPU}) EXPECT_EQ(sigismember(&after, number), sigismember(&before, number));
  const auto handler = std::signal(SIGINT, foreign_handler);
  std::raise(SIGINT);
  std::signal(SIGINT, handler);
  EXPECT_EQ(foreign_calls, 1);
  foreign_calls = 0;
}

void interrupt_twice() {
  std::promise<void> heard;
  EndingSignals signals([&](int) { heard.set_value(); });
  kill(getpid(), SIGTERM);
  heard.get_future().wait();
  for (const int number : {SIGTERM, SIGHUP, SIGTERM}) {  // change nothing: the end is under way
    kill(getpid(), number);
    std::this_thread::sleep_for(100ms);
  }
  std::fputs("still here", stderr);
  kill(getpid(), SIGINT);
  std::this_thread::sleep_for(10s);
}

TEST(EndingSignalsDeathTest, OfThoseThatFollowCtrlCAloneEndsTheProcessAtOnce) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(interrupt_twice(), testing::KilledBySignal(SIGINT), "still here");
}

TEST(EndingSignals, LeaveAHangupThatIsIgnored) {
  const auto before = std::signal(SIGHUP, SIG_IGN);
  {
    std::atomic<int> heard{0};
    EndingSignals signals([&](int) { ++heard; });
    kill(getpid(), SIGHUP);
    std::this_thread::sleep_for(100ms);
    EXPECT_EQ(heard, 0);
  }
  std::signal(SIGHUP, before);
}

}  // namespace
}  // namespace wavetank::ending_signals_test

// Work that crashes, loops or eats memory ends in a child, and a sentence can be made of it.
#include "wavetank/common/child_process.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <thread>
#include <vector>

#include "wavetank/common/ending_signals.h"
#include "wavetank/common/error.h"

namespace wavetank::child_process_test {
namespace {

using End = ChildResult::End;

constexpr std::uint64_t mebibytes = 1 << 20;

ChildResult in_child(const std::function<std::string()>& work) { return run_in_child(work, {100 * mebibytes, 0.3, 5}); }

TEST(ChildProcess, GivesBackWhatItsWorkReturns) {
  const std::string long_text(3 * mebibytes, 'x');  // much longer than a pipe
  const ChildResult result = in_child([&] { return long_text + '\0' + std::to_string(getpid()); });
  EXPECT_EQ(result.end, End::done);
  EXPECT_EQ(result.bytes.substr(0, long_text.size()), long_text);
  EXPECT_NE(result.bytes.substr(long_text.size() + 1), std::to_string(getpid()));
  EXPECT_EQ(in_child([] { return std::string(); }).end, End::done);
}

TEST(ChildProcess, GivesBackAnErrorsWords) {
  const ChildResult result = in_child([]() -> std::string { throw Error("line 7 is wrong"); });
  EXPECT_EQ(result.end, End::refused);
  EXPECT_EQ(result.bytes, "line 7 is wrong");
}

TEST(ChildProcess, TellsOfCrashesEndlessLoopsAndHunger) {
  EXPECT_EQ(in_child([]() -> std::string {
              std::raise(SIGSEGV);
              return "";
            }).end,
            End::crashed);
  EXPECT_EQ(in_child([]() -> std::string { std::abort(); }).end, End::crashed);
  EXPECT_EQ(in_child([]() -> std::string { _exit(0); }).end, End::crashed) << "without a word";
  EXPECT_EQ(in_child([]() -> std::string {
              for (volatile bool on = true; on;) continue;
              return "";
            }).end,
            End::out_of_time);
  const auto eat = []() -> std::string {
    std::vector<std::string> all;
    while (true) all.emplace_back(mebibytes, 'x');
  };
  EXPECT_EQ(run_in_child(eat, {100 * mebibytes, 10, 60}).end, End::out_of_memory);
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(run_in_child(
                []() -> std::string {
                  sleep(100);
                  return "";
                },
                {100 * mebibytes, 10, 0.2})
                .end,
            End::out_of_time);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
}

TEST(ChildProcess, LeavesNoProcessBehind) {
  in_child([] { return std::string("done"); });
  in_child([]() -> std::string {
    std::raise(SIGSEGV);
    return "";
  });
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
}

TEST(ChildProcess, IsHeardWhereNobodyIsToldOfChildren) {
  const auto before = std::signal(SIGCHLD, SIG_IGN);  // as a process that is started so has it: the system forgets children at once
  const ChildResult sound = in_child([] { return std::string("done"); }), silent = in_child([]() -> std::string { _exit(0); });
  const ChildResult dead = in_child([]() -> std::string { std::abort(); });
  std::signal(SIGCHLD, before);
  EXPECT_EQ(sound.end, End::done);
  EXPECT_EQ(sound.bytes, "done");
  EXPECT_EQ(silent.end, End::crashed);
  EXPECT_EQ(dead.end, End::crashed);
}

TEST(ChildProcess, TellsWhichLimitItMet) {
  const auto sleeper = []() -> std::string {
    sleep(100);
    return "";
  };
  EXPECT_EQ(run_in_child(sleeper, {100 * mebibytes, 10, 0.25}).bytes, "0.25 s");
  const auto loop = []() -> std::string {
    for (volatile bool on = true; on;) continue;
    return "";
  };
  EXPECT_EQ(run_in_child(loop, {100 * mebibytes, 0.2, 60}).bytes, "0.2 s of processor time");
  const ChildResult killed = in_child([]() -> std::string {
    std::raise(SIGKILL);
    return "";
  });
  EXPECT_EQ(killed.end, End::crashed);
  EXPECT_NE(killed.bytes.find("killed from outside"), std::string::npos) << killed.bytes;
}

TEST(ChildProcess, IsLeftWhenThisProcessIsAskedToEnd) {
  const EndingSignals signals([](int) {});
  std::thread asks([] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    kill(getpid(), SIGTERM);
  });
  const auto begin = std::chrono::steady_clock::now();
  const ChildResult result = run_in_child(
      []() -> std::string {
        sleep(100);
        return "";
      },
      {100 * mebibytes, 10, 60});
  asks.join();
  EXPECT_EQ(result.end, End::interrupted);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
}

double processor_seconds() {
  double seconds = 0;
  for (const auto who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage used;
    getrusage(who, &used);
    for (const timeval& part : {used.ru_utime, used.ru_stime})
      seconds += static_cast<double>(part.tv_sec) + 1e-6 * static_cast<double>(part.tv_usec);
  }
  return seconds;
}

TEST(ChildProcess, CostsMilliseconds) {
  constexpr int times = 20;
  const double before = processor_seconds();
  for (int k = 0; k < times; ++k) in_child([] { return std::string("done"); });
  const double each = (processor_seconds() - before) / times;  // of wall time a busy machine takes more
  std::printf("a child takes %.2f ms\n", 1e3 * each);
  EXPECT_LT(each, 0.03);
}

}  // namespace
}  // namespace wavetank::child_process_test

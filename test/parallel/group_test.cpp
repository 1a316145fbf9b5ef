// Threads that talk: messages in their order, reductions, and one that fails.
#include "wavetank/parallel/group.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <string>
#include <thread>

#include "../common/error_of.h"
#include "wavetank/common/error.h"

namespace wavetank::parallel::group_test {
namespace {

TEST(Group, MessagesArriveInTheirOrder) {
  ThreadGroup threads(3);
  threads.run([&](int rank) {
    Group& group = threads.member(rank);
    EXPECT_EQ(group.rank(), rank);
    EXPECT_EQ(group.size(), 3);
    const int next = (rank + 1) % 3, last = (rank + 2) % 3;
    for (char k = 0; k < 20; ++k) group.send(next, {static_cast<char>(rank), k});
    for (char k = 0; k < 20; ++k) EXPECT_EQ(group.receive(last), (Bytes{static_cast<char>(last), k}));
  });
}

TEST(Group, EveryPartHasWhatAllCombined) {
  ThreadGroup threads(4);
  threads.run([&](int rank) {
    Group& group = threads.member(rank);
    for (int round = 0; round < 50; ++round) {
      EXPECT_EQ(group.greatest({double(rank), -double(rank + round)}), (std::vector<double>{3.0, -double(round)}));
      EXPECT_EQ(group.sums({rank, 1}), (std::vector<std::int64_t>{6, 4}));
      EXPECT_EQ(group.least({rank + round}), (std::vector<std::int64_t>{round}));
    }
  });
}

TEST(Group, OneThatFailsStopsThoseThatWait) {
  ThreadGroup threads(3);
  const auto run = [&] {
    threads.run([&](int rank) {
      if (rank == 1) throw Error("the device of part 1 is lost");
      threads.member(rank).receive(1);
    });
  };
  EXPECT_EQ(error_of(run), "the device of part 1 is lost");
  EXPECT_EQ(error_of([&] {
              threads.run([&](int rank) {
                if (rank == 2) throw Error("out of memory");
                threads.member(rank).sums({1});
              });
            }),
            "out of memory");
  // and then they can go on
  threads.run([&](int rank) { EXPECT_EQ(threads.member(rank).sums({1})[0], 3); });
}

TEST(Group, AsATeamObeysOrders) {
  ThreadGroup threads(3);
  EXPECT_EQ(threads.here(), (std::vector<int>{0, 1, 2}));
  const std::vector<Bytes> replies = threads.ask({7}, [&](int rank, const Bytes& order) {
    const auto all = threads.member(rank).sums({rank});
    return Bytes{order[0], static_cast<char>(rank), static_cast<char>(all[0])};
  });
  EXPECT_EQ(replies, (std::vector<Bytes>{{7, 0, 3}, {7, 1, 3}, {7, 2, 3}}));
  EXPECT_EQ(error_of([&] {
              threads.ask({}, [](int rank, const Bytes&) -> Bytes {
                if (rank == 2) throw Error("the device of part 2 is lost");
                return {};
              });
            }),
            "the device of part 2 is lost");
}

TEST(Group, ThatTakesTurnsRunsOneAtATime) {
  ThreadGroup threads(3, true);
  std::atomic<int> running{0}, most{0};
  const auto alone = [&] {
    most = std::max(most.load(), ++running);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    --running;
  };
  threads.run([&](int rank) {
    Group& group = threads.member(rank);
    for (int round = 0; round < 5; ++round) {
      alone();
      group.send((rank + 1) % 3, {static_cast<char>(round)});
      EXPECT_EQ(group.receive((rank + 2) % 3), Bytes{static_cast<char>(round)});
      alone();
      EXPECT_EQ(group.sums({rank}), std::vector<std::int64_t>{3});
    }
  });
  EXPECT_EQ(most, 1);
}

}  // namespace
}  // namespace wavetank::parallel::group_test

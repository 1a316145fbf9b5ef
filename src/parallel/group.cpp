#include "wavetank/parallel/group.h"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <numeric>
#include <thread>

#include "wavetank/common/error.h"

namespace wavetank::parallel {
namespace {

/// What a part that waits for others is told when one has failed.
struct Stopped : Error {
  Stopped() : Error("another part of the water has stopped") {}
};

/// A value of each part, combined in whatever order they come. `result` stays until all have taken it, since the next round needs them all.
template <class T>
struct Round {
  int arrived = 0;
  std::uint64_t number = 0;
  std::vector<T> combined, result;
};

}  // namespace

struct ThreadGroup::Shared {
  Shared(int members, bool in_turns)
      : size(members), takes_turns(in_turns), ends_of_turns(members), boxes(static_cast<std::size_t>(members) * members) {}

  void end_turn(int rank) const {
    if (takes_turns && ends_of_turns[rank]) ends_of_turns[rank]();
  }

  /// Waits, with the lock held, for something that another part does.
  template <class Condition>
  void wait(std::unique_lock<std::mutex>& lock, const Condition& condition) {
    if (takes_turns) turn.unlock();
    changed.wait(lock, [&] { return failed || condition(); });
    if (takes_turns) {  // whoever has the turn may want the lock
      lock.unlock();
      turn.lock();
      lock.lock();
    }
    if (!condition()) throw Stopped();
  }

  template <class T, class Combine>
  std::vector<T> combine(Round<T>& round, const std::vector<T>& values, const Combine& combine) {
    std::unique_lock<std::mutex> lock(mutex);
    if (failed) throw Stopped();
    if (round.arrived == 0) {
      round.combined = values;
    } else {
      if (round.combined.size() != values.size()) throw Error("parts of the water combine different numbers of values");
      std::transform(values.begin(), values.end(), round.combined.begin(), round.combined.begin(), combine);
    }
    const std::uint64_t number = round.number;
    if (++round.arrived == size) {
      round.arrived = 0;
      round.result = round.combined;
      ++round.number;
      changed.notify_all();
    }
    wait(lock, [&] { return round.number != number; });
    return round.result;
  }

  void clear() {
    failed = nullptr;
    for (std::deque<Bytes>& box : boxes) box.clear();
    reals.arrived = integers.arrived = 0;
  }

  int size;
  bool takes_turns;
  std::vector<std::function<void()>> ends_of_turns;
  std::mutex turn;  ///< of the part that runs, if they take turns
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<std::deque<Bytes>> boxes;  ///< by receiver, then sender
  Round<double> reals;
  Round<std::int64_t> integers;
  std::exception_ptr failed;  ///< the first failure
};

class ThreadGroup::Member final : public Group {
 public:
  Member(Shared& shared, int rank) : shared_(shared), rank_(rank) {}

  int size() const override { return shared_.size; }
  int rank() const override { return rank_; }
  void send(int to, Bytes bytes) override {
    const std::lock_guard<std::mutex> lock(shared_.mutex);
    shared_.boxes.at(to * shared_.size + rank_).push_back(std::move(bytes));
    shared_.changed.notify_all();
  }
  Bytes receive(int from) override {
    shared_.end_turn(rank_);
    std::unique_lock<std::mutex> lock(shared_.mutex);
    std::deque<Bytes>& box = shared_.boxes.at(rank_ * shared_.size + from);
    shared_.wait(lock, [&] { return !box.empty(); });
    Bytes bytes = std::move(box.front());
    box.pop_front();
    return bytes;
  }
  std::vector<double> greatest(const std::vector<double>& values) override {
    shared_.end_turn(rank_);
    return shared_.combine(shared_.reals, values, [](double a, double b) { return std::max(a, b); });
  }
  std::vector<std::int64_t> sums(const std::vector<std::int64_t>& values) override {
    shared_.end_turn(rank_);
    return shared_.combine(shared_.integers, values, [](std::int64_t a, std::int64_t b) { return a + b; });
  }
  std::vector<std::int64_t> least(const std::vector<std::int64_t>& values) override {
    shared_.end_turn(rank_);
    return shared_.combine(shared_.integers, values, [](std::int64_t a, std::int64_t b) { return std::min(a, b); });
  }

 private:
  Shared& shared_;
  int rank_;
};

ThreadGroup::ThreadGroup(int size, bool takes_turns) : shared_(std::make_unique<Shared>(size, takes_turns)) {
  for (int rank = 0; rank < size; ++rank) members_.push_back(std::make_unique<Member>(*shared_, rank));
}

ThreadGroup::~ThreadGroup() = default;

void ThreadGroup::at_end_of_turn(int rank, std::function<void()> what) { shared_->ends_of_turns.at(rank) = std::move(what); }

int ThreadGroup::size() const { return shared_->size; }

std::vector<int> ThreadGroup::here() const {
  std::vector<int> all(members_.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

Group& ThreadGroup::member(int rank) { return *members_.at(rank); }

std::string ThreadGroup::name_of(int rank) const { return "part " + std::to_string(rank) + " of " + std::to_string(size()); }

std::vector<Bytes> ThreadGroup::ask(const Bytes& order, const Work& work) {
  std::vector<Bytes> replies(members_.size());
  run([&](int rank) { replies[rank] = work(rank, order); });
  return replies;
}

void ThreadGroup::run(const std::function<void(int)>& work) {
  const auto guarded = [&](int rank) {
    std::unique_lock<std::mutex> turn(shared_->turn, std::defer_lock);
    if (shared_->takes_turns) turn.lock();
    try {
      work(rank);
      shared_->end_turn(rank);
    } catch (...) {
      {
        const std::lock_guard<std::mutex> lock(shared_->mutex);
        if (!shared_->failed) shared_->failed = std::current_exception();
        shared_->changed.notify_all();
      }
      try {
        shared_->end_turn(rank);
      } catch (...) {  // the first failure is told
      }
    }
  };
  std::vector<std::thread> threads;
  for (int rank = 1; rank < size(); ++rank) threads.emplace_back(guarded, rank);
  guarded(0);
  for (std::thread& thread : threads) thread.join();
  const std::exception_ptr failed = shared_->failed;
  if (!failed) return;
  shared_->clear();
  std::rethrow_exception(failed);
}

}  // namespace wavetank::parallel

#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

/// Several parts of one computation that talk to each other. Nothing here knows what a particle is.
namespace wavetank::parallel {

using Bytes = std::vector<char>;

/// What one of the parts sees of all. Its reductions have no order, so that no bit depends on how many parts there are: there is none of
/// floating-point sums. Every part must call them in the same order. All of it throws Error once another part has failed.
class Group {
 public:
  virtual ~Group() = default;

  virtual int size() const = 0;
  virtual int rank() const = 0;  ///< from 0
  /// Returns at once. Of two messages from one part to another the first arrives first.
  virtual void send(int to, Bytes bytes) = 0;
  /// Waits for the next message from there.
  virtual Bytes receive(int from) = 0;
  /// The greatest of each value over all parts; all give as many. None may be NaN.
  virtual std::vector<double> greatest(const std::vector<double>& values) = 0;
  /// The sum and the least of each, likewise.
  virtual std::vector<std::int64_t> sums(const std::vector<std::int64_t>& values) = 0;
  virtual std::vector<std::int64_t> least(const std::vector<std::int64_t>& values) = 0;
};

/// Parts that are threads of this process.
class ThreadGroup {
 public:
  /// `takes_turns`: only one of them runs at a time, until it waits for others, as devices need whose drivers know of one thread alone.
  explicit ThreadGroup(int size, bool takes_turns = false);
  ~ThreadGroup();
  ThreadGroup(const ThreadGroup&) = delete;
  ThreadGroup& operator=(const ThreadGroup&) = delete;

  int size() const;
  Group& member(int rank);
  /// Does `work` for every rank at once, each in a thread of its own, and returns when all are done. Throws what the first part that
  /// failed has thrown; the others are then stopped where they wait for a part, and messages under way are forgotten.
  void run(const std::function<void(int rank)>& work);

 private:
  struct Shared;
  class Member;
  std::unique_ptr<Shared> shared_;
  std::vector<std::unique_ptr<Member>> members_;
};

}  // namespace wavetank::parallel

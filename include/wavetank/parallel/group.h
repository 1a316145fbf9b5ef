#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
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

/// All parts, as the process sees them that has the first: they do what it says.
class Team {
 public:
  /// What a part does with an order; what it returns is its reply.
  using Work = std::function<Bytes(int rank, const Bytes& order)>;

  virtual ~Team() = default;
  virtual int size() const = 0;
  /// Ranks of the parts that are in this process.
  virtual std::vector<int> here() const = 0;
  /// As one of those sees all.
  virtual Group& member(int rank) = 0;
  /// For messages: "part 1 of 3", and where that is.
  virtual std::string name_of(int rank) const = 0;
  /// Has every part obey an order at once, and waits for their replies, by rank; `work` is for the parts that are here, and is called for
  /// each in a thread of its own. Throws what the first part that failed has thrown, or told of it as Error; the others are then stopped
  /// where they wait for a part.
  virtual std::vector<Bytes> ask(const Bytes& order, const Work& work) = 0;
};

/// Parts that are threads of this process.
class ThreadGroup final : public Team {
 public:
  /// `takes_turns`: only one of them runs at a time, until it waits for others, as devices need whose drivers know of one thread alone.
  explicit ThreadGroup(int size, bool takes_turns = false);
  /// What a part does first when it gives up its turn: of a device, finishing what is queued.
  void at_end_of_turn(int rank, std::function<void()> what);
  ~ThreadGroup() override;
  ThreadGroup(const ThreadGroup&) = delete;
  ThreadGroup& operator=(const ThreadGroup&) = delete;

  int size() const override;
  std::vector<int> here() const override;
  Group& member(int rank) override;
  std::string name_of(int rank) const override;
  std::vector<Bytes> ask(const Bytes& order, const Work& work) override;
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

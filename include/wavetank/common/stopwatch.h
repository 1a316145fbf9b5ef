#pragma once

#include <chrono>
#include <cstdint>

namespace wavetank {

/// Adds up the wall time of something that is done again and again.
class Stopwatch {
 public:
  /// Counts until it goes out of scope.
  class Lap {
   public:
    explicit Lap(Stopwatch& watch) : watch_(watch), begin_(Clock::now()) {}
    ~Lap() { watch_.seconds_ += std::chrono::duration<double>(Clock::now() - begin_).count(); }
    Lap(const Lap&) = delete;
    Lap& operator=(const Lap&) = delete;

   private:
    Stopwatch& watch_;
    std::chrono::steady_clock::time_point begin_;
  };

  /// One more of what is counted.
  void tick() { ++count_; }
  std::uint64_t count() const { return count_; }
  double seconds() const { return seconds_; }

 private:
  using Clock = std::chrono::steady_clock;
  std::uint64_t count_ = 0;
  double seconds_ = 0;
};

}  // namespace wavetank

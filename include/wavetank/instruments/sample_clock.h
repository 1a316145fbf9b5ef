#pragma once

#include <cstdint>

namespace wavetank {

/// Ticks at k / rate, k = 0, 1, 2, …: computed from k each time, so that ticks never drift.
class SampleClock {
 public:
  explicit SampleClock(double rate) : rate_(rate) {}

  double next() const { return static_cast<double>(index_) / rate_; }  ///< s
  void tick() { ++index_; }
  double rate() const { return rate_; }  ///< Hz
  std::uint64_t index() const { return index_; }
  void set_index(std::uint64_t index) { index_ = index; }

 private:
  double rate_;  ///< Hz of simulated time
  std::uint64_t index_ = 0;
};

}  // namespace wavetank

#pragma once

#include <chrono>
#include <string>

#include "wavetank/common/log.h"

namespace wavetank {

/// Tells of work that takes long, through the log: nothing in its first five seconds, then a line every five.
class SlowWork {
 public:
  /// `what`: "laying out the walls of body 'hull'".
  explicit SlowWork(std::string what) : what_(std::move(what)) {}

  /// `done` of `all` there is to do.
  void tell(std::size_t done, std::size_t all) {
    if (++calls_ % 256 != 0) return;  // the clock costs more than a piece of work may
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < std::chrono::seconds(5)) return;
    last_ = now;
    log(LogLevel::info, what_ + ": " + std::to_string(100 * done / all) + " % done");
  }

 private:
  std::string what_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
  unsigned calls_ = 0;
};

}  // namespace wavetank

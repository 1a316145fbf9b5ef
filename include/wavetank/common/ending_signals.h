#pragma once

#include <atomic>
#include <csignal>
#include <functional>
#include <thread>

#include "wavetank/common/error.h"

namespace wavetank {

/// Ctrl-C (SIGINT), SIGTERM, SIGHUP (a terminal that was closed) and SIGXCPU (ulimit -t) as a request to end, without a signal handler. A
/// handler would not last: compilers behind OpenCL install their own while they work, delete the files that they are writing and so fail
/// in the middle of a start that should end cleanly. Instead the signals are blocked and awaited by a thread. The first is reported; of
/// those that follow a Ctrl-C ends the process at once, and the others change nothing, since what they ask for is under way. A SIGHUP that
/// the process was started to ignore, as by nohup, stays ignored.
class EndingSignals {
 public:
  /// Blocks the signals in the calling thread and in those, and in the processes, that it starts from now on: to be made before any
  /// other thread. `on_first` is called with the first signal's number, on a thread of its own.
  explicit EndingSignals(std::function<void(int)> on_first);

  /// The calling thread, which must be the one that made this, hears signals as before.
  ~EndingSignals();

  /// Whether one that lives has heard the first of its signals.
  static bool heard();

  EndingSignals(const EndingSignals&) = delete;
  EndingSignals& operator=(const EndingSignals&) = delete;

 private:
  void wait();

  std::function<void(int)> on_first_;
  std::atomic<bool> is_over_{false};
  sigset_t before_{};
  sigset_t awaited_{};
  std::thread thread_;
};

/// What was under way was left, as an EndingSignals has heard its first signal.
struct EndRequested : Error {
  using Error::Error;
};

}  // namespace wavetank

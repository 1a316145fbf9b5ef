#pragma once

#include <csignal>

namespace wavetank {

/// Holds Ctrl-C (SIGINT) back from the calling thread, and from threads and processes that it starts, while the library works: compilers
/// behind OpenCL install handlers of their own for a while, delete the files that they are writing when a signal comes, and so fail in the
/// middle of a start that should end cleanly.
class HeldSignals {
 public:
  HeldSignals() {
    sigset_t held;
    sigemptyset(&held);
    sigaddset(&held, SIGINT);
    pthread_sigmask(SIG_BLOCK, &held, &before_);
  }
  ~HeldSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  HeldSignals(const HeldSignals&) = delete;
  HeldSignals& operator=(const HeldSignals&) = delete;

  /// Lets the handler of a signal that is held back run now.
  void let_through() const {
    sigset_t held;
    pthread_sigmask(SIG_SETMASK, &before_, &held);
    pthread_sigmask(SIG_SETMASK, &held, nullptr);
  }

 private:
  sigset_t before_{};
};

}  // namespace wavetank

#include "wavetank/common/ending_signals.h"

#include <pthread.h>

#include <utility>

namespace wavetank {
namespace {

std::atomic<bool> was_heard{false};

}  // namespace

EndingSignals::EndingSignals(std::function<void(int)> on_first) : on_first_(std::move(on_first)) {
  sigemptyset(&awaited_);
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGXCPU}) {
    struct sigaction before;
    const bool stays_ignored = number == SIGHUP && sigaction(number, nullptr, &before) == 0 && before.sa_handler == SIG_IGN;
    if (!stays_ignored) sigaddset(&awaited_, number);
  }
  pthread_sigmask(SIG_BLOCK, &awaited_, &before_);
  thread_ = std::thread([this] { wait(); });
}

EndingSignals::~EndingSignals() {
  is_over_ = true;
  pthread_kill(thread_.native_handle(), SIGTERM);  // to that thread alone: it wakes up and finds that it is over
  thread_.join();
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  was_heard = false;
}

bool EndingSignals::heard() { return was_heard; }

void EndingSignals::wait() {
  bool is_first = true;
  while (true) {
    int number = 0;
    if (sigwait(&awaited_, &number) != 0) continue;
    if (is_over_) return;
    was_heard = true;
    if (is_first) on_first_(number);
    if (!is_first && number == SIGINT) {
      std::signal(number, SIG_DFL);
      pthread_sigmask(SIG_UNBLOCK, &awaited_, nullptr);
      std::raise(number);
    }
    is_first = false;
  }
}

}  // namespace wavetank

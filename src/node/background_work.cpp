#include "wavetank/node/background_work.h"

#include <utility>

namespace wavetank {

BackgroundWork::BackgroundWork() {
  thread_ = std::thread([this] { run(); });
}

BackgroundWork::~BackgroundWork() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    waiting_ = nullptr;
    is_over_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void BackgroundWork::check() {
  const std::lock_guard<std::mutex> lock(mutex_);
  throw_problem();
}

void BackgroundWork::hand_over(std::function<void()> piece) {
  {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return !waiting_ || has_ended_; });
    throw_problem();
    if (has_ended_) return;
    waiting_ = std::move(piece);
  }
  changed_.notify_all();
}

bool BackgroundWork::is_idle() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return !waiting_ && !is_working_;
}

void BackgroundWork::wait() {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return !waiting_ && !is_working_; });
}

void BackgroundWork::finish() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_over_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
  check();
}

void BackgroundWork::throw_problem() {
  if (problem_) std::rethrow_exception(std::exchange(problem_, nullptr));
}

void BackgroundWork::run() {
  std::exception_ptr problem;
  while (!problem) {
    std::function<void()> piece;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      changed_.wait(lock, [this] { return waiting_ || is_over_; });
      if (!waiting_) break;
      piece = std::exchange(waiting_, nullptr);
      is_working_ = true;
    }
    changed_.notify_all();
    try {
      piece();
    } catch (...) {
      problem = std::current_exception();
    }
    piece = nullptr;  // and what it holds, before anyone is told that it is done
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      is_working_ = false;
      if (problem) waiting_ = nullptr;
    }
    changed_.notify_all();
  }
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    waiting_ = nullptr;
    problem_ = problem;
    has_ended_ = true;
  }
  changed_.notify_all();
}

}  // namespace wavetank

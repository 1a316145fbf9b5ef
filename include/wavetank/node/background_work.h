#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace wavetank {

/// Does one piece of work after another in a thread of its own. What one of them throws ends that: those behind it are left out, and
/// whoever calls next is told, once; who goes on after that does so without. All members are to be called by one thread.
class BackgroundWork {
 public:
  BackgroundWork();
  /// After the piece in progress; one that waits is left out.
  ~BackgroundWork();
  BackgroundWork(const BackgroundWork&) = delete;
  BackgroundWork& operator=(const BackgroundWork&) = delete;

  /// Throws what a piece has thrown.
  void check();
  /// Returns once no other piece waits to be begun. Throws as check().
  void hand_over(std::function<void()> piece);
  /// Whether nothing is in progress and nothing waits.
  bool is_idle();
  /// Until it is idle.
  void wait();
  /// Waits until all is done; the last call but check(). Throws as check().
  void finish();

 private:
  void run();
  void throw_problem();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::function<void()> waiting_;
  bool is_working_ = false;
  bool is_over_ = false;    ///< nothing more will be handed over
  bool has_ended_ = false;  ///< the thread takes nothing more
  std::exception_ptr problem_;
  std::thread thread_;
};

}  // namespace wavetank

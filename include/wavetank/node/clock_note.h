#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace wavetank {

/// Keeps a ROS parameter at the newest of the values it is given. A thread of its own asks the master, so that a master that has died, or
/// does not answer, holds nobody up; a value that it does not take is forgotten.
class ClockNote {
 public:
  /// Full name of the parameter.
  explicit ClockNote(std::string parameter);
  ~ClockNote();
  ClockNote(const ClockNote&) = delete;
  ClockNote& operator=(const ClockNote&) = delete;

  /// s; returns at once.
  void write(double reached);

 private:
  void run();

  std::string parameter_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::optional<double> newest_;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace wavetank

#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "opencl_call.h"
#include "wavetank/compute/device.h"

namespace wavetank::compute {

/// The OpenCL handle behind an entry of list_devices(); throws Error if that entry is there no more. Of a piece it is to be released.
cl_device_id find_device(const DeviceInfo& info);

struct Device::State {
  State(const DeviceInfo& device_info, bool time_kernels);
  ~State();
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  void finish() const;
  /// Writes in the queue's order, and returns when `from` may change.
  void write(cl_mem to, const void* from, std::size_t bytes, std::size_t offset);
  /// Waits for all that was queued before, too.
  void read(cl_mem from, void* to, std::size_t bytes, std::size_t offset);
  /// Takes over the event of one launch, to be counted once it has run.
  void add_launch(const std::string& kernel, cl_event event);
  /// Counts the launches that have run; with `wait`, all of them.
  void harvest(bool wait);

  DeviceInfo info;
  std::string platform_version;
  cl_device_id id = nullptr;
  cl_context context = nullptr;
  cl_command_queue queue = nullptr;
  bool timing = false;  ///< false also when the driver has no profiling queue
  std::atomic<std::size_t> allocated{0};

  std::mutex programs_mutex;
  std::map<std::array<std::uint64_t, 2>, cl_program>
      programs;  ///< all that were built, by source and options: solvers of a kind share them

  struct Launch {
    std::string kernel;
    cl_event event;
  };
  std::mutex timing_mutex;  ///< guards the two below: timings() may be asked for from another thread than the one that launches
  std::deque<Launch> pending;
  std::map<std::string, KernelTiming> timings;

 private:
  void count_front();
  void forget_staged();

  std::deque<std::vector<char>> staged_;  ///< copies of what small writes have queued
  std::size_t staged_bytes_ = 0;
};

}  // namespace wavetank::compute

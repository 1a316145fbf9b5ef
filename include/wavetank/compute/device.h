#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

/// OpenCL 1.2 behind small owning classes. A failed call throws Error with the call, the device and OpenCL's name of the code; a lost
/// device is said as such. Nothing here knows what a particle is.
namespace wavetank::compute {

struct DeviceInfo {
  int platform = 0;  ///< index in this list's platforms
  int device = 0;    ///< index in its platform
  int pieces = 1;    ///< into which the device is divided, of as many units each
  int piece = 0;     ///< the one that this is
  std::string platform_name;
  std::string name;
  std::string driver;   ///< driver version
  std::string version;  ///< OpenCL version string
  bool is_gpu = false;
  bool has_double = false;
  unsigned compute_units = 0;
  unsigned vector_width = 1;       ///< single-precision numbers that fit into a vector register
  std::size_t global_memory = 0;   ///< bytes
  std::size_t max_allocation = 0;  ///< bytes
  std::size_t max_work_group = 0;
  std::string indices() const;   ///< "0:0", as choose_device takes them; of a piece "0:0/2"
  std::string describe() const;  ///< one line: "0:0 NAME (PLATFORM, driver D, 2 units, 23.4 GiB)"
};

/// Every OpenCL device of the machine, in the loader's order; empty when there is none (no throw).
std::vector<DeviceInfo> list_devices();

/// `auto` = the first GPU, else the first CPU; `cpu`, `gpu`; "P:D" by indices; anything else = a part of the device's name,
/// case-insensitive, which must match exactly one. Throws Error that lists what is there.
DeviceInfo choose_device(const std::string& selector);

/// One or several, for the parts of one case: selectors as choose_device takes them with commas between them, each of which may end in /N,
/// for N pieces of that device with as many units each; the same may be named again. `all`: every device of the machine. Throws Error as
/// choose_device does, and for a device that cannot be divided so.
std::vector<DeviceInfo> choose_devices(const std::string& selectors);

struct KernelTiming {
  std::string kernel;
  std::uint64_t launches = 0;
  double seconds = 0;
};

class Program;

/// A context with one in-order queue. Copies share it.
class Device {
 public:
  /// time_kernels: the queue profiles each launch and timings() reports it (costs a little a launch).
  explicit Device(const DeviceInfo& info, bool time_kernels = false);

  const DeviceInfo& info() const;
  void finish() const;                        ///< waits for everything queued
  std::vector<KernelTiming> timings() const;  ///< by kernel name, the dearest first; waits
  void reset_timings();
  std::size_t allocated() const;  ///< bytes in live buffers
  struct State;
  const std::shared_ptr<State>& state() const { return state_; }

 private:
  std::shared_ptr<State> state_;
};

}  // namespace wavetank::compute

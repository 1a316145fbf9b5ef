#include "wavetank/compute/device.h"

#include <algorithm>

#include "device_state.h"
#include "wavetank/common/error.h"

namespace wavetank::compute {
namespace {

/// Launches whose events may wait before those that have run are counted and freed.
constexpr std::size_t pending_launches = 1000;

/// Bytes of queued writes that are copied: what is more waits for the queue instead.
constexpr std::size_t staging_size = std::size_t(1) << 20;

std::string platform_version_of(cl_device_id id) {
  cl_platform_id platform = nullptr;
  char text[256] = "";
  if (clGetDeviceInfo(id, CL_DEVICE_PLATFORM, sizeof platform, &platform, nullptr) != CL_SUCCESS) return "";
  if (clGetPlatformInfo(platform, CL_PLATFORM_VERSION, sizeof text, text, nullptr) != CL_SUCCESS) return "";
  return text;
}

}  // namespace

Device::State::State(const DeviceInfo& device_info, bool time_kernels) : info(device_info), id(find_device(device_info)) {
  platform_version = platform_version_of(id);
  cl_int code = CL_SUCCESS;
  context = clCreateContext(nullptr, 1, &id, nullptr, nullptr, &code);
  check(code, "clCreateContext", info, "making a context");
  if (time_kernels) queue = clCreateCommandQueue(context, id, CL_QUEUE_PROFILING_ENABLE, &code);
  timing = queue != nullptr;
  if (queue == nullptr) queue = clCreateCommandQueue(context, id, 0, &code);
  if (queue == nullptr) clReleaseContext(context);
  check(code, "clCreateCommandQueue", info, "making a queue");
}

Device::State::~State() {
  clFinish(queue);
  for (const Launch& launch : pending) clReleaseEvent(launch.event);
  for (const auto& program : programs) clReleaseProgram(program.second);
  clReleaseCommandQueue(queue);
  clReleaseContext(context);
  if (info.pieces > 1) clReleaseDevice(id);
}

void Device::State::finish() const { check(clFinish(queue), "clFinish", info, "finishing what was queued"); }

/// A small write does not wait: it would keep the device idle until the host hears of it and has queued the next kernel.
void Device::State::write(cl_mem to, const void* from, std::size_t bytes, std::size_t offset) {
  const bool waits = bytes > staging_size - std::min(staging_size, staged_bytes_);
  if (!waits) {
    const char* begin = static_cast<const char*>(from);
    from = staged_.emplace_back(begin, begin + bytes).data();
    staged_bytes_ += bytes;
  }
  check(clEnqueueWriteBuffer(queue, to, waits ? CL_TRUE : CL_FALSE, offset, bytes, from, 0, nullptr, nullptr), "clEnqueueWriteBuffer", info,
        [&] { return "writing " + size_text(bytes) + " to a buffer"; });
  if (waits) forget_staged();
}

void Device::State::read(cl_mem from, void* to, std::size_t bytes, std::size_t offset) {
  check(clEnqueueReadBuffer(queue, from, CL_TRUE, offset, bytes, to, 0, nullptr, nullptr), "clEnqueueReadBuffer", info,
        [&] { return "finishing what was queued and reading " + size_text(bytes) + " from a buffer"; });
  forget_staged();
}

/// The queue is in order: what was written before has been written.
void Device::State::forget_staged() {
  staged_.clear();
  staged_bytes_ = 0;
}

void Device::State::add_launch(const std::string& kernel, cl_event event) {
  bool full = false;
  {
    std::lock_guard<std::mutex> lock(timing_mutex);
    pending.push_back({kernel, event});
    full = pending.size() > pending_launches;
  }
  if (full) harvest(false);
}

void Device::State::harvest(bool wait) {
  if (wait) finish();
  std::lock_guard<std::mutex> lock(timing_mutex);
  while (!pending.empty()) {
    cl_int status = CL_COMPLETE;
    clGetEventInfo(pending.front().event, CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof status, &status, nullptr);
    if (status > CL_COMPLETE) return;  // still queued or running, and so is all behind it
    count_front();
  }
}

void Device::State::count_front() {
  const Launch launch = pending.front();
  pending.pop_front();
  KernelTiming& timing_of_kernel = timings[launch.kernel];
  timing_of_kernel.kernel = launch.kernel;
  ++timing_of_kernel.launches;
  cl_ulong start = 0, end = 0;  // nanoseconds
  if (clGetEventProfilingInfo(launch.event, CL_PROFILING_COMMAND_START, sizeof start, &start, nullptr) == CL_SUCCESS &&
      clGetEventProfilingInfo(launch.event, CL_PROFILING_COMMAND_END, sizeof end, &end, nullptr) == CL_SUCCESS && end > start)
    timing_of_kernel.seconds += 1e-9 * double(end - start);
  clReleaseEvent(launch.event);
}

Device::Device(const DeviceInfo& info, bool time_kernels) : state_(std::make_shared<State>(info, time_kernels)) {}

const DeviceInfo& Device::info() const { return state_->info; }

void Device::finish() const { state_->finish(); }

std::vector<KernelTiming> Device::timings() const {
  state_->harvest(true);
  std::lock_guard<std::mutex> lock(state_->timing_mutex);
  std::vector<KernelTiming> list;
  for (const auto& entry : state_->timings) list.push_back(entry.second);
  std::stable_sort(list.begin(), list.end(), [](const KernelTiming& a, const KernelTiming& b) { return a.seconds > b.seconds; });
  return list;
}

void Device::reset_timings() {
  state_->harvest(true);
  std::lock_guard<std::mutex> lock(state_->timing_mutex);
  state_->timings.clear();
}

std::size_t Device::allocated() const { return state_->allocated; }

}  // namespace wavetank::compute

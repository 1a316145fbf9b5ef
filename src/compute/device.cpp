#include "wavetank/compute/device.h"

#include <algorithm>

#include "device_state.h"
#include "wavetank/common/error.h"

namespace wavetank::compute {
namespace {

/// Launches whose events may wait before those that have run are counted and freed.
constexpr std::size_t pending_launches = 1000;

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
  clReleaseCommandQueue(queue);
  clReleaseContext(context);
}

void Device::State::finish() const { check(clFinish(queue), "clFinish", info, "finishing what was queued"); }

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

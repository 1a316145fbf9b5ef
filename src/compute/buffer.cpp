#include "wavetank/compute/buffer.h"

#include <algorithm>

#include "device_state.h"
#include "wavetank/common/error.h"

namespace wavetank::compute {
namespace {

/// Zeros are written in units of this many bytes, the widest that every OpenCL 1.2 device fills; buffers are whole units long.
constexpr std::size_t fill_unit = 16;

}  // namespace

struct Memory::State {
  State(std::shared_ptr<Device::State> on, std::size_t bytes);
  ~State();
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  void fill_zero();

  std::shared_ptr<Device::State> device;
  cl_mem handle = nullptr;
  std::size_t bytes = 0;  ///< on the device: whole fill units, at least one
};

Memory::State::State(std::shared_ptr<Device::State> on, std::size_t asked) : device(std::move(on)) {
  const DeviceInfo& info = device->info;
  if (asked > info.max_allocation)
    throw Error("a buffer of " + size_text(asked) + " was asked of the device " + info.name + ", which allows at most " +
                size_text(info.max_allocation) + " in one buffer and has " + size_text(info.global_memory) + " in all");
  bytes = std::max<std::size_t>(1, (asked + fill_unit - 1) / fill_unit) * fill_unit;
  cl_int code = CL_SUCCESS;
  handle = clCreateBuffer(device->context, CL_MEM_READ_WRITE, bytes, nullptr, &code);
  check(code, "clCreateBuffer", info, [&] {
    return "allocating " + size_text(bytes) + " beside " + size_text(device->allocated) + " in use, of " + size_text(info.global_memory);
  });
  try {
    fill_zero();  // drivers that allocate late find out here that there is no room
  } catch (const Error&) {
    clReleaseMemObject(handle);
    throw;
  }
  device->allocated += bytes;
}

Memory::State::~State() {
  clReleaseMemObject(handle);
  device->allocated -= bytes;
}

void Memory::State::fill_zero() {
  const cl_uint zeros[fill_unit / sizeof(cl_uint)] = {};
  check(clEnqueueFillBuffer(device->queue, handle, zeros, fill_unit, 0, bytes, 0, nullptr, nullptr), "clEnqueueFillBuffer", device->info,
        [&] { return "zeroing a buffer of " + size_text(bytes); });
}

Memory::Memory(const Device& device, std::size_t bytes) : state_(std::make_shared<State>(device.state(), bytes)), bytes_(bytes) {}

namespace {

void check_range(std::size_t bytes, std::size_t offset, std::size_t available, const char* what) {
  if (offset > available || bytes > available - offset)
    throw Error("a buffer of " + std::to_string(available) + " bytes cannot be " + what + " for " + std::to_string(bytes) +
                " bytes from byte " + std::to_string(offset));
}

}  // namespace

void Memory::write(const void* from, std::size_t bytes, std::size_t offset) {
  check_range(bytes, offset, bytes_, "written");
  if (bytes == 0) return;
  state_->device->write(state_->handle, from, bytes, offset);
}

void Memory::read(void* to, std::size_t bytes, std::size_t offset) const {
  check_range(bytes, offset, bytes_, "read");
  if (bytes == 0) return;
  state_->device->read(state_->handle, to, bytes, offset);
}

void Memory::fill_zero() {
  if (state_) state_->fill_zero();
}

void Memory::copy_from(const Memory& other, std::size_t bytes) {
  check_range(bytes, 0, bytes_, "written");
  check_range(bytes, 0, other.bytes_, "read");
  if (bytes == 0 || state_ == other.state_) return;
  const Device::State& device = *state_->device;
  check(clEnqueueCopyBuffer(device.queue, other.state_->handle, state_->handle, 0, 0, bytes, 0, nullptr, nullptr), "clEnqueueCopyBuffer",
        device.info, [&] { return "copying " + size_text(bytes) + " between buffers"; });
}

void* Memory::handle() const { return state_ ? state_->handle : nullptr; }

}  // namespace wavetank::compute

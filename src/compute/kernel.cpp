#include <algorithm>

#include "program_state.h"
#include "signature.h"
#include "wavetank/common/error.h"

namespace wavetank::compute {
namespace {

/// Work-group sizes of launch(). They are the same for every launch of a kernel, since a CPU driver compiles a kernel anew for each size.
constexpr std::size_t cpu_group_size = 64;
constexpr std::size_t gpu_group_size = 128;

std::string argument_text(unsigned count) { return std::to_string(count) + (count == 1 ? " argument" : " arguments"); }

std::string kernel_names(cl_program program) {
  std::size_t size = 0;
  if (clGetProgramInfo(program, CL_PROGRAM_KERNEL_NAMES, 0, nullptr, &size) != CL_SUCCESS || size == 0) return "";
  std::string names(size, '\0');
  if (clGetProgramInfo(program, CL_PROGRAM_KERNEL_NAMES, size, &names[0], nullptr) != CL_SUCCESS) return "";
  std::string listed;
  for (const char* c = names.c_str(); *c != '\0'; ++c) listed += *c == ';' ? std::string(", ") : std::string(1, *c);
  return listed;
}

}  // namespace

Kernel::State::State(std::shared_ptr<Program::State> of, const std::string& kernel_name) : program(std::move(of)), name(kernel_name) {}

void Kernel::State::prepare() {
  if (handle != nullptr) return;
  const cl_program built = program->built();
  cl_int code = CL_SUCCESS;
  handle = clCreateKernel(built, name.c_str(), &code);
  if (code != CL_SUCCESS) {
    const std::string names = kernel_names(built);
    if ((", " + names + ",").find(", " + name + ",") == std::string::npos)
      throw Error(program->main + " has no kernel \"" + name + "\"; it has: " + (names.empty() ? "none" : names));
  }
  check(code, "clCreateKernel", info(), [&] { return "making the kernel " + name; });
  clGetKernelInfo(handle, CL_KERNEL_NUM_ARGS, sizeof argument_count, &argument_count, nullptr);
  const cl_device_id device = program->device->id;
  std::size_t required[3] = {0, 0, 0};
  clGetKernelWorkGroupInfo(handle, device, CL_KERNEL_COMPILE_WORK_GROUP_SIZE, sizeof required, required, nullptr);
  if (clGetKernelWorkGroupInfo(handle, device, CL_KERNEL_WORK_GROUP_SIZE, sizeof max_group_size, &max_group_size, nullptr) != CL_SUCCESS ||
      max_group_size == 0)
    max_group_size = std::max<std::size_t>(1, info().max_work_group);
  group_size = required[0] != 0 ? required[0] : std::min(info().is_gpu ? gpu_group_size : cpu_group_size, max_group_size);
}

Kernel::State::~State() {
  if (handle != nullptr) clReleaseKernel(handle);
}

void Kernel::State::check_count(unsigned given) const {
  if (given != argument_count)
    throw Error("the kernel " + name + " takes " + argument_text(argument_count) + ", but " + std::to_string(given) +
                (given == 1 ? " was given" : " were given"));
}

void Kernel::State::run(std::size_t items, std::size_t group) const {
  Device::State& device = *program->device;
  cl_event event = nullptr;
  check(clEnqueueNDRangeKernel(device.queue, handle, 1, nullptr, &items, &group, 0, nullptr, device.timing ? &event : nullptr),
        "clEnqueueNDRangeKernel", info(), [&] { return "running " + name; });
  if (event != nullptr) device.add_launch(name, event);
}

const std::string& Kernel::name() const {
  if (!state_) throw Error("a kernel was asked for its name that belongs to no program");
  return state_->name;
}

std::vector<Parameter> Kernel::parameters() const { return signature_of(state_->program->source, name()); }

void Kernel::set_memory(unsigned index, const Memory& memory) const {
  const cl_mem handle = static_cast<cl_mem>(memory.handle());
  if (!state_) throw Error("a kernel was launched that belongs to no program");
  if (handle == nullptr)
    throw Error("argument " + std::to_string(index + 1) + " of the kernel " + state_->name + " is a buffer without device memory");
  set_bytes(index, &handle, sizeof handle);
}

void Kernel::set_bytes(unsigned index, const void* bytes, std::size_t size) const {
  if (!state_) throw Error("a kernel was launched that belongs to no program");
  state_->prepare();
  if (index >= state_->argument_count) return;  // the count is checked, and said, once all are known
  const cl_int code = clSetKernelArg(state_->handle, index, size, bytes);
  if (code == CL_SUCCESS) return;
  const std::string argument = "argument " + std::to_string(index + 1) + " of the kernel " + state_->name;
  if (code == CL_INVALID_ARG_SIZE || code == CL_INVALID_MEM_OBJECT || code == CL_INVALID_ARG_VALUE)
    throw Error(argument + " has another type than was given (" + std::to_string(size) + " bytes; " + error_name(code) + ")");
  fail(code, "clSetKernelArg", state_->info(), "setting " + argument);
}

void Kernel::enqueue(std::size_t items, unsigned argument_count) const {
  if (!state_) throw Error("a kernel was launched that belongs to no program");
  state_->prepare();
  state_->check_count(argument_count);
  if (items == 0) return;
  const std::size_t group = state_->group_size;
  state_->run((items + group - 1) / group * group, group);
}

void Kernel::enqueue_groups(std::size_t groups, std::size_t group_size, unsigned argument_count) const {
  if (!state_) throw Error("a kernel was launched that belongs to no program");
  state_->prepare();
  state_->check_count(argument_count);
  if (groups == 0) return;
  if (group_size == 0 || group_size > state_->max_group_size)
    throw Error("the kernel " + state_->name + " cannot run in work-groups of " + std::to_string(group_size) + " items on " +
                state_->info().name + ", which allows 1 to " + std::to_string(state_->max_group_size));
  state_->run(groups * group_size, group_size);
}

}  // namespace wavetank::compute

#include "wavetank/compute/program.h"

#include <cstdlib>
#include <vector>

#include "program_cache.h"
#include "program_state.h"
#include "source.h"
#include "wavetank/common/error.h"

namespace wavetank::compute {
namespace {

Hash key_of(const Device::State& device, const std::string& source, const std::string& options) {
  Hash key;
  for (const std::string* part : {&source, &options, &device.info.name, &device.info.driver, &device.info.version,
                                  &device.info.platform_name, &device.platform_version})
    key.add(*part);
  return key;
}

/// pocl keeps what it compiles on disk itself, for the work-group sizes that were used; asking it for a binary makes it compile every
/// kernel once more for no particular size. So it is left to its own cache, unless a directory of ours was named.
std::string cache_directory_for(const DeviceInfo& device) {
  const bool keeps_its_own = device.platform_name == "Portable Computing Language";
  return keeps_its_own && std::getenv("WAVETANK_CACHE_DIRECTORY") == nullptr ? "" : cache_directory();
}

/// What WAVETANK_BUILD_OPTIONS adds, such as -cl-opt-disable for short runs, of which compiling is most.
std::string with_own_options(const std::string& options) {
  const char* own = std::getenv("WAVETANK_BUILD_OPTIONS");
  return own == nullptr || *own == '\0' ? options : options + " " + own;
}

std::string build_log(cl_program program, cl_device_id device) {
  std::size_t size = 0;
  if (clGetProgramBuildInfo(program, device, CL_PROGRAM_BUILD_LOG, 0, nullptr, &size) != CL_SUCCESS || size == 0) return "";
  std::vector<char> log(size);  // ends in a NUL
  if (clGetProgramBuildInfo(program, device, CL_PROGRAM_BUILD_LOG, size, log.data(), nullptr) != CL_SUCCESS) return "";
  return log.data();
}

}  // namespace

Program::State::State(std::shared_ptr<Device::State> on, const SourceFiles& sources, const std::string& main_file, const std::string& given)
    : device(std::move(on)),
      main(main_file),
      source(definitions_that_matter(resolve_includes(sources, main))),
      files(sources),
      options(with_own_options(options_that_matter(given, source))) {}

Program::State::~State() {
  if (handle != nullptr) clReleaseProgram(handle);
}

cl_program Program::State::built() {
  const std::lock_guard<std::mutex> lock(device->programs_mutex);
  if (handle != nullptr) return handle;
  const std::string directory = cache_directory_for(device->info);
  const Hash key = key_of(*device, source, options);
  const auto known = device->programs.find(key.value());
  if (known != device->programs.end()) {
    handle = known->second;
  } else {
    if (directory.empty() || !build_from_binary(load_binary(directory, key))) {
      build_from_source();
      if (!directory.empty()) store_binary(directory, key, binary());
    }
    device->programs.emplace(key.value(), handle);
  }
  clRetainProgram(handle);  // once for the device, which keeps it for those to come
  return handle;
}

bool Program::State::build_from_binary(const std::vector<unsigned char>& binary) {
  if (binary.empty()) return false;
  const unsigned char* bytes = binary.data();
  const std::size_t size = binary.size();
  cl_int status = CL_SUCCESS, code = CL_SUCCESS;
  handle = clCreateProgramWithBinary(device->context, 1, &device->id, &size, &bytes, &status, &code);
  if (handle != nullptr && code == CL_SUCCESS && status == CL_SUCCESS &&
      clBuildProgram(handle, 1, &device->id, options.c_str(), nullptr, nullptr) == CL_SUCCESS)
    return true;
  if (handle != nullptr) clReleaseProgram(handle);
  handle = nullptr;
  return false;
}

void Program::State::build_from_source() {
  const DeviceInfo& info = device->info;
  const char* text = source.c_str();
  const std::size_t size = source.size();
  cl_int code = CL_SUCCESS;
  handle = clCreateProgramWithSource(device->context, 1, &text, &size, &code);
  check(code, "clCreateProgramWithSource", info, [&] { return "reading " + main; });
  code = clBuildProgram(handle, 1, &device->id, options.c_str(), nullptr, nullptr);
  if (code == CL_SUCCESS) return;
  const std::string log = build_log(handle, device->id);
  clReleaseProgram(handle);
  handle = nullptr;
  if (code == CL_INVALID_BUILD_OPTIONS) throw Error(info.name + " does not take the build options \"" + options + "\" for " + main);
  if (code != CL_BUILD_PROGRAM_FAILURE && log.empty()) fail(code, "clBuildProgram", info, "compiling " + main);
  throw Error("the compiler of " + info.name + " refused " + main + " with the options \"" + options +
              "\": " + explain_build_log(log, files, source));
}

std::vector<unsigned char> Program::State::binary() const {
  std::size_t size = 0;
  if (clGetProgramInfo(handle, CL_PROGRAM_BINARY_SIZES, sizeof size, &size, nullptr) != CL_SUCCESS || size == 0) return {};
  std::vector<unsigned char> bytes(size);
  unsigned char* to = bytes.data();
  if (clGetProgramInfo(handle, CL_PROGRAM_BINARIES, sizeof to, &to, nullptr) != CL_SUCCESS) return {};
  return bytes;
}

Program::Program(const Device& device, const SourceFiles& files, const std::string& main, const std::string& options, Build when)
    : state_(std::make_shared<State>(device.state(), files, main, options)) {
  if (when == Build::now) state_->built();
}

Kernel Program::kernel(const std::string& name) const {
  if (!state_) throw Error("the kernel " + name + " was asked of a program that has not been built");
  Kernel kernel;
  kernel.state_ = std::make_shared<Kernel::State>(state_, name);
  if (state_->is_built()) kernel.state_->prepare();
  return kernel;
}

}  // namespace wavetank::compute

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <vector>

#include "device_state.h"
#include "driver_environment.h"
#include "wavetank/common/error.h"

namespace wavetank::compute {
namespace {

std::vector<cl_platform_id> platform_ids() {
  prepare_driver_environment();
  cl_uint count = 0;
  if (clGetPlatformIDs(0, nullptr, &count) != CL_SUCCESS || count == 0) return {};
  std::vector<cl_platform_id> ids(count);
  if (clGetPlatformIDs(count, ids.data(), nullptr) != CL_SUCCESS) return {};
  return ids;
}

std::vector<cl_device_id> device_ids(cl_platform_id platform) {
  cl_uint count = 0;
  if (clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 0, nullptr, &count) != CL_SUCCESS || count == 0) return {};
  std::vector<cl_device_id> ids(count);
  if (clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, count, ids.data(), nullptr) != CL_SUCCESS) return {};
  return ids;
}

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\n\0");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\n") - first + 1);
}

std::string device_text(cl_device_id id, cl_device_info what) {
  std::size_t size = 0;
  if (clGetDeviceInfo(id, what, 0, nullptr, &size) != CL_SUCCESS || size == 0) return "";
  std::vector<char> text(size);  // ends in a NUL
  if (clGetDeviceInfo(id, what, size, text.data(), nullptr) != CL_SUCCESS) return "";
  return trimmed(text.data());
}

std::string platform_text(cl_platform_id id, cl_platform_info what) {
  std::size_t size = 0;
  if (clGetPlatformInfo(id, what, 0, nullptr, &size) != CL_SUCCESS || size == 0) return "";
  std::vector<char> text(size);  // ends in a NUL
  if (clGetPlatformInfo(id, what, size, text.data(), nullptr) != CL_SUCCESS) return "";
  return trimmed(text.data());
}

template <class T>
T device_value(cl_device_id id, cl_device_info what) {
  T value{};
  if (clGetDeviceInfo(id, what, sizeof value, &value, nullptr) != CL_SUCCESS) return T{};
  return value;
}

/// A device that is switched off or cannot compile is no use to us; it keeps its index but is not listed.
bool usable(cl_device_id id) {
  return device_value<cl_bool>(id, CL_DEVICE_AVAILABLE) && device_value<cl_bool>(id, CL_DEVICE_COMPILER_AVAILABLE);
}

DeviceInfo device_info(cl_device_id id) {
  DeviceInfo info;
  info.name = device_text(id, CL_DEVICE_NAME);
  info.driver = device_text(id, CL_DRIVER_VERSION);
  info.version = device_text(id, CL_DEVICE_VERSION);
  const auto type = device_value<cl_device_type>(id, CL_DEVICE_TYPE);
  // A simulated device may call itself every type at once; it is a CPU to us.
  info.is_gpu = (type & CL_DEVICE_TYPE_GPU) != 0 && (type & CL_DEVICE_TYPE_CPU) == 0;
  info.has_double = device_value<cl_device_fp_config>(id, CL_DEVICE_DOUBLE_FP_CONFIG) != 0;
  info.vector_width = std::max(1u, device_value<cl_uint>(id, CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT));
  info.compute_units = device_value<cl_uint>(id, CL_DEVICE_MAX_COMPUTE_UNITS);
  info.global_memory = device_value<cl_ulong>(id, CL_DEVICE_GLOBAL_MEM_SIZE);
  info.max_allocation = device_value<cl_ulong>(id, CL_DEVICE_MAX_MEM_ALLOC_SIZE);
  info.max_work_group = device_value<std::size_t>(id, CL_DEVICE_MAX_WORK_GROUP_SIZE);
  return info;
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return text;
}

std::string described(const std::vector<DeviceInfo>& devices) {
  std::string text;
  for (const DeviceInfo& device : devices) text += (text.empty() ? "" : "; ") + device.describe();
  return text;
}

/// Reads "P:D"; false if the text is something else.
bool read_indices(const std::string& text, int& platform, int& device) {
  int length = 0;
  return std::sscanf(text.c_str(), "%9d:%9d%n", &platform, &device, &length) == 2 && std::size_t(length) == text.size();
}

std::vector<DeviceInfo> matching_name(const std::vector<DeviceInfo>& devices, const std::string& part) {
  std::vector<DeviceInfo> matches;
  for (const DeviceInfo& device : devices) {
    if (lower(device.name).find(lower(part)) != std::string::npos) matches.push_back(device);
  }
  return matches;
}

std::vector<DeviceInfo> of_kind(const std::vector<DeviceInfo>& devices, bool gpu) {
  std::vector<DeviceInfo> matches;
  std::copy_if(devices.begin(), devices.end(), std::back_inserter(matches), [gpu](const DeviceInfo& d) { return d.is_gpu == gpu; });
  return matches;
}

}  // namespace

std::string DeviceInfo::indices() const { return std::to_string(platform) + ":" + std::to_string(device); }

std::string DeviceInfo::describe() const {
  return indices() + " " + name + " (" + platform_name + ", driver " + driver + ", " + std::to_string(compute_units) +
         (compute_units == 1 ? " unit, " : " units, ") + size_text(global_memory) + ")";
}

std::vector<DeviceInfo> list_devices() {
  std::vector<DeviceInfo> devices;
  const auto platforms = platform_ids();
  for (std::size_t p = 0; p < platforms.size(); ++p) {
    const auto ids = device_ids(platforms[p]);
    for (std::size_t d = 0; d < ids.size(); ++d) {
      if (!usable(ids[d])) continue;
      DeviceInfo info = device_info(ids[d]);
      info.platform = int(p);
      info.device = int(d);
      info.platform_name = platform_text(platforms[p], CL_PLATFORM_NAME);
      devices.push_back(info);
    }
  }
  return devices;
}

cl_device_id find_device(const DeviceInfo& info) {
  const auto platforms = platform_ids();
  if (info.platform >= 0 && std::size_t(info.platform) < platforms.size()) {
    const auto ids = device_ids(platforms[info.platform]);
    if (info.device >= 0 && std::size_t(info.device) < ids.size()) return ids[info.device];
  }
  throw Error("the OpenCL device " + info.describe() + " is there no more");
}

DeviceInfo choose_device(const std::string& selector) {
  const auto devices = list_devices();
  if (devices.empty())
    throw Error(
        "no OpenCL device was found on this machine: install an OpenCL driver (pocl-opencl-icd runs on any CPU) "
        "and look whether /etc/OpenCL/vendors names it");
  const std::string kind = lower(selector);
  if (kind == "auto" || kind == "gpu" || kind == "cpu") {
    auto matches = of_kind(devices, kind != "cpu");
    if (matches.empty() && kind == "auto") return devices.front();
    if (matches.empty())
      throw Error("no OpenCL device is a " + std::string(kind == "gpu" ? "GPU" : "CPU") + "; there are: " + described(devices));
    return matches.front();
  }
  int platform = 0, index = 0;
  if (read_indices(selector, platform, index)) {
    for (const DeviceInfo& device : devices)
      if (device.platform == platform && device.device == index) return device;
    throw Error("no OpenCL device has the indices " + selector + " (platform:device); there are: " + described(devices));
  }
  const auto matches = selector.empty() ? std::vector<DeviceInfo>{} : matching_name(devices, selector);
  if (matches.size() == 1) return matches.front();
  if (matches.empty())
    throw Error("no OpenCL device is called \"" + selector + "\"; there are: " + described(devices) +
                "; choose auto, cpu, gpu, PLATFORM:DEVICE or a part of a name");
  throw Error("several OpenCL devices are called \"" + selector + "\": " + described(matches) + "; choose one as PLATFORM:DEVICE");
}

}  // namespace wavetank::compute

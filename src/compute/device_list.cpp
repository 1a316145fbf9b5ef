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

/// A piece of a device, to be released by its owner.
cl_device_id piece_of(cl_device_id whole, const DeviceInfo& info) {
  std::vector<cl_device_id> pieces(static_cast<std::size_t>(device_value<cl_uint>(whole, CL_DEVICE_MAX_COMPUTE_UNITS)));
  const cl_device_partition_property equally[] = {CL_DEVICE_PARTITION_EQUALLY,
                                                  static_cast<cl_device_partition_property>(info.compute_units), 0};
  cl_uint made = 0;
  check(clCreateSubDevices(whole, equally, static_cast<cl_uint>(pieces.size()), pieces.data(), &made), "clCreateSubDevices", info,
        "dividing the device");
  pieces.resize(made);
  if (static_cast<std::size_t>(info.piece) >= pieces.size())
    throw Error("the device " + info.describe() + " was divided into fewer pieces");
  for (std::size_t k = 0; k < pieces.size(); ++k)
    if (k != static_cast<std::size_t>(info.piece)) clReleaseDevice(pieces[k]);
  return pieces[info.piece];
}

/// Whether the device divides itself into pieces of as many units each.
bool can_divide(const DeviceInfo& info) {
  const cl_device_id id = find_device(info);
  std::size_t size = 0;
  if (clGetDeviceInfo(id, CL_DEVICE_PARTITION_PROPERTIES, 0, nullptr, &size) != CL_SUCCESS || size == 0) return false;
  std::vector<cl_device_partition_property> ways(size / sizeof(cl_device_partition_property));
  if (clGetDeviceInfo(id, CL_DEVICE_PARTITION_PROPERTIES, size, ways.data(), nullptr) != CL_SUCCESS) return false;
  return std::find(ways.begin(), ways.end(), CL_DEVICE_PARTITION_EQUALLY) != ways.end();
}

std::vector<DeviceInfo> divided(const DeviceInfo& whole, unsigned pieces) {
  if (pieces == 1) return {whole};
  const std::string wanted = "cannot be divided into " + std::to_string(pieces) + " pieces: ";
  if (pieces == 0 || pieces > whole.compute_units)
    throw Error("the device " + whole.describe() + " " + wanted + "give 1 to " + std::to_string(whole.compute_units) +
                ", or name the device several times");
  if (!can_divide(whole)) throw Error("the device " + whole.describe() + " " + wanted + "its driver does not divide it");
  std::vector<DeviceInfo> result(pieces, whole);
  for (unsigned k = 0; k < pieces; ++k) {
    result[k].pieces = static_cast<int>(pieces);
    result[k].piece = static_cast<int>(k);
    result[k].compute_units = whole.compute_units / pieces;
  }
  return result;
}

/// Takes "/N" from the end; 1 where there is none.
unsigned take_pieces(std::string& selector) {
  const std::size_t slash = selector.rfind('/');
  if (slash == std::string::npos || slash + 1 == selector.size() || selector.size() > slash + 5 ||
      selector.find_first_not_of("0123456789", slash + 1) != std::string::npos)
    return 1;
  const auto pieces = static_cast<unsigned>(std::stoul(selector.substr(slash + 1)));
  selector.resize(slash);
  return pieces;
}

std::vector<DeviceInfo> of_kind(const std::vector<DeviceInfo>& devices, bool gpu) {
  std::vector<DeviceInfo> matches;
  std::copy_if(devices.begin(), devices.end(), std::back_inserter(matches), [gpu](const DeviceInfo& d) { return d.is_gpu == gpu; });
  return matches;
}

}  // namespace

std::string DeviceInfo::indices() const {
  return std::to_string(platform) + ":" + std::to_string(device) + (pieces > 1 ? "/" + std::to_string(pieces) : "");
}

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
    if (info.device >= 0 && std::size_t(info.device) < ids.size())
      return info.pieces == 1 ? ids[info.device] : piece_of(ids[info.device], info);
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

std::vector<DeviceInfo> choose_devices(const std::string& selectors) {
  if (lower(selectors) == "all") {
    choose_device("auto");  // throws if there is none
    return list_devices();
  }
  std::vector<DeviceInfo> chosen;
  for (std::size_t begin = 0; begin <= selectors.size();) {
    const std::size_t end = std::min(selectors.find(',', begin), selectors.size());
    std::string selector = trimmed(selectors.substr(begin, end - begin));
    const unsigned pieces = take_pieces(selector);
    const std::vector<DeviceInfo> more = divided(choose_device(selector), pieces);
    chosen.insert(chosen.end(), more.begin(), more.end());
    begin = end + 1;
  }
  return chosen;
}

}  // namespace wavetank::compute

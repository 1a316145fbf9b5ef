#include "opencl_call.h"

#include <cstdio>

#include "wavetank/common/error.h"

namespace wavetank::compute {
namespace {

struct CodeName {
  cl_int code;
  const char* name;
};

#define WAVETANK_CODE(code) \
  { code, #code }
const CodeName code_names[] = {
    WAVETANK_CODE(CL_DEVICE_NOT_FOUND),
    WAVETANK_CODE(CL_DEVICE_NOT_AVAILABLE),
    WAVETANK_CODE(CL_COMPILER_NOT_AVAILABLE),
    WAVETANK_CODE(CL_MEM_OBJECT_ALLOCATION_FAILURE),
    WAVETANK_CODE(CL_OUT_OF_RESOURCES),
    WAVETANK_CODE(CL_OUT_OF_HOST_MEMORY),
    WAVETANK_CODE(CL_PROFILING_INFO_NOT_AVAILABLE),
    WAVETANK_CODE(CL_MEM_COPY_OVERLAP),
    WAVETANK_CODE(CL_BUILD_PROGRAM_FAILURE),
    WAVETANK_CODE(CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST),
    WAVETANK_CODE(CL_LINKER_NOT_AVAILABLE),
    WAVETANK_CODE(CL_INVALID_VALUE),
    WAVETANK_CODE(CL_INVALID_DEVICE_TYPE),
    WAVETANK_CODE(CL_INVALID_PLATFORM),
    WAVETANK_CODE(CL_INVALID_DEVICE),
    WAVETANK_CODE(CL_INVALID_CONTEXT),
    WAVETANK_CODE(CL_INVALID_QUEUE_PROPERTIES),
    WAVETANK_CODE(CL_INVALID_COMMAND_QUEUE),
    WAVETANK_CODE(CL_INVALID_MEM_OBJECT),
    WAVETANK_CODE(CL_INVALID_BINARY),
    WAVETANK_CODE(CL_INVALID_BUILD_OPTIONS),
    WAVETANK_CODE(CL_INVALID_PROGRAM),
    WAVETANK_CODE(CL_INVALID_PROGRAM_EXECUTABLE),
    WAVETANK_CODE(CL_INVALID_KERNEL_NAME),
    WAVETANK_CODE(CL_INVALID_KERNEL_DEFINITION),
    WAVETANK_CODE(CL_INVALID_KERNEL),
    WAVETANK_CODE(CL_INVALID_ARG_INDEX),
    WAVETANK_CODE(CL_INVALID_ARG_VALUE),
    WAVETANK_CODE(CL_INVALID_ARG_SIZE),
    WAVETANK_CODE(CL_INVALID_KERNEL_ARGS),
    WAVETANK_CODE(CL_INVALID_WORK_DIMENSION),
    WAVETANK_CODE(CL_INVALID_WORK_GROUP_SIZE),
    WAVETANK_CODE(CL_INVALID_WORK_ITEM_SIZE),
    WAVETANK_CODE(CL_INVALID_GLOBAL_OFFSET),
    WAVETANK_CODE(CL_INVALID_EVENT_WAIT_LIST),
    WAVETANK_CODE(CL_INVALID_EVENT),
    WAVETANK_CODE(CL_INVALID_OPERATION),
    WAVETANK_CODE(CL_INVALID_BUFFER_SIZE),
    WAVETANK_CODE(CL_INVALID_GLOBAL_WORK_SIZE),
    WAVETANK_CODE(CL_INVALID_PROPERTY),
    WAVETANK_CODE(CL_INVALID_COMPILER_OPTIONS),
    {-1001, "CL_PLATFORM_NOT_FOUND_KHR"},
};
#undef WAVETANK_CODE

/// Codes that drivers give when the device is gone, hangs or has no room left, whatever was asked of it.
bool means_lost(cl_int code) {
  return code == CL_DEVICE_NOT_AVAILABLE || code == CL_OUT_OF_RESOURCES || code == CL_OUT_OF_HOST_MEMORY ||
         code == CL_INVALID_COMMAND_QUEUE || code == CL_MEM_OBJECT_ALLOCATION_FAILURE ||
         code == CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST;
}

}  // namespace

std::string error_name(cl_int code) {
  for (const CodeName& entry : code_names)
    if (entry.code == code) return entry.name;
  return "OpenCL error " + std::to_string(code);
}

void fail(cl_int code, const char* call, const DeviceInfo& device, const std::string& doing) {
  const std::string reason = std::string(" (") + call + ": " + error_name(code) + ")";
  if (means_lost(code)) throw Error("the device " + device.name + " was lost or ran out of resources while " + doing + reason);
  throw Error("the device " + device.name + " failed while " + doing + reason);
}

std::string size_text(std::size_t bytes) {
  const double mebibytes = double(bytes) / (1024.0 * 1024.0);
  char text[64];
  if (mebibytes < 1024.0)
    std::snprintf(text, sizeof text, "%.1f MiB", mebibytes);
  else
    std::snprintf(text, sizeof text, "%.1f GiB", mebibytes / 1024.0);
  return text;
}

}  // namespace wavetank::compute

#pragma once

#ifndef CL_TARGET_OPENCL_VERSION
#define CL_TARGET_OPENCL_VERSION 120
#endif
#define CL_USE_DEPRECATED_OPENCL_1_2_APIS
#include <CL/cl.h>

#include <string>

#include "wavetank/compute/device.h"

namespace wavetank::compute {

/// OpenCL's own name of an error code ("CL_OUT_OF_RESOURCES").
std::string error_name(cl_int code);

/// Throws Error for a code that is not CL_SUCCESS. `call` is the function that returned it, `doing` what it was for, as in "running sweep".
[[noreturn]] void fail(cl_int code, const char* call, const DeviceInfo& device, const std::string& doing);

/// Fails unless code is CL_SUCCESS. `doing` returns its text, which nobody needs as long as all is well.
template <class Doing>
void check(cl_int code, const char* call, const DeviceInfo& device, const Doing& doing) {
  if (code != CL_SUCCESS) fail(code, call, device, doing());
}
inline void check(cl_int code, const char* call, const DeviceInfo& device, const char* doing) {
  if (code != CL_SUCCESS) fail(code, call, device, doing);
}

/// "12.5 MiB", "23.4 GiB".
std::string size_text(std::size_t bytes);

}  // namespace wavetank::compute

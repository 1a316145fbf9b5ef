#include "compute_fixture.h"

namespace wavetank::compute::no_device_test {
namespace {

// In a process of its own, since the loader reads this variable once a process.
TEST(ChooseDeviceOfNone, SaysWhenThereIsNone) {
  const ScratchDirectory empty;
  setenv("OCL_ICD_VENDORS", empty.path().c_str(), 1);
  setenv("OPENCL_VENDOR_PATH", empty.path().c_str(), 1);
  unsetenv("OCL_ICD_FILENAMES");
  if (!list_devices().empty()) GTEST_SKIP() << "this OpenCL library is no loader and has a device built in";
  for (const char* selector : {"auto", "cpu", "gpu", "0:0", "pocl"}) {
    const std::string error = error_of([&] { choose_device(selector); });
    EXPECT_TRUE(contains(error, "no OpenCL device was found")) << error;
    EXPECT_TRUE(contains(error, "pocl-opencl-icd")) << error;
  }
}

}  // namespace
}  // namespace wavetank::compute::no_device_test

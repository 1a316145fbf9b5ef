#include "wavetank/compute/device.h"

#include "../../src/compute/opencl_call.h"
#include "compute_fixture.h"

namespace wavetank::compute::device_test {
namespace {

TEST(Devices, AreListedWithWhatTheyCanDo) {
  const auto devices = list_devices();
  ASSERT_FALSE(devices.empty());
  for (const DeviceInfo& device : devices) {
    EXPECT_FALSE(device.name.empty());
    EXPECT_FALSE(device.driver.empty());
    EXPECT_EQ(device.version.substr(0, 7), "OpenCL ");
    EXPECT_GE(device.compute_units, 1u);
    EXPECT_GE(device.max_work_group, 1u);
    EXPECT_GE(device.global_memory, device.max_allocation);
    EXPECT_GT(device.max_allocation, 0u);
    EXPECT_TRUE(contains(device.describe(), device.name));
    EXPECT_TRUE(contains(device.describe(), std::to_string(device.platform) + ":" + std::to_string(device.device) + " "));
  }
}

TEST(ChooseDevice, TakesIndicesAndPartsOfNames) {
  const DeviceInfo first = list_devices().front();
  const std::string indices = std::to_string(first.platform) + ":" + std::to_string(first.device);
  EXPECT_EQ(choose_device(indices).name, first.name);
  if (list_devices().size() > 1) return;
  std::string part = first.name.substr(1);
  for (char& c : part) c = char(std::toupper(static_cast<unsigned char>(c)));
  EXPECT_EQ(choose_device(part).describe(), first.describe());
}

TEST(ChooseDevice, TakesKinds) {
  const auto devices = list_devices();
  bool gpu = false, cpu = false;
  for (const DeviceInfo& device : devices) (device.is_gpu ? gpu : cpu) = true;
  EXPECT_EQ(choose_device("auto").is_gpu, gpu);
  for (const bool wanted_gpu : {false, true}) {
    const char* kind = wanted_gpu ? "gpu" : "cpu";
    if (wanted_gpu ? gpu : cpu) {
      EXPECT_EQ(choose_device(kind).is_gpu, wanted_gpu);
    } else {
      const std::string error = error_of([&] { choose_device(kind); });
      EXPECT_TRUE(contains(error, devices.front().describe())) << error;
    }
  }
}

TEST(ChooseDevice, RefusesUnknownOnesAndListsWhatThereIs) {
  const DeviceInfo first = list_devices().front();
  for (const char* selector : {"abacus", "97:3", "0:-1", ""}) {
    const std::string error = error_of([&] { choose_device(selector); });
    EXPECT_TRUE(contains(error, selector)) << error;
    EXPECT_TRUE(contains(error, first.describe())) << error;
  }
}

TEST(Device, RefusesAnEntryThatIsGone) {
  DeviceInfo gone = choose_device("auto");
  gone.device = 1000;
  EXPECT_TRUE(contains(error_of([&] { Device device(gone); }), "there no more"));
}

TEST(Check, NamesALostDeviceAndWhatItRan) {
  DeviceInfo info;
  info.name = "Abacus 9";
  for (const cl_int code : {CL_DEVICE_NOT_AVAILABLE, CL_OUT_OF_RESOURCES, CL_OUT_OF_HOST_MEMORY, CL_INVALID_COMMAND_QUEUE}) {
    const std::string error = error_of([&] { check(code, "clFinish", info, "running sweep"); });
    EXPECT_TRUE(contains(error, "the device Abacus 9 was lost or ran out of resources while running sweep")) << error;
    EXPECT_TRUE(contains(error, error_name(code))) << error;
  }
  EXPECT_FALSE(contains(error_of([&] { check(CL_INVALID_VALUE, "clFinish", info, "running sweep"); }), "lost"));
  EXPECT_NO_THROW(check(CL_SUCCESS, "clFinish", info, "running sweep"));
}

}  // namespace
}  // namespace wavetank::compute::device_test

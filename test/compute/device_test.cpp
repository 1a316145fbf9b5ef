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

TEST(ChooseDevices, TakesOneSeveralOrAll) {
  const DeviceInfo first = choose_device("auto");
  const auto indices = [](const std::vector<DeviceInfo>& devices) {
    std::string text;
    for (const DeviceInfo& device : devices) text += (text.empty() ? "" : " ") + device.indices();
    return text;
  };
  EXPECT_EQ(indices(choose_devices("auto")), first.indices());
  EXPECT_EQ(indices(choose_devices(first.indices() + ", auto")), first.indices() + " " + first.indices());
  EXPECT_EQ(choose_devices("all").size(), list_devices().size());
  EXPECT_TRUE(contains(error_of([&] { choose_devices("auto,abacus"); }), "\"abacus\""));
  EXPECT_TRUE(contains(error_of([&] { choose_devices("auto,"); }), "\"\""));
  for (const char* pieces : {"auto/0", "auto/9999"})
    EXPECT_TRUE(contains(error_of([&] { choose_devices(pieces); }), "cannot be divided into")) << pieces;
}

TEST(ChooseDevices, APieceOfADeviceComputes) {
  const DeviceInfo whole = choose_device("auto");
  if (whole.is_gpu || whole.compute_units < 2) GTEST_SKIP() << "no CPU with two units";
  const std::vector<DeviceInfo> halves = choose_devices(whole.indices() + "/2");
  ASSERT_EQ(halves.size(), 2u);
  for (const DeviceInfo& half : halves) {
    EXPECT_EQ(half.indices(), whole.indices() + "/2");
    EXPECT_EQ(half.compute_units, whole.compute_units / 2);
    const Device device(half);
    Buffer<int> values(device, std::vector<int>{1, 2, 3});
    Program(device, {{"twice.cl", "__kernel void twice(__global int* v) { v[get_global_id(0) % 3] *= get_global_id(0) < 3 ? 2 : 1; }"}},
            "twice.cl", "")
        .kernel("twice")
        .launch(3, values);
    EXPECT_EQ(values.download(), (std::vector<int>{2, 4, 6}));
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

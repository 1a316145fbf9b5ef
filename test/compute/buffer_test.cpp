#include "wavetank/compute/buffer.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "compute_fixture.h"

namespace wavetank::compute::buffer_test {
namespace {

class BufferTest : public ::testing::Test {
 protected:
  Device device{choose_device("auto")};
};

TEST_F(BufferTest, GivesBackWhatItWasGiven) {
  for (const std::size_t count : {std::size_t(1), std::size_t(3), std::size_t(1000), std::size_t(100003)}) {
    std::vector<int> values(count);
    std::iota(values.begin(), values.end(), 7);
    EXPECT_EQ(Buffer<int>(device, values).download(), values);
  }
}

TEST_F(BufferTest, StartsAsZeros) {
  for (const std::size_t count : {1, 2, 5, 4099}) EXPECT_EQ(Buffer<char>(device, count).download(), std::vector<char>(count, 0));
}

TEST_F(BufferTest, IsZeroedAndCopied) {
  const std::vector<double> values{1.5, -2.0, 1e300};
  Buffer<double> from(device, values), to(device, values.size());
  to.copy_from(from);
  EXPECT_EQ(to.download(), values);
  to.copy_from(to);
  EXPECT_EQ(to.download(), values);
  from.fill_zero();
  EXPECT_EQ(from.download(), std::vector<double>(3, 0.0));
  EXPECT_EQ(to.download(), values);
}

TEST_F(BufferTest, MayBeEmpty) {
  Buffer<float> empty(device, 0);
  EXPECT_NE(empty.memory().handle(), nullptr);
  empty.upload({});
  empty.fill_zero();
  empty.copy_from(Buffer<float>(device, 5));
  EXPECT_TRUE(empty.download().empty());
  Buffer<float> without_device;
  EXPECT_EQ(without_device.memory().handle(), nullptr);
  EXPECT_TRUE(without_device.download().empty());
}

TEST_F(BufferTest, SwapsWithoutCopying) {
  Buffer<int> a(device, std::vector<int>{1, 2, 3}), b(device, std::vector<int>{4});
  void* const handle = a.memory().handle();
  std::swap(a, b);
  EXPECT_EQ(b.memory().handle(), handle);
  EXPECT_EQ(a.download(), std::vector<int>{4});
  EXPECT_EQ(b.download(), (std::vector<int>{1, 2, 3}));
}

TEST_F(BufferTest, ReadsAndWritesParts) {
  Buffer<int> buffer(device, std::vector<int>{1, 2, 3, 4});
  const int nine = 9;
  buffer.memory().write(&nine, sizeof nine, 2 * sizeof nine);
  int last[2] = {};
  buffer.memory().read(last, sizeof last, 2 * sizeof nine);
  EXPECT_EQ(last[0], 9);
  EXPECT_EQ(last[1], 4);
}

TEST_F(BufferTest, LetsWhatItWroteChangeAtOnce) {
  constexpr int writes = 3000;  // more than is ever copied while the queue is behind
  Buffer<int> buffer(device, 1000);
  std::vector<int> values(buffer.size());
  for (int k = 1; k <= writes; ++k) {
    std::fill(values.begin(), values.end(), k);
    buffer.upload(values);
    std::fill(values.begin(), values.end(), -1);
  }
  EXPECT_EQ(buffer.download(), std::vector<int>(buffer.size(), writes));
  EXPECT_EQ(buffer.download(2), std::vector<int>(2, writes));
}

TEST_F(BufferTest, RefusesToPassItsEnd) {
  Buffer<int> buffer(device, 4);
  EXPECT_TRUE(contains(error_of([&] { buffer.upload(std::vector<int>(5)); }), "16 bytes"));
  int value = 0;
  error_of([&] { buffer.memory().read(&value, sizeof value, 16); });
  error_of([&] { buffer.memory().read(&value, sizeof value, ~std::size_t(0)); });
  error_of([&] { buffer.copy_from(Buffer<int>(device, 3)); });
}

TEST_F(BufferTest, IsCountedWhileItLives) {
  const std::size_t before = device.allocated();
  {
    const Buffer<float> buffer(device, 1000);
    EXPECT_GE(device.allocated(), before + 4000);
    EXPECT_LE(device.allocated(), before + 4096);
  }
  EXPECT_EQ(device.allocated(), before);
}

TEST_F(BufferTest, RefusesMoreThanTheDeviceAllows) {
  const std::size_t before = device.allocated();
  DeviceInfo small = device.info();
  small.max_allocation = 3 << 20;
  const Device small_device(small);
  const std::string error = error_of([&] { Buffer<char>(small_device, 5 << 20); });
  EXPECT_TRUE(contains(error, "5.0 MiB")) << error;
  EXPECT_TRUE(contains(error, "3.0 MiB")) << error;
  EXPECT_TRUE(contains(error, small.name)) << error;
  EXPECT_NO_THROW(Buffer<char>(small_device, 3 << 20));
  error_of([&] { Buffer<char>(device, device.info().max_allocation + 1); });
  EXPECT_EQ(device.allocated(), before);
}

}  // namespace
}  // namespace wavetank::compute::buffer_test

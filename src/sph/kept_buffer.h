#pragma once

#include <algorithm>
#include <cstring>
#include <vector>

#include "wavetank/compute/buffer.h"

namespace wavetank {

/// Values that the host sets again and again: they are sent to the device only where they have changed, and the device's memory grows with
/// them.
template <class T>
class KeptBuffer {
 public:
  KeptBuffer() = default;
  KeptBuffer(const compute::Device& device, const std::vector<T>& values) { set(device, values); }

  /// False if the device has these values already.
  bool set(const compute::Device& device, const std::vector<T>& values) {
    if (buffer_.memory().handle() != nullptr && same(values)) return false;
    if (buffer_.memory().handle() == nullptr) buffer_ = compute::Buffer<T>(device, std::max<std::size_t>(values.size(), 1));
    if (buffer_.size() < values.size()) buffer_ = compute::Buffer<T>(device, 2 * values.size());
    buffer_.upload(values);
    values_ = values;
    return true;
  }
  const std::vector<T>& values() const { return values_; }
  const compute::Buffer<T>& on_device() const { return buffer_; }

 private:
  bool same(const std::vector<T>& values) const {
    return values.size() == values_.size() &&
           (values.empty() || std::memcmp(values.data(), values_.data(), values.size() * sizeof(T)) == 0);
  }

  compute::Buffer<T> buffer_;
  std::vector<T> values_;  ///< that the device has
};

}  // namespace wavetank

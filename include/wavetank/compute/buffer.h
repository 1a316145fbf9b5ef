#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "wavetank/compute/device.h"

namespace wavetank::compute {

/// Untyped device memory, owned. Move-only; swap is cheap.
class Memory {
 public:
  Memory() = default;
  /// bytes may be 0 (a 4-byte dummy is made, so that it can be passed to a kernel). Contents start as zero bytes.
  Memory(const Device& device, std::size_t bytes);
  Memory(Memory&&) noexcept = default;
  Memory& operator=(Memory&&) noexcept = default;
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;
  void write(const void* from, std::size_t bytes, std::size_t offset = 0);  ///< queued; `from` may change at once
  void read(void* to, std::size_t bytes, std::size_t offset = 0) const;     ///< blocking, after everything queued before
  void fill_zero();
  void copy_from(const Memory& other, std::size_t bytes);
  std::size_t bytes() const { return bytes_; }
  void* handle() const;  ///< the cl_mem

 private:
  struct State;
  std::shared_ptr<State> state_;
  std::size_t bytes_ = 0;
};

/// A device array of T.
template <class T>
class Buffer {
 public:
  Buffer() = default;
  Buffer(const Device& device, std::size_t count) : memory_(device, count * sizeof(T)), count_(count) {}
  Buffer(const Device& device, const std::vector<T>& values) : Buffer(device, values.size()) { upload(values); }
  Buffer(Buffer&&) noexcept = default;
  Buffer& operator=(Buffer&&) noexcept = default;
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;

  std::size_t size() const { return count_; }
  void upload(const std::vector<T>& values) {
    if (!values.empty()) memory_.write(values.data(), values.size() * sizeof(T));
  }
  std::vector<T> download() const { return download(count_); }
  /// The first `count` of them.
  std::vector<T> download(std::size_t count) const {
    std::vector<T> values(count);
    if (count != 0) memory_.read(values.data(), count * sizeof(T));
    return values;
  }
  void fill_zero() { memory_.fill_zero(); }
  void copy_from(const Buffer& other) { memory_.copy_from(other.memory_, count_ * sizeof(T)); }
  const Memory& memory() const { return memory_; }
  Memory& memory() { return memory_; }

 private:
  Memory memory_;
  std::size_t count_ = 0;
};

}  // namespace wavetank::compute

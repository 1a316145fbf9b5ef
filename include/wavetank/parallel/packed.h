#pragma once

#include <cstring>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "wavetank/common/error.h"
#include "wavetank/parallel/group.h"

namespace wavetank::parallel {

/// Values one after another as bytes, for a message between processes of one program on machines of one kind.
class Packed {
 public:
  template <class T>
  Packed& value(const T& one) {
    static_assert(std::is_trivially_copyable_v<T>, "only what its bytes are can be sent as bytes");
    const char* begin = reinterpret_cast<const char*>(&one);
    bytes_.insert(bytes_.end(), begin, begin + sizeof one);
    return *this;
  }
  template <class T>
  Packed& values(const std::vector<T>& many) {
    static_assert(std::is_trivially_copyable_v<T>, "only what its bytes are can be sent as bytes");
    return run(many.data(), many.size(), sizeof(T));
  }
  Packed& text(const std::string& text) { return run(text.data(), text.size(), 1); }
  Bytes take() { return std::move(bytes_); }

 private:
  Packed& run(const void* first, std::size_t count, std::size_t size) {
    value(count);
    const char* begin = static_cast<const char*>(first);
    if (count > 0) bytes_.insert(bytes_.end(), begin, begin + count * size);
    return *this;
  }

  Bytes bytes_;
};

/// Takes them out again, in their order. Throws Error where there are fewer. The bytes must stay.
class Unpacked {
 public:
  explicit Unpacked(const Bytes& bytes) : bytes_(bytes) {}

  template <class T>
  T value() {
    T one;
    copy(&one, sizeof one);
    return one;
  }
  template <class T>
  std::vector<T> values() {
    std::vector<T> many(count_of(sizeof(T)));
    copy(many.data(), many.size() * sizeof(T));
    return many;
  }
  std::string text() {
    std::string text(count_of(1), ' ');
    copy(text.data(), text.size());
    return text;
  }

 private:
  std::size_t count_of(std::size_t size) {
    const auto count = value<std::size_t>();
    if (count > (bytes_.size() - next_) / size) too_short();
    return count;
  }
  void copy(void* to, std::size_t size) {
    if (size > bytes_.size() - next_) too_short();
    if (size > 0) std::memcpy(to, bytes_.data() + next_, size);
    next_ += size;
  }
  [[noreturn]] static void too_short() { throw Error("a message between parts of the water is shorter than it must be"); }

  const Bytes& bytes_;
  std::size_t next_ = 0;
};

}  // namespace wavetank::parallel

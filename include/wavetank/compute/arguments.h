#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <type_traits>
#include <vector>

#include "wavetank/compute/program.h"

namespace wavetank::compute {

/// The name of a host type in kernels. Left undefined for types that no kernel knows.
template <class T>
struct KernelType;
template <>
struct KernelType<char> {
  static constexpr const char* name = "char";
};
template <>
struct KernelType<int> {
  static constexpr const char* name = "int";
};
template <>
struct KernelType<std::uint32_t> {
  static constexpr const char* name = "uint";
};
template <>
struct KernelType<std::int64_t> {
  static constexpr const char* name = "long";
};
template <>
struct KernelType<float> {
  static constexpr const char* name = "float";
};
template <>
struct KernelType<double> {
  static constexpr const char* name = "double";
};

/// What kernels' parameters stand for, by name. It refers to buffers and scalars, and must not outlive them: what they are when a kernel is
/// launched is what it gets, so they may be swapped, grown or set meanwhile.
class Arguments {
 public:
  /// `aliases`: names that the kernels have for types, such as real for float.
  explicit Arguments(std::map<std::string, std::string> aliases = {}) : aliases_(std::move(aliases)) {}

  /// Each replaces what had the name before. `what` of const may only be read by kernels.
  template <class T>
  Arguments& memory(const std::string& name, const Buffer<T>& what) {
    entries_[name] = {KernelType<T>::name, true, true, &what.memory(), nullptr, 0};
    return *this;
  }
  template <class T>
  Arguments& memory(const std::string& name, Buffer<T>& what) {
    entries_[name] = {KernelType<T>::name, true, false, &what.memory(), nullptr, 0};
    return *this;
  }
  template <class T, class = std::enable_if_t<std::is_arithmetic_v<T>>>
  Arguments& value(const std::string& name, const T& what) {
    entries_[name] = {KernelType<T>::name, false, true, nullptr, &what, sizeof(T)};
    return *this;
  }

 private:
  friend class BoundKernel;
  struct Entry {
    std::string type;
    bool is_memory = false;
    bool is_read_only = false;
    const Memory* memory = nullptr;
    const void* value = nullptr;
    std::size_t size = 0;
  };

  std::map<std::string, std::string> aliases_;
  std::map<std::string, Entry> entries_;
};

/// A kernel with its parameters found by their names.
class BoundKernel {
 public:
  BoundKernel() = default;
  /// Throws Error, in one sentence, for a parameter that has no argument of its name or one of another type, and where the kernel may write
  /// to what may only be read.
  BoundKernel(const Kernel& kernel, const Arguments& arguments);

  /// As Kernel::launch, with what the arguments are now.
  void launch(std::size_t items) const;

 private:
  Kernel kernel_;
  std::vector<Arguments::Entry> entries_;  ///< in the kernel's order
};

}  // namespace wavetank::compute

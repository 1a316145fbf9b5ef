#pragma once

#include <functional>
#include <optional>
#include <utility>

#include "wavetank/compute/program.h"

namespace wavetank {

/// A kernel whose program is built at its first launch, since no case needs all of them and each takes up to a second to compile. For one
/// thread at a time.
class LazyKernel {
 public:
  LazyKernel() = default;
  explicit LazyKernel(std::function<compute::Kernel()> build) : build_(std::move(build)) {}

  /// As compute::Kernel's; of no items, it builds nothing.
  template <class... Arguments>
  void launch(std::size_t items, const Arguments&... arguments) const {
    if (items == 0) return;
    if (!kernel_) kernel_ = build_ ? build_() : compute::Kernel();  // which says that it belongs to no program
    kernel_->launch(items, arguments...);
  }

 private:
  std::function<compute::Kernel()> build_;
  mutable std::optional<compute::Kernel> kernel_;
};

}  // namespace wavetank

#pragma once

#include <map>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "wavetank/compute/buffer.h"
#include "wavetank/compute/device.h"

namespace wavetank::compute {

/// Kernel sources by file name ("sweep.cl" → text), as embedded at build time. `#include "NAME"` in a source is resolved among them, each
/// file at most once (as with #pragma once), with #line directives so that a build error names the kernel's own file and line.
using SourceFiles = std::map<std::string, std::string>;

/// One parameter of a kernel, as its source declares it.
struct Parameter {
  std::string name;
  std::string type;  ///< of the value, or of the array's elements
  bool is_memory = false;
  bool is_const = false;  ///< may not be written to
};

/// One kernel of a program. launch() queues it and returns at once.
class Kernel {
 public:
  const std::string& name() const;
  /// In their order.
  std::vector<Parameter> parameters() const;

  /// Runs at least `items` work-items (rounded up to whole work-groups: the kernel must return at once for ids ≥ its count),
  /// arguments in the kernel's order: Buffer<T> or a scalar of the kernel's exact type (int, unsigned, float, double, ...).
  template <class... Arguments>
  void launch(std::size_t items, const Arguments&... arguments) const {
    unsigned index = 0;
    (set(index++, arguments), ...);
    enqueue(items, index);
  }
  /// As launch, with a work-group size of its own (kernels that use local memory); items must be a multiple of it.
  template <class... Arguments>
  void launch_groups(std::size_t groups, std::size_t group_size, const Arguments&... arguments) const {
    unsigned index = 0;
    (set(index++, arguments), ...);
    enqueue_groups(groups, group_size, index);
  }

 private:
  friend class Program;
  friend class BoundKernel;
  template <class T>
  void set(unsigned index, const Buffer<T>& buffer) const {
    set_memory(index, buffer.memory());
  }
  template <class T, class = std::enable_if_t<std::is_arithmetic_v<T>>>
  void set(unsigned index, const T& scalar) const {
    set_bytes(index, &scalar, sizeof(T));
  }
  void set_memory(unsigned index, const Memory& memory) const;
  void set_bytes(unsigned index, const void* bytes, std::size_t size) const;
  void enqueue(std::size_t items, unsigned argument_count) const;
  void enqueue_groups(std::size_t groups, std::size_t group_size, unsigned argument_count) const;
  struct State;
  std::shared_ptr<State> state_;
};

/// When a program's kernels are compiled.
enum class Build { now, at_first_use };

class Program {
 public:
  Program() = default;
  /// Builds files[main] with its includes. `options` are OpenCL build options ("-DDIMENSIONS=3 -cl-fast-relaxed-math").
  /// What was built before on the same device is taken again. Definitions of names that the source does not hold are left out.
  /// Compiled programs are cached on disk ($WAVETANK_CACHE_DIRECTORY, else $XDG_CACHE_HOME/wavetank, else ~/.cache/wavetank; switched off
  /// by WAVETANK_CACHE_DIRECTORY= empty), keyed by source, options, device and driver; a damaged or unwritable cache is never an error.
  /// pocl has a cache of its own and uses this one only if WAVETANK_CACHE_DIRECTORY names it.
  /// A build error throws Error with the compiler's message and the offending source line.
  Program(const Device& device, const SourceFiles& files, const std::string& main, const std::string& options, Build when = Build::now);
  /// Throws Error if the program has no kernel of that name: at once, or, where it is built at its first use, then.
  Kernel kernel(const std::string& name) const;

 private:
  friend class Kernel;
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace wavetank::compute

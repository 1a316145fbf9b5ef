#pragma once

#include <map>
#include <string>
#include <utility>

#include "build_options.h"
#include "tiling.h"
#include "wavetank/compute/arguments.h"

namespace wavetank {

/// A kernel that goes over the neighbours of particles, points or walls, `own` of them an item.
struct BoundSweep {
  void launch(int count) const { kernel.launch(static_cast<std::size_t>((count + own - 1) / own)); }

  compute::BoundKernel kernel;
  int own = 1;
};

/// Makes the solver's kernels, their parameters found by name. None is compiled before it is first launched: a case pays for what it uses.
class KernelMaker {
 public:
  /// `options`: the build options that all kernels of the solver share.
  KernelMaker(const compute::Device& device, const compute::SourceFiles& files, const std::string& options, const Tiling& tiling)
      : device_(device), files_(files), options_(options), tiling_(tiling) {}

  /// Built without fast-math.
  compute::BoundKernel exact(const std::string& file, const std::string& name, const compute::Arguments& arguments) const {
    return {kernel(file, name, options_), arguments};
  }
  /// A sweep over particles that lie together, in the tiles that suit the device.
  BoundSweep over_particles(const std::string& file, const std::string& name, const compute::Arguments& arguments) const {
    return {{kernel(file, name, options_ + fast + tiling_.particles.build_options()), arguments}, tiling_.particles.own};
  }
  /// Likewise, but an item is a run of slots, not a tile.
  BoundSweep over_runs(const std::string& file, const std::string& name, const compute::Arguments& arguments) const {
    return {over_particles(file, name, arguments).kernel, 1};
  }
  /// A sweep about points or pieces of wall, which need not lie together. `own`: definitions beside those that all kernels share.
  BoundSweep over_points(const std::string& file, const std::string& name, const compute::Arguments& arguments,
                         const BuildOptions& own = {}) const {
    const std::string more = own.empty() ? "" : " " + text_of(own);
    return {{kernel(file, name, options_ + more + fast + tiling_.points.build_options()), arguments}, 1};
  }

 private:
  static constexpr const char* fast = " -cl-fast-relaxed-math";

  compute::Kernel kernel(const std::string& file, const std::string& name, const std::string& options) const {
    const std::pair<std::string, std::string> key(file, options);
    auto program = programs_.find(key);
    if (program == programs_.end())
      program = programs_.emplace(key, compute::Program(device_, files_, file, options, compute::Build::at_first_use)).first;
    return program->second.kernel(name);
  }

  compute::Device device_;
  compute::SourceFiles files_;
  std::string options_;
  Tiling tiling_;
  mutable std::map<std::pair<std::string, std::string>, compute::Program> programs_;  ///< by file and options
};

}  // namespace wavetank

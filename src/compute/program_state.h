#pragma once

#include <memory>
#include <string>
#include <vector>

#include "device_state.h"
#include "wavetank/compute/program.h"

namespace wavetank::compute {

struct Program::State {
  State(std::shared_ptr<Device::State> on, const SourceFiles& files, const std::string& main_file, const std::string& options);
  ~State();
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  /// Builds it, unless that has been done.
  cl_program built();
  bool is_built() const { return handle != nullptr; }

  std::shared_ptr<Device::State> device;
  std::string main;    ///< the main file's name, for messages
  std::string source;  ///< with its includes

 private:
  void build_from_source();
  /// False if the driver does not take the binary.
  bool build_from_binary(const std::vector<unsigned char>& binary);
  std::vector<unsigned char> binary() const;

  SourceFiles files;  ///< for messages
  std::string options;
  cl_program handle = nullptr;
};

struct Kernel::State {
  State(std::shared_ptr<Program::State> of, const std::string& kernel_name);
  ~State();
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  const DeviceInfo& info() const { return program->device->info; }
  /// Makes the kernel, and builds its program, unless that has been done.
  void prepare();
  /// Throws Error unless the kernel takes `given` arguments.
  void check_count(unsigned given) const;
  void run(std::size_t items, std::size_t group_size) const;

  std::shared_ptr<Program::State> program;
  std::string name;
  cl_kernel handle = nullptr;
  cl_uint argument_count = 0;
  std::size_t group_size = 1;      ///< of launch()
  std::size_t max_group_size = 1;  ///< that the device can run this kernel with
};

}  // namespace wavetank::compute

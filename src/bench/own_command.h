#pragma once

#include <string>
#include <vector>

namespace wavetank::bench {

/// What starts this very program again, without its arguments: `cmdline` is /proc/self/cmdline, `executable` what /proc/self/exe points at.
/// A program that was given to a dynamic loader (ld.so PROGRAM ...) is given to it again, with the loader's own options.
std::vector<std::string> command_of(const std::string& cmdline, int argc, const std::string& executable);

/// Of this process, whose main got `argc`. Throws Error where /proc does not tell.
std::vector<std::string> own_command(int argc);

}  // namespace wavetank::bench

#pragma once

#include <string>

namespace wavetank::compute {

/// Sees to it, once and before the first OpenCL call, that a driver which insists on a writable cache directory of its own (pocl) has one:
/// where its usual place cannot be written, it is given one under the temporary directory. What the user has set is left alone.
void prepare_driver_environment();

/// Whether `directory` exists, or can be made with its parents, and takes files.
bool make_writable_directory(const std::string& directory);

/// $XDG_CACHE_HOME, else $HOME/.cache, else empty.
std::string user_cache_directory();

}  // namespace wavetank::compute

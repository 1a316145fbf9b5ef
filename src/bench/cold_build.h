#pragma once

#include <string>
#include <vector>

namespace wavetank::bench {

/// What building the kernels of a case takes where nothing is cached, s: the start of two new processes of `command`, one after the other
/// on a cache that is empty at first, apart from the layout; the first less the second. Throws Error if either fails.
double cold_build_seconds(const std::vector<std::string>& command, const std::string& case_name, const std::string& device);

}  // namespace wavetank::bench

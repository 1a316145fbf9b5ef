#pragma once

#include <string>
#include <vector>

#include "wavetank/compute/program.h"

namespace wavetank::compute {

/// The parameters of a kernel as the resolved text of its program declares them. Macros that stand for several parameters are expanded. The
/// text is read rather than the driver asked, since drivers forget names and types of what they load from their caches.
/// Throws Error if the text has no such kernel.
std::vector<Parameter> signature_of(const std::string& resolved, const std::string& kernel);

}  // namespace wavetank::compute

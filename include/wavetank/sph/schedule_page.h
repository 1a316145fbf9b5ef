#pragma once

#include <string>

#include "wavetank/scene/case.h"

namespace wavetank {

/// The stages of a time step of the case's integrator, and what each reads and writes.
std::string schedule_page(const Case& scene);

}  // namespace wavetank

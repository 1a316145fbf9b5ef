#pragma once

#include <string>

#include "wavetank/simulation/simulation.h"

namespace wavetank {

/// What `wavetank_run --check` prints: a line for the tank, each body and the water, and what the run will cost.
std::string check_report(const Case& checked, const Estimate& estimated);

/// What `wavetank_run --check --parts N` prints.
std::string parts_report(const Case& checked, const PartsEstimate& estimated);

}  // namespace wavetank

#pragma once

#include "wavetank/scene/case.h"

namespace wavetank {

/// The compression ρ/ρ₀ − 1 at which the case's water has a pressure, in ρ₀ c₀².
double compression_at(double head, const Case& scene);

}  // namespace wavetank

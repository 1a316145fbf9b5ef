#pragma once

#include <cstdint>
#include <vector>

#include "parting.h"
#include "wavetank/compute/device.h"
#include "wavetank/sph/parted_solver.h"

namespace wavetank {

/// How the water of a case is cut into parts on devices of this kind.
Parting parting_for(const Case& settled_case, const Layout& layout, const Discretisation& discretisation, const compute::DeviceInfo& device,
                    const PartedSolverOptions& options);

/// Throws Error if the water is too short for so many parts. `weights`: particles of each block; `is_open`: water may come in.
std::vector<int> cuts_for(std::vector<std::int64_t> weights, const Parting& parting, int parts, bool is_open,
                          const PartedSolverOptions& options);

}  // namespace wavetank

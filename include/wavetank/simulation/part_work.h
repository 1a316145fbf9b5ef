#pragma once

#include "wavetank/parallel/group.h"
#include "wavetank/scene/file_path.h"

namespace wavetank {

/// What a process of SimulationOptions::team does for the first of them: its part of the water, of the case that the first sends. Meshes it
/// reads itself. `device_number`: among the processes of its machine, which take turns with the devices that the case names there.
/// `member` must outlive it.
parallel::Team::Work part_work(parallel::Group& member, int device_number, const ResourceResolver& resolve);

}  // namespace wavetank

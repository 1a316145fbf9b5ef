#pragma once

#include "wavetank/compute/program.h"

namespace wavetank {

/// The device code as embedded at build time.
const compute::SourceFiles& embedded_kernel_sources();

/// The same, with every *.cl of the directory $WAVETANK_KERNEL_DIRECTORY, when that is set, in place of the embedded file of its name: for
/// developing.
compute::SourceFiles kernel_sources();

}  // namespace wavetank

#pragma once

#include "wavetank/ranks/ranks.h"

namespace wavetank {

/// All that a process does that mpirun has started beside the first: its part of the water, without a word of its own, since the first has
/// the case, the bag, the topics and the log. Returns the code to exit with.
int serve_first_rank(parallel::Ranks& ranks);

}  // namespace wavetank

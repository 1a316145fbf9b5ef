#pragma once

#include <cstdint>
#include <vector>

namespace wavetank::parallel {

/// Cuts a row of blocks into slabs of about the same weight: the first block of each slab, and the number of blocks. `weights`: of each
/// block, not negative. Every slab has `least` blocks at the least, and some weight. The cuts follow from the weights alone.
/// Throws Error if there are more slabs than that allows.
std::vector<int> cut_into_slabs(const std::vector<std::int64_t>& weights, int slabs, int least = 1);

/// The greatest weight of a slab over the mean of all; 1 where all weigh nothing.
double imbalance(const std::vector<std::int64_t>& weights, const std::vector<int>& cuts);

}  // namespace wavetank::parallel

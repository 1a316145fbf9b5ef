#include "particle_grid.h"

namespace wavetank {

ParticleGrid::ParticleGrid(const compute::Device& device, const compute::SourceFiles& files, const std::string& options, int slots,
                           int particles)
    : slots_(slots),
      particles_(particles),
      blocks_((slots + field::scan_block - 1) / field::scan_block),
      counts_(device, slots),
      starts_(device, slots + 1),
      block_sums_(device, blocks_ + 1),
      group_sums_(device, (blocks_ + field::scan_block - 1) / field::scan_block),
      block_starts_(device, blocks_ + 1),
      slot_of_(device, particles),
      order_(device, particles) {
  const compute::Program program(device, files, "grid.cl", options);
  count_ = program.kernel("count_slots");
  scan_blocks_ = program.kernel("scan_blocks");
  scan_totals_ = program.kernel("scan_totals");
  scan_starts_ = program.kernel("scan_starts");
  scatter_ = program.kernel("scatter");
  settle_ = program.kernel("settle_slots");
  reorder_ = program.kernel("reorder");
}

}  // namespace wavetank

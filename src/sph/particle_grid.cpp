#include "particle_grid.h"

namespace wavetank {

ParticleGrid::ParticleGrid(const compute::Device& device, const compute::SourceFiles& files, const std::string& options, int cells,
                           int particles)
    : cells_(cells),
      particles_(particles),
      blocks_((cells + field::scan_block - 1) / field::scan_block),
      counts_(device, cells),
      starts_(device, cells + 1),
      cursors_(device, cells),
      block_sums_(device, blocks_),
      cell_of_(device, particles),
      order_(device, particles) {
  const compute::Program program(device, files, "grid.cl", options);
  clear_ = program.kernel("clear");
  count_ = program.kernel("count_cells");
  scan_blocks_ = program.kernel("scan_blocks");
  scan_totals_ = program.kernel("scan_totals");
  scan_starts_ = program.kernel("scan_starts");
  scatter_ = program.kernel("scatter");
  settle_ = program.kernel("settle_cells");
  reorder_ = program.kernel("reorder");
}

}  // namespace wavetank

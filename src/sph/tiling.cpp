#include "tiling.h"

namespace wavetank {

std::string Tile::build_options() const { return " -DTILE_OWN=" + std::to_string(own) + " -DTILE_NEAR=" + std::to_string(near); }

Tiling tiling_for(const compute::DeviceInfo& device, Precision precision, bool scalar) {
  // docs/performance.md has what these were chosen by
  Tiling tiling;
  tiling.rows_per_support = 2;
  tiling.slots_per_support = 3;
  if (device.is_gpu) return tiling;
  if (scalar) {
    tiling.rows_per_support = 1;  // the compiler's own vectors want long runs
    return tiling;
  }
  const unsigned lanes = precision == Precision::single ? device.vector_width : device.vector_width / 2;
  if (lanes >= 16) {
    tiling.particles = {4, 4};
    tiling.points = {1, 16};
  } else if (lanes >= 8) {
    tiling.particles = {2, 4};
    tiling.points = {1, 8};
  } else if (lanes >= 4) {
    tiling.particles = {2, 2};
    tiling.points = {1, 4};
  } else {
    tiling.rows_per_support = 2;
  }
  return tiling;
}

}  // namespace wavetank

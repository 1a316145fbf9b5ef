#pragma once

#include <cstdint>

namespace wavetank {

/// From a field of an array to the next, as kernels take it (long): fields times particles pass what an int holds.
using Stride = std::int64_t;

/// That has room for so many particles: whole vectors, and one more, since a tile may read beyond the last particle.
inline Stride stride_for(Stride particles) { return (particles + 31) / 16 * 16; }

/// Fields of the walls, and sizes, as the kernels have them.
namespace field {
enum Wall {
  wall_x,
  wall_y,
  wall_z,
  normal_x,
  normal_y,
  normal_z,
  wall_owner,
  wall_thin,
  area,
  // of rectangles
  tangent_x,
  tangent_y,
  tangent_z,
  half_along,
  half_across,
  gap_along,
  gap_across,
  rectangle_count,
  // of triangles
  corners = tangent_x,
  triangle_count = corners + 9,
  // of facets, whose area is 0 where they are large: three edges (2-D: one) of edge_count values each
  edges = tangent_x
};
enum Around { around_eigenvalue, around_normal, around_shepard = around_normal + 3, around_surface, around_count = around_surface + 5 };
constexpr double shift_most = 0.2;  // of the spacing, in a step
constexpr int edge_count = 8;
constexpr int barrier_edges = 4;
constexpr int barrier_count = 21;
constexpr int free_edge_count = 8;
constexpr int image_count = 37;
constexpr int frame_count = 12;
constexpr int motion_count = 18;
enum Region { region_owner, region_item, region_slot_x, region_row_y, region_row_z, region_end_x, region_runs, region_rows, region_count };
constexpr int region_run = 32;
constexpr int wrench_count = 12;
constexpr int guard_owners = 2;
constexpr int facing_owners = 2;
constexpr int impulse_count = 6;
constexpr int energy_count = 7;
constexpr int drain_count = 12;
constexpr int reduce_chunk = 256;
constexpr int scan_block = 256;
}  // namespace field

/// That reductions over the particles go by.
inline int chunks_of(int particles) { return (particles + field::reduce_chunk - 1) / field::reduce_chunk; }

}  // namespace wavetank

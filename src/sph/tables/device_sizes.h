#pragma once

#include <cstdint>
#include <string>

namespace wavetank {

/// From a field of an array to the next, as kernels take it (long): fields times particles pass what an int holds.
using Stride = std::int64_t;

/// That has room for so many particles: whole vectors, and one more, since a tile may read beyond the last particle.
inline Stride stride_for(Stride particles) { return (particles + 31) / 16 * 16; }

// Sizes, and places of values in arrays, that the host and the kernels go by, a row each: field::name here, NAME there.
// clang-format off
#define WAVETANK_DEVICE_SIZES(ROW) \
  /* fields of the walls that every kind has */ \
  ROW(wall_x, 0, "m: an element's centre, or a point of a facet's plane") \
  ROW(wall_y, 1, "likewise") \
  ROW(wall_z, 2, "likewise") \
  ROW(wall_normal_x, 3, "out of the water") \
  ROW(wall_normal_y, 4, "likewise") \
  ROW(wall_normal_z, 5, "likewise") \
  ROW(wall_owner, 6, "0 the tank, 1 + i body i") \
  ROW(wall_thin, 7, "1: has water on both sides, nearer than the support, and shows itself on its own side only") \
  ROW(wall_area, 8, "m²; of facets, that of small ones, and 0 of large ones") \
  /* of rectangles */ \
  ROW(wall_tangent_x, 9, "along them") \
  ROW(wall_tangent_y, 10, "likewise") \
  ROW(wall_tangent_z, 11, "likewise") \
  ROW(wall_half_along, 12, "m") \
  ROW(wall_half_across, 13, "m") \
  ROW(wall_gap_along, 14, "m, by which the wall that it stands for reaches beyond it: 0 unless that wall is no rectangle") \
  ROW(wall_gap_across, 15, "likewise") \
  ROW(wall_rectangle_count, 16, "fields of a rectangle") \
  /* of triangles */ \
  ROW(wall_corners, 9, "m: three times x, y, z, from the centre") \
  ROW(wall_triangle_count, 18, "fields of a triangle") \
  /* of facets */ \
  ROW(wall_edges, 9, "three times (2-D: once) those of an edge") \
  ROW(edge_count, 8, "an edge: base, direction, length, sign (twice as large: the next facet is large and of the same plane)") \
  /* what is found about each particle's free surface and evenness */ \
  ROW(around_eigenvalue, 0, "λ") \
  ROW(around_normal, 1, "out of the water: x, y, z") \
  ROW(around_shepard, 4, "γ") \
  ROW(around_surface, 5, "1: on the free surface") \
  ROW(around_concentration, 6, "∇C, walls included: x, y, z") \
  ROW(around_walls, 9, "Σ ∫ W dS: 0 where no wall is within the support") \
  ROW(around_approach, 10, "m/s: the greatest speed at which a neighbour comes nearer or goes away, for laws that go by it") \
  ROW(around_law, 11, "what laws sum over neighbours beside ∇C: x, y, z") \
  ROW(around_count, 14, "values of a particle") \
  /* regions of the grid about an owner of walls, in which particles may touch it; gone through in runs of slots along x */ \
  ROW(region_owner, 0, "whose") \
  ROW(region_item, 1, "its first run among those of all regions") \
  ROW(region_slot_x, 2, "its first slot") \
  ROW(region_row_y, 3, "its first row") \
  ROW(region_row_z, 4, "likewise") \
  ROW(region_end_x, 5, "beyond its last slot") \
  ROW(region_runs, 6, "in a row of it") \
  ROW(region_rows, 7, "along y") \
  ROW(region_run, 8, "slots of a run: the first begins at the region's first slot") \
  ROW(region_count, 9, "values of a region") \
  /* walls that move, and what they get */ \
  ROW(wrench_count, 12, "pressure force, viscous force, pressure torque, viscous torque") \
  ROW(frame_count, 12, "of the tank's frame: gravity less the acceleration of its origin, angular velocity, angular acceleration, origin") \
  ROW(motion_velocity, 3, "where velocities and accelerations begin") \
  ROW(motion_friction, 18, "the law of friction on its walls; then roughness, m, or coefficient") \
  ROW(friction_none, 0, "laws") \
  ROW(friction_viscous, 1, "likewise") \
  ROW(friction_of_the_wall, 2, "likewise") \
  ROW(friction_coefficient, 3, "likewise") \
  ROW(motion_count, 20, "of an owner: centre, velocity, angular velocity, acceleration, angular acceleration, velocity of a belt along the surface, friction") \
  ROW(pose_count, 12, "rotation Q, row by row, and displacement d: x' = Q x + d") \
  ROW(guard_owners, 2, "of how many owners of walls the guard tells apart what they take from one particle") \
  ROW(impulse_count, 6, "impulse, and its moment about the owner's centre") \
  ROW(facing_count, 6, "what facing walls add to an owner's wrench: pressure force and torque") \
  ROW(rest_bits, 38, "of a quantum of sums of whole numbers, its rests: 2^38 are one") \
  ROW(facing_owners, 2, "other owners whose walls a piece of wall may face nearer than the support") \
  /* thin walls */ \
  ROW(barrier_edges, 4, "of a barrier") \
  ROW(barrier_count, 21, "plane n, o; the edges' planes m, o, with m·x + o not negative inside; the owner") \
  ROW(free_edge_count, 8, "base, direction, length, and 1, or 0 where another wall stands at it") \
  /* images, drains, zones, reductions */ \
  ROW(image_count, 37, "values of a mirror or a period") \
  ROW(gap_edges, 9, "of a gap in a plane that mirrors: plane n, o, centre, radius and number of edges; then theirs") \
  ROW(drain_count, 12, "centre, and three vectors along which its faces are at −1 and 1") \
  /* zones whose water's state is imposed: a header each, and tables of cells */ \
  ROW(zone_centre, 0, "m: of the front, x, y, z") \
  ROW(zone_normal, 3, "out of the zone through its front") \
  ROW(zone_across, 6, "vector in cells/m, of the first cell's edge in cells from the centre, number of cells") \
  ROW(zone_up, 11, "likewise") \
  ROW(zone_depth, 16, "m, behind the front") \
  ROW(zone_layers, 17, "into which the depth is divided") \
  ROW(zone_table, 18, "where its cells' values begin, or −1") \
  ROW(zone_drift, 19, "m/s, at which water at the centre is carried") \
  ROW(zone_turning, 22, "1/s, what is added to that from the centre on, by row") \
  ROW(zone_heading, 31, "of the speed") \
  ROW(zone_count, 34, "values of a zone") \
  ROW(zone_cell_count, 4, "values of a cell: speed along the heading, pressure, compression, 1 if it is of the zone") \
  ROW(damping_lower, 0, "m: of a damping zone, x, y, z") \
  ROW(damping_upper, 3, "likewise") \
  ROW(damping_slope, 6, "1/m, and where it begins: from 0 to 1 along the zone") \
  ROW(damping_strength, 10, "1/s, at its end") \
  ROW(damping_velocity, 11, "m/s, towards which") \
  ROW(damping_count, 14, "values of a damping zone") \
  /* of the energies */ \
  ROW(energy_kinetic, 0, "J") \
  ROW(energy_potential, 1, "J, about the grid's origin") \
  ROW(energy_compression, 2, "J") \
  ROW(energy_mass, 3, "kg") \
  ROW(energy_moment, 4, "Σ m x, m y, m z from the grid's origin") \
  ROW(energy_damper, 7, "W, that the acoustic damper takes") \
  ROW(energy_zone_force, 8, "N, that damping zones take") \
  ROW(energy_zone_moment, 11, "and its moment about the grid's origin") \
  ROW(energy_count, 14, "values") \
  ROW(reduce_chunk, 256, "values that one work-item sums") \
  ROW(scan_block, 256, "values that one work-item goes through for a running total")
// clang-format on

namespace field {
enum Size : int {
#define WAVETANK_SIZE(name, value, meaning) name = value,
  WAVETANK_DEVICE_SIZES(WAVETANK_SIZE)
#undef WAVETANK_SIZE
};
constexpr double shift_most = 0.2;  ///< of the spacing: no particle is shifted farther in a step
}  // namespace field

/// The device's names for them.
std::string sizes_header();

/// That reductions over the particles go by.
inline int chunks_of(int particles) { return (particles + field::reduce_chunk - 1) / field::reduce_chunk; }

}  // namespace wavetank

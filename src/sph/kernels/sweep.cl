// The one neighbour loop. A sweep is a file that defines, before it includes this one,
//   sweep_t                                               its inputs, its own values and its sums,
//   SWEEP_PARTICLES, SWEEP_WALLS                          which of the two loops it calls,
//   add_particle(sweep_t*, p, j, rx, ry, rz, r2)          one neighbour j at (rx, ry, rz) = x_j − x, for every candidate of the cells (W and F vanish
//                                                         beyond the support, so no branch is needed, and the compiler vectorises the loop),
//   add_wall(sweep_t*, p, s, rx, ry, rz, r2)              one wall element within the support,
// and whose kernel starts the sums, calls the loop, and finishes them. Particles and elements are sorted by cell, x fastest: three cells in a row are
// one contiguous run. Cells have the support's size.
#include "cells.cl"

#ifdef SWEEP_PARTICLES
INLINE void sweep_particles(sweep_t* sums, __constant const parameters_t* p, __global const int* cell_start, __global const real* state, int stride,
                            real x, real y, real z) {
  __global const real* xs = state + FIELD_X * stride;
#if DIMENSIONS == 3
  __global const real* ys = state + FIELD_Y * stride;
#endif
  __global const real* zs = state + FIELD_Z * stride;
  const int centre = cell_index(p, x, y, z);
  const int layer = DIMENSIONS == 3 ? p->cells_x * p->cells_y : p->cells_x;
  for (int dz = -1; dz <= 1; ++dz) {
#if DIMENSIONS == 3
    for (int dy = -1; dy <= 1; ++dy) {
      const int row = centre + dz * layer + dy * p->cells_x;
#else
    {
      const int row = centre + dz * layer;
#endif
      const int end = cell_start[row + 2];
      for (int j = cell_start[row - 1]; j < end; ++j) {
        const real rx = xs[j] - x;
#if DIMENSIONS == 3
        const real ry = ys[j] - y;
#else
        const real ry = R(0.0);
#endif
        const real rz = zs[j] - z;
        add_particle(sums, p, j, rx, ry, rz, rx * rx + ry * ry + rz * rz);
      }
    }
  }
}
#endif

#ifdef SWEEP_WALLS
INLINE void sweep_walls(sweep_t* sums, __constant const parameters_t* p, __global const int* wall_start, __global const real* walls, int wall_stride,
                        real x, real y, real z) {
  const int centre = cell_index(p, x, y, z);
  const int layer = DIMENSIONS == 3 ? p->cells_x * p->cells_y : p->cells_x;
  for (int dz = -1; dz <= 1; ++dz) {
#if DIMENSIONS == 3
    for (int dy = -1; dy <= 1; ++dy) {
      const int row = centre + dz * layer + dy * p->cells_x;
#else
    {
      const int row = centre + dz * layer;
#endif
      const int end = wall_start[row + 2];
      for (int s = wall_start[row - 1]; s < end; ++s) {
        const real rx = walls[WALL_X * wall_stride + s] - x;
        const real ry = DIMENSIONS == 3 ? walls[WALL_Y * wall_stride + s] - y : R(0.0);
        const real rz = walls[WALL_Z * wall_stride + s] - z;
        const real r2 = rx * rx + ry * ry + rz * rz;
        if (r2 < p->support_squared) add_wall(sums, p, s, rx, ry, rz, r2);
      }
    }
  }
}
#endif

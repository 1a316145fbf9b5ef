// Where particles of the free surface are: 1 for each cell of the support's size that has any. The others keep what they have.
#include "cells.cl"

__kernel void mark_surface(__constant const parameters_t* p, int count, __global const real* state, long stride, __global const real* around,
                           __global int* surface_cells) {
  const int i = get_global_id(0);
  if (i >= count || around[AROUND_SURFACE * stride + i] < R(0.5)) return;
  const real y = DIMENSIONS == 3 ? state[FIELD_Y * stride + i] : R(0.0);
  atomic_or(surface_cells + cell_index(p, state[FIELD_X * stride + i], y, state[FIELD_Z * stride + i]), 1);
}

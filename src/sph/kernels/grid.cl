// The neighbour grid: a counting sort of the particles by cell, and their reordering. Within a cell they keep their order of before, so that a run
// repeats bit for bit whatever order the work-items run in.
#include "cells.cl"

__kernel void clear(int count, __global int* values) {
  const int i = get_global_id(0);
  if (i < count) values[i] = 0;
}

__kernel void count_cells(__constant const parameters_t* p, int count, __global const real* state, int stride, __global int* cell_of, __global int* counts) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const int cell = cell_index(p, state[FIELD_X * stride + i], DIMENSIONS == 3 ? state[FIELD_Y * stride + i] : R(0.0), state[FIELD_Z * stride + i]);
  cell_of[i] = cell;
  atomic_inc(&counts[cell]);
}

// Exclusive prefix sum in three launches: sums of blocks, their running totals, the values of each block.
#define SCAN_BLOCK 256

__kernel void scan_blocks(int count, __global const int* values, __global int* block_sums) {
  const int block = get_global_id(0);
  if (block * SCAN_BLOCK >= count) return;
  int sum = 0;
  for (int i = block * SCAN_BLOCK; i < min(count, (block + 1) * SCAN_BLOCK); ++i) sum += values[i];
  block_sums[block] = sum;
}

__kernel void scan_totals(int blocks, __global int* block_sums) {
  if (get_global_id(0) != 0) return;
  int sum = 0;
  for (int block = 0; block < blocks; ++block) {
    const int own = block_sums[block];
    block_sums[block] = sum;
    sum += own;
  }
}

// starts has count + 1 entries; cursors is a copy for the scatter to advance.
__kernel void scan_starts(int count, __global const int* values, __global const int* block_sums, __global int* starts, __global int* cursors) {
  const int block = get_global_id(0);
  if (block * SCAN_BLOCK >= count) return;
  int sum = block_sums[block];
  for (int i = block * SCAN_BLOCK; i < min(count, (block + 1) * SCAN_BLOCK); ++i) {
    starts[i] = sum;
    cursors[i] = sum;
    sum += values[i];
  }
  if ((block + 1) * SCAN_BLOCK >= count) starts[count] = sum;
}

__kernel void scatter(int count, __global const int* cell_of, __global int* cursors, __global int* order) {
  const int i = get_global_id(0);
  if (i < count) order[atomic_inc(&cursors[cell_of[i]])] = i;
}

// The scatter's order within a cell depends on the device's scheduling: put back to the order of before, which is nearly sorted already.
__kernel void settle_cells(int cells, __global const int* starts, __global int* order) {
  const int cell = get_global_id(0);
  if (cell >= cells) return;
  const int begin = starts[cell], end = starts[cell + 1];
  for (int i = begin + 1; i < end; ++i) {
    const int moving = order[i];
    int slot = i;
    while (slot > begin && order[slot - 1] > moving) {
      order[slot] = order[slot - 1];
      --slot;
    }
    order[slot] = moving;
  }
}

__kernel void reorder(int count, __global const int* order, __global const real* from, __global real* to, int stride, __global const uint* id_from,
                      __global uint* id_to) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const int source = order[i];
  for (int field = 0; field < FIELD_COUNT; ++field) to[field * stride + i] = from[field * stride + source];
  id_to[i] = id_from[source];
}

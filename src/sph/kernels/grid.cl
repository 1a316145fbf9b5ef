// The neighbour grid: a counting sort of the particles by slot, and their reordering. Within a slot they are ordered along x, so that a run
// repeats bit for bit whatever order the work-items run in.
#include "cells.cl"
#include "drains.cl"

// counts must be zero; the scatter leaves them so. Particles that leave the water get the slot after all others, where nothing looks for neighbours.
__kernel void count_slots(__constant const parameters_t* p, int count, __global const real* state, long stride, int slots, int drain_count,
                          __global const real* drains, __global int* slot_of, __global int* counts) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const real x = state[FIELD_X * stride + i], y = DIMENSIONS == 3 ? state[FIELD_Y * stride + i] : R(0.0), z = state[FIELD_Z * stride + i];
#ifdef PARTED
  const int place = place_in_parts(p, x, y, z);
  const bool stays = (is_between(p, place, p->halo_begin, p->halo_end) || is_astray(p, x, y, z, place)) && !drained(x, y, z, drain_count, drains);
  const int slot = state[FIELD_OWN * stride + i] == R(0.0) || !stays ? slots : slot_index(p, x, y, z);
#else
  const int slot = drained(x, y, z, drain_count, drains) ? slots : slot_index(p, x, y, z);
#endif
  slot_of[i] = slot;
  atomic_inc(&counts[slot]);
}

// Exclusive prefix sum: sums of blocks, and of groups of blocks in the same way; the groups' running totals; the values of each group, and of each block.

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

// starts has count + 1 entries.
__kernel void scan_starts(int count, __global const int* values, __global const int* block_sums, __global int* starts) {
  const int block = get_global_id(0);
  if (block * SCAN_BLOCK >= count) return;
  int sum = block_sums[block];
  for (int i = block * SCAN_BLOCK; i < min(count, (block + 1) * SCAN_BLOCK); ++i) {
    starts[i] = sum;
    sum += values[i];
  }
  if ((block + 1) * SCAN_BLOCK >= count) starts[count] = sum;
}

__kernel void scatter(int count, __global const int* slot_of, __global const int* starts, __global int* counts, __global int* order) {
  const int i = get_global_id(0);
  if (i < count) order[starts[slot_of[i]] + atomic_dec(&counts[slot_of[i]]) - 1] = i;
}

// Whether particle a goes before b in their slot: along x, so that tiles are short; of two at one place by their ids, so that the order follows from the
// particles alone, and is the same after a snapshot.
INLINE bool goes_before(__global const real* xs, __global const uint* id, int a, int b) { return xs[a] < xs[b] || (xs[a] == xs[b] && id[a] < id[b]); }

// The scatter's order within a slot depends on the device's scheduling. By insertion; of many, as there may be of those that leave, first far ones with each
// other (Shell's sort, with Ciura's gaps).
__kernel void settle_slots(int slots, __global const int* starts, __global const real* state, long stride, __global const uint* id, __global int* order) {
  const int slot = get_global_id(0);
  if (slot > slots) return;
#ifdef PARTED
  if (slot == slots) return;  // a whole halo, whose order nobody asks for
#endif
  __global const real* xs = state + FIELD_X * stride;
  const int begin = starts[slot], end = starts[slot + 1];
  const int gaps[8] = {1, 4, 10, 23, 57, 132, 301, 701};
  for (int k = end - begin > 32 ? 7 : 0; k >= 0; --k) {
    const int gap = gaps[k];
    for (int i = begin + gap; i < end; ++i) {
      const int moving = order[i];
      int place = i;
      while (place - gap >= begin && goes_before(xs, id, moving, order[place - gap])) {
        order[place] = order[place - gap];
        place -= gap;
      }
      order[place] = moving;
    }
  }
}

__kernel void reorder(int count, __global const int* order, __global const real* state, __global real* half_state, long stride, __global const uint* id,
                      __global uint* spare_id) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const int source = order[i];
  for (int field = 0; field < FIELD_COUNT; ++field) half_state[field * stride + i] = state[field * stride + source];
  spare_id[i] = id[source];
}

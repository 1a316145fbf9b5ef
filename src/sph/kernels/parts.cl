// What a part of the water does beside a step of its own: it chooses what goes to the parts beside it, tells its particles from those of others, lists its
// tiles, and copies values to and from messages. Built without fast-math.
#include "cells.cl"
#include "drains.cl"

// Own particles that the part before and the part after need at their new places, as their own or in their halos; and those that leave the water. `sent`: how
// many of each; lists begin `room` apart. Their order does not matter, since it is lost in the sort.
__kernel void choose_sent(__constant const parameters_t* p, int count, __global const real* state, long stride, int drain_count, __global const real* drains,
                          int room, __global int* sent, __global int* chosen) {
  const int i = get_global_id(0);
  if (i >= count || state[FIELD_OWN * stride + i] == R(0.0)) return;
  const real x = state[FIELD_X * stride + i], y = DIMENSIONS == 3 ? state[FIELD_Y * stride + i] : R(0.0), z = state[FIELD_Z * stride + i];
  const int place = place_in_parts(p, x, y, z);
  if (drained(x, y, z, drain_count, drains)) {
    chosen[2 * room + atomic_inc(&sent[2])] = i;
    return;
  }
  if (is_astray(p, x, y, z, place)) return;
  const bool before = p->near_begin < p->own_begin && is_between(p, place, p->near_begin, p->own_begin + p->halo_width);
  const bool after = p->near_end > p->own_end && is_between(p, place, p->own_end - p->halo_width, p->near_end);
  if (before || (after && p->part_pair)) chosen[atomic_inc(&sent[0])] = i;
  if (after && !p->part_pair) chosen[room + atomic_inc(&sent[1])] = i;
}

// What the report counts of the rates and hits: nothing of particles of others, and of those from `count` on, which have just come or never were.
__kernel void still_others(int count, int room, __global const real* state, long stride, __global real* rates, __global int* guard_hits) {
  const int i = get_global_id(0);
  if (i >= room || (i < count && state[FIELD_OWN * stride + i] != R(0.0))) return;
  for (int axis = 0; axis < 3; ++axis) rates[(RATE_U + axis) * stride + i] = R(0.0);
  rates[RATE_SHEPARD * stride + i] = R(1.0);
#ifdef RATE_FIT
  rates[RATE_FIT * stride + i] = R(0.0);
#endif
  guard_hits[i] = 0;
}

// After a sort. What left lies last, and is cleared: a tile reads a few places beyond the last particle, and nothing times what is not finite is not finite.
__kernel void tell_own(__constant const parameters_t* p, int count, int slots, __global const int* slot_start, __global real* state, __global real* half_state,
                       long stride, int stills, __global real* rates) {
  const int i = get_global_id(0);
  if (i >= count) return;
  if (stills) rates[RATE_SHEPARD * stride + i] = R(1.0);
  if (i >= slot_start[slots]) {
    for (int field = 0; field < FIELD_COUNT; ++field) state[field * stride + i] = half_state[field * stride + i] = R(0.0);
    return;
  }
  const real x = state[FIELD_X * stride + i], y = DIMENSIONS == 3 ? state[FIELD_Y * stride + i] : R(0.0), z = state[FIELD_Z * stride + i];
  const int place = place_in_parts(p, x, y, z);
  const bool own = (place >= p->own_begin && place < p->own_end) || is_astray(p, x, y, z, place);
  state[FIELD_OWN * stride + i] = own ? R(1.0) : R(0.0);
}

// Of a row's particles, where the parts are cut across rows. In a ring it may lie beyond the tank's ends.
INLINE int place_of_row(__constant const parameters_t* p, int row) {
#if DIMENSIONS == 3
  const int rows_y = PLACES_HERE(p, 1, p->rows_y);
  return p->window_begin + (p->part_axis == 1 ? row % rows_y : row / rows_y);
#else
  return p->window_begin + row;
#endif
}

// The tiles of a row: its own slots, cut into segments, each of whole tiles but for its last. In whatever order the rows come.
__kernel void list_tiles(__constant const parameters_t* p, int rows, int tile_own, int segment, __global int* starts) {
  const int row = get_global_id(0);
  if (row >= rows) return;
  int begin = 1, end = p->slots_x - 1;
  if (p->part_axis == 0) {
    begin = p->own_begin;
    end = p->own_end;
  } else {
    const int place = place_of_row(p, row);
    if (place < p->own_begin || place >= p->own_end) return;
  }
  __global int* list = starts + TILE_LIST(p);
  const int line = row * SLOTS_OF_ROW(p);
  for (int slot = begin; slot < end;) {
    const int next = min(end, 1 + ((slot - 1) / segment + 1) * segment);
    const int first = starts[line + SLOT_HERE(p, slot)], last = starts[line + SLOT_HERE(p, next - 1) + 1];
    const int tiles = (last - first + tile_own - 1) / tile_own;
    const int place = tiles > 0 ? atomic_add(&list[0], tiles) : 0;
    for (int k = 0; k < tiles; ++k) {
      list[1 + 2 * (place + k)] = first + k * tile_own;
      list[2 + 2 * (place + k)] = min(last, first + (k + 1) * tile_own);
    }
    slot = next;
  }
}

// Of a row, where the particles begin and end that the part before has in its halo, that the part after has, that come from the part before, from that after.
__kernel void find_edges(__constant const parameters_t* p, int rows, __global const int* slot_start, __global int* edges) {
  const int row = get_global_id(0);
  if (row >= rows) return;
  const int bounds[4][2] = {{p->own_begin, p->near_begin < p->own_begin ? p->own_begin + p->halo_width : p->own_begin},
                            {p->near_end > p->own_end ? p->own_end - p->halo_width : p->own_end, p->own_end},
                            {p->halo_begin, p->own_begin},
                            {p->own_end, p->halo_end}};
  const int line = row * SLOTS_OF_ROW(p);
  for (int k = 0; k < 4; ++k) {
    const int begin = bounds[k][0], end = bounds[k][1];
    int first = line, last = line;
    if (p->part_axis == 0) {
      first += SLOT_HERE(p, begin);
      last = end > begin ? line + SLOT_HERE(p, end - 1) + 1 : first;
    } else if (is_between(p, place_of_row(p, row), begin, end)) {
      last += SLOTS_OF_ROW(p);
    }
    edges[8 * row + 2 * k] = slot_start[first];
    edges[8 * row + 2 * k + 1] = slot_start[last];
  }
}

// Some components of an array of the particles of a list, to a message and back: component by component.
__kernel void pack(int items, int first, __global const int* list, int components, __global const int* places, __global const real* array, long stride,
                   __global real* message) {
  const int k = get_global_id(0);
  if (k >= items) return;
  for (int c = 0; c < components; ++c) message[c * items + k] = array[places[c] * stride + list[first + k]];
}

__kernel void unpack(int items, int first, __global const int* list, int components, __global const int* places, __global const real* message,
                     __global real* array, long stride) {
  const int k = get_global_id(0);
  if (k >= items) return;
  for (int c = 0; c < components; ++c) array[places[c] * stride + list[first + k]] = message[c * items + k];
}

__kernel void pack_ids(int items, int first, __global const int* list, __global const uint* id, __global uint* ids) {
  const int k = get_global_id(0);
  if (k < items) ids[k] = id[list[first + k]];
}

// For tests: what others' particles have until their part has sent it is not a number.
__kernel void spoil(int count, __global const real* state, long stride, int components, __global const int* places, __global real* array) {
  const int i = get_global_id(0);
  if (i >= count || state[FIELD_OWN * stride + i] != R(0.0)) return;
  for (int c = 0; c < components; ++c) array[places[c] * stride + i] = NAN;
}

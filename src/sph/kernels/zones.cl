// Water behind openings, whose velocity and pressure are given: it is in all sums, but nothing acts on it. Which particles that are follows from where they
// are alone.
#include "common.cl"

#define NO_CELL (-1)

// The zone that a place is in, if any, and of its table the place of the values there.
typedef struct {
  int zone, values;
} in_zone_t;

// A cell's number along one axis of the front: beside the outermost cells, as far as the guard may leave a particle in a wall, these count.
#define BESIDE R(0.3)
INLINE int cell_along(real at, real cells) {
  if (at < -BESIDE || at > cells + BESIDE) return NO_CELL;
  return (int)fmin(fmax(floor(at), R(0.0)), cells - R(1.0));
}

INLINE in_zone_t zone_at(int zone_count, __global const real* zones, real x, real y, real z) {
  in_zone_t found = {NO_CELL, NO_CELL};
  for (int k = 0; k < zone_count; ++k) {
    __global const real* zone = zones + k * ZONE_COUNT;
    const real dx = x - zone[ZONE_CENTRE], dy = y - zone[ZONE_CENTRE + 1], dz = z - zone[ZONE_CENTRE + 2];
    const real before = dx * zone[ZONE_NORMAL] + dy * zone[ZONE_NORMAL + 1] + dz * zone[ZONE_NORMAL + 2];
    if (!(before < R(0.0)) || before < -zone[ZONE_DEPTH]) continue;
    int cell[2];
    for (int axis = 0; axis < 2; ++axis) {
      __global const real* along = zone + (axis == 0 ? ZONE_ACROSS : ZONE_UP);
      cell[axis] = cell_along(dx * along[0] + dy * along[1] + dz * along[2] - along[3], along[4]);
    }
    if (cell[0] == NO_CELL || cell[1] == NO_CELL) continue;
    const int across = (int)zone[ZONE_ACROSS + 4], up = (int)zone[ZONE_UP + 4], layers = (int)zone[ZONE_LAYERS];
    const int layer = min((int)(-before / zone[ZONE_DEPTH] * zone[ZONE_LAYERS]), layers - 1);
    if (zone[ZONE_TABLE] >= R(0.0)) found.values = (int)zone[ZONE_TABLE] + ZONE_CELL_COUNT * ((layer * up + cell[1]) * across + cell[0]);
    if (found.values >= 0 && zones[found.values + 3] < R(0.5)) {
      found.values = NO_CELL;
      continue;
    }
    found.zone = k;
    return found;
  }
  return found;
}

INLINE in_zone_t zone_of(int zone_count, __global const real* zones, __global const real* state, long stride, int i) {
  return zone_at(zone_count, zones, state[FIELD_X * stride + i], state[FIELD_Y * stride + i], state[FIELD_Z * stride + i]);
}

// What the table gives, at the beginning of a step.
__kernel void impose_zones(__constant const parameters_t* p, int count, __global real* state, long stride, int zone_count, __global const real* zones) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const in_zone_t at = zone_of(zone_count, zones, state, stride, i);
  if (at.values < 0) return;
  __global const real* values = zones + at.values;
  __global const real* zone = zones + at.zone * ZONE_COUNT;
  real way[3];
  for (int axis = 0; axis < 3; ++axis) way[axis] = state[(FIELD_X + axis) * stride + i] - zone[ZONE_CENTRE + axis];
  for (int axis = 0; axis < 3; ++axis) {
    __global const real* turning = zone + ZONE_TURNING + 3 * axis;
    const real carried = zone[ZONE_DRIFT + axis] + (turning[0] * way[0] + turning[1] * way[1] + turning[2] * way[2]);
    state[(FIELD_U + axis) * stride + i] = values[0] * zone[ZONE_HEADING + axis] + carried;
  }
  state[FIELD_PRESSURE * stride + i] = values[1];
  state[FIELD_COMPRESSION * stride + i] = values[2];
#ifdef RATE_VOLUME
  state[FIELD_MASS * stride + i] = p->density * (R(1.0) + values[2]) * state[FIELD_VOLUME * stride + i];
#else
  state[FIELD_VOLUME * stride + i] = state[FIELD_MASS * stride + i] / (p->density * (R(1.0) + values[2]));
#endif
}

// Nothing changes there but places. (What is found of walls stays.)
__kernel void hold_zone_rates(int count, __global const real* state, long stride, __global real* rates, int zone_count, __global const real* zones) {
  const int i = get_global_id(0);
  if (i >= count || zone_of(zone_count, zones, state, stride, i).zone == NO_CELL) return;
  for (int axis = 0; axis < 3; ++axis) rates[(RATE_U + axis) * stride + i] = R(0.0);
#define HOLD(NAME) rates[RATE_##NAME * stride + i] = R(0.0);
  EACH_CONJUGATE(HOLD)
  EACH_FOLLOWER(HOLD)
}

__kernel void hold_zone_shifts(int count, __global real* state, long stride, int zone_count, __global const real* zones) {
  const int i = get_global_id(0);
  if (i >= count || zone_of(zone_count, zones, state, stride, i).zone == NO_CELL) return;
  for (int axis = 0; axis < 3; ++axis) FORGET_SHIFT(state, axis, i);
}

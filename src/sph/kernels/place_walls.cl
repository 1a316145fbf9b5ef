// Walls of owners that move: from where the case's geometry has them to where they are now.
#include "common.cl"

#define KIND_PLACE 1   // the first of three fields of a place
#define KIND_VECTOR 2  // or of a vector, which is turned alone

// slots: of the walls that are to be written; from: which of the walls at rest stands in each slot; kinds: of each field.
__kernel void place_walls(int count, int field_count, long from_field, long from_wall, __global const int* slots, __global const int* from,
                          __global const int* kinds, __global const real* poses, __global const real* rest, __global real* fields) {
  const int k = get_global_id(0);
  if (k >= count) return;
  const int slot = slots[k];
  __global const real* r = rest + from[slot] * from_wall;
  __global real* f = fields + slot * from_wall;
  __global const real* q = poses + POSE_COUNT * (int)r[WALL_OWNER * from_field];
  for (int field = 0; field < field_count;) {
    if (kinds[field] == KIND_PLACE || kinds[field] == KIND_VECTOR) {
      const real moved = kinds[field] == KIND_PLACE ? R(1.0) : R(0.0);
      const real x = r[field * from_field], y = r[(field + 1) * from_field], z = r[(field + 2) * from_field];
      for (int axis = 0; axis < 3; ++axis)
        f[(field + axis) * from_field] = q[3 * axis] * x + q[3 * axis + 1] * y + q[3 * axis + 2] * z + moved * q[9 + axis];
      field += 3;
    } else {
      f[field * from_field] = r[field * from_field];
      ++field;
    }
  }
}

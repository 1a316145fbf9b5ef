// The particles of one work-item of a kernel over the regions about owners of walls: a run of slots of a row.
typedef struct {
  int owner;
  int begin, end;
} owner_run_t;

INLINE owner_run_t run_of_owner(__constant const parameters_t* p, __global const int* slot_start, int item, int regions, __global const int* region_values) {
  int k = 0;
  while (k + 1 < regions && item >= region_values[(k + 1) * REGION_COUNT + REGION_ITEM]) ++k;
  __global const int* region = region_values + k * REGION_COUNT;
  const int in_region = item - region[REGION_ITEM];
  const int run = in_region % region[REGION_RUNS], row = in_region / region[REGION_RUNS];
  const int first_slot = region[REGION_SLOT_X] + run * region[REGION_RUN];
  const int end_slot = min(first_slot + region[REGION_RUN], region[REGION_END_X]);
  const int line = SLOTS_OF_ROW(p) * row_index(p, region[REGION_ROW_Y] + row % region[REGION_ROWS], region[REGION_ROW_Z] + row / region[REGION_ROWS]);
  const owner_run_t particles = {region[REGION_OWNER], slot_start[line + SLOT_HERE(p, first_slot)], slot_start[line + SLOT_HERE(p, end_slot - 1) + 1]};
  return particles;
}

// What an owner gets, and its moments about the owner's centre.
typedef struct {
  vector_t push, drag, push_torque, drag_torque;
} wrench_t;

INLINE vector_t plus(vector_t a, vector_t b) { return make_vector(a.x + b.x, a.y + b.y, a.z + b.z); }

INLINE void add_to_wrench(wrench_t* w, vector_t push, vector_t drag, vector_t arm) {
  w->push = plus(w->push, push);
  w->drag = plus(w->drag, drag);
  w->push_torque = plus(w->push_torque, cross3(arm, push));
  w->drag_torque = plus(w->drag_torque, cross3(arm, drag));
}

INLINE void write_wrench(const wrench_t* w, int item, __global real* wrenches) {
  const vector_t sums[4] = {w->push, w->drag, w->push_torque, w->drag_torque};
  for (int part = 0; part < 4; ++part) {
    wrenches[WRENCH_COUNT * item + 3 * part] = sums[part].x;
    wrenches[WRENCH_COUNT * item + 3 * part + 1] = sums[part].y;
    wrenches[WRENCH_COUNT * item + 3 * part + 2] = sums[part].z;
  }
}

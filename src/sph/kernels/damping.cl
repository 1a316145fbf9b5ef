// Damping zones: velocities go towards a given one, at a rate that grows with the square of the way into the zone.
#include "common.cl"
#include "damping_rate.cl"

__kernel void damp_velocities(__constant const parameters_t* p, int count, __global real* state, long stride, __global const real* time_step,
                              int damping_count, __global const real* dampings) {
  const int i = get_global_id(0);
  if (i >= count || p->damping > R(0.0)) return;  // not before the start
  for (int k = 0; k < damping_count; ++k) {
    __global const real* zone = dampings + k * DAMPING_COUNT;
    const real part = time_step[0] * damping_rate(zone, state, stride, i);
    if (part == R(0.0)) continue;
    for (int axis = 0; axis < 3; ++axis) {
      __global real* u = state + (FIELD_U + axis) * stride + i;
      *u = (*u + part * zone[DAMPING_VELOCITY + axis]) / (R(1.0) + part);
    }
  }
}

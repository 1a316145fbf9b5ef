// Advancing the state. Built without fast-math: it would delete the compensated sum of the positions.
#include "common.cl"

// Equation of state, and what the neighbour loop needs beside it.
INLINE void derive(__constant const parameters_t* p, __global real* state, int stride, int i, real compression, real mass) {
#if COLE
  const real ratio = R(1.0) + compression;
  const real cubed = ratio * ratio * ratio;
  real pressure = p->bulk_modulus / R(7.0) * (cubed * cubed * ratio - R(1.0));
#else
  real pressure = p->bulk_modulus * compression;
#endif
#if CLAMP_PRESSURE
  pressure = fmax(pressure, R(0.0));
#endif
  state[FIELD_COMPRESSION * stride + i] = compression;
  state[FIELD_PRESSURE * stride + i] = pressure;
  state[FIELD_VOLUME * stride + i] = mass / (p->density * (R(1.0) + compression));
}

INLINE bool is_lost(__global const real* state, int stride, int i) {
  bool lost = not_finite(state[FIELD_COMPRESSION * stride + i]);
  for (int axis = 0; axis < 3; ++axis) lost = lost || not_finite(state[(FIELD_X + axis) * stride + i]) || not_finite(state[(FIELD_U + axis) * stride + i]);
  return lost;
}

// A particle with a value that is not finite ends the run. Until the watchdog has seen it, it must not hide among others that it has made so too: others in
// its tile, however far, since nothing times what is not finite is not finite.
INLINE void leave_out(__global real* half_state, int stride, int i) {
  for (int axis = 0; axis < 3; ++axis) {
    half_state[(FIELD_X + axis) * stride + i] = R(0.0);
    half_state[(FIELD_U + axis) * stride + i] = R(0.0);
  }
  half_state[FIELD_PRESSURE * stride + i] = R(0.0);
  half_state[FIELD_VOLUME * stride + i] = R(0.0);
}

__kernel void derive_state(__constant const parameters_t* p, int count, __global real* state, int stride) {
  const int i = get_global_id(0);
  if (i < count) derive(p, state, stride, i, state[FIELD_COMPRESSION * stride + i], state[FIELD_MASS * stride + i]);
}

// Symplectic (drift, kick, drift): positions and compressions go half a step with what they had, velocities a whole one with the forces of the middle,
// positions and compressions the other half with the new velocities. Position and velocity, compression and velocity then advance as conjugate pairs, and
// the sound between a lone particle and a wall neither grows nor decays: the explicit midpoint rule lets it grow by (ω Δt)⁴/8 a step.
__kernel void predict(__constant const parameters_t* p, int count, __global const real* state, __global real* half_state, int stride,
                      __global const real* rates, __global const real* time_step) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const real half_step = R(0.5) * time_step[0];
  for (int axis = 0; axis < 3; ++axis) {
    const real speed = state[(FIELD_U + axis) * stride + i];
    half_state[(FIELD_X + axis) * stride + i] = state[(FIELD_X + axis) * stride + i] + half_step * speed;
    half_state[(FIELD_U + axis) * stride + i] = speed;
  }
  const real compression = state[FIELD_COMPRESSION * stride + i] + half_step * rates[RATE_COMPRESSION * stride + i];
  derive(p, half_state, stride, i, compression, state[FIELD_MASS * stride + i]);
  if (is_lost(half_state, stride, i)) leave_out(half_state, stride, i);
}

// position += displacement, with what rounding loses carried on (Kahan).
INLINE void move(__global real* state, int stride, int axis, int i, real displacement) {
  __global real* position = state + (FIELD_X + axis) * stride + i;
  __global real* rest = state + (FIELD_REST_X + axis) * stride + i;
  const real wanted = displacement - *rest;
  const real sum = *position + wanted;
  *rest = (sum - *position) - wanted;
  *position = sum;
}

// What leaves a periodic tank at one end comes in at the other. The rest of the compensated sum goes with it.
INLINE void wrap(__constant const parameters_t* p, __global real* state, int stride, int i) {
  const real period[3] = {p->period_x, p->period_y, p->period_z};
  const real lower[3] = {p->lower_x, p->lower_y, p->lower_z};
  for (int axis = 0; axis < 3; ++axis) {
    if (period[axis] == R(0.0)) continue;
    __global real* position = state + (FIELD_X + axis) * stride + i;
    const real start = lower[axis] + R(0.5) * p->spacing;  // the watchdog's box is larger by this
    if (*position < start) *position += period[axis];
    if (*position >= start + period[axis]) *position -= period[axis];
  }
}

// The kick, and the second drift of the positions; compressions wait at the middle for the continuity of the new positions and velocities.
__kernel void correct(__constant const parameters_t* p, int count, __global real* state, __global const real* half_state, int stride,
                      __global const real* rates, __global const real* time_step) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const real step = time_step[0];
  for (int axis = 0; axis < 3; ++axis) {
#if DIMENSIONS == 2
    if (axis == 1) continue;
#endif
    const real before = state[(FIELD_U + axis) * stride + i];
    const real after = (before + step * rates[(RATE_U + axis) * stride + i]) / (R(1.0) + step * p->damping);
    state[(FIELD_U + axis) * stride + i] = after;
    move(state, stride, axis, i, R(0.5) * step * (before + after));
  }
  wrap(p, state, stride, i);
  if (not_finite(half_state[FIELD_COMPRESSION * stride + i])) state[FIELD_U * stride + i] = half_state[FIELD_COMPRESSION * stride + i];  // lost in all
  derive(p, state, stride, i, half_state[FIELD_COMPRESSION * stride + i], state[FIELD_MASS * stride + i]);
}

// The second drift of the compressions, and a step of the diffusion's steady part.
__kernel void compress(__constant const parameters_t* p, int count, __global real* state, int stride, __global const real* rates,
                       __global const real* time_step) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const real compression = state[FIELD_COMPRESSION * stride + i] + R(0.5) * time_step[0] * rates[RATE_COMPRESSION * stride + i];
  state[FIELD_STEADY * stride + i] += time_step[0] * rates[RATE_STEADY * stride + i];
  derive(p, state, stride, i, compression, state[FIELD_MASS * stride + i]);
}

// One iteration of packing: the rates hold displacements.
__kernel void move_packed(__constant const parameters_t* p, int count, __global real* state, __global real* half_state, int stride,
                          __global const real* rates) {
  const int i = get_global_id(0);
  if (i >= count) return;
  for (int axis = 0; axis < 3; ++axis) {
    half_state[(FIELD_X + axis) * stride + i] = state[(FIELD_X + axis) * stride + i];  // for the guard: where it was
    half_state[(FIELD_U + axis) * stride + i] = R(0.0);
    state[(FIELD_X + axis) * stride + i] += rates[(RATE_U + axis) * stride + i];
    state[(FIELD_U + axis) * stride + i] = R(0.0);
  }
  wrap(p, state, stride, i);
}

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

__kernel void derive_state(__constant const parameters_t* p, int count, __global real* state, int stride) {
  const int i = get_global_id(0);
  if (i < count) derive(p, state, stride, i, state[FIELD_COMPRESSION * stride + i], state[FIELD_MASS * stride + i]);
}

// Symplectic, first half: everything to the middle of the step. time_step[0] is Δt.
__kernel void predict(__constant const parameters_t* p, int count, __global const real* state, __global real* half_state, int stride,
                      __global const real* rates, __global const real* time_step) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const real half_step = R(0.5) * time_step[0];
  for (int axis = 0; axis < 3; ++axis) {
    const real speed = state[(FIELD_U + axis) * stride + i];
    half_state[(FIELD_X + axis) * stride + i] = state[(FIELD_X + axis) * stride + i] + half_step * speed;
    half_state[(FIELD_U + axis) * stride + i] = speed + half_step * rates[(RATE_U + axis) * stride + i];
  }
  const real compression = state[FIELD_COMPRESSION * stride + i] + half_step * rates[RATE_COMPRESSION * stride + i];
  derive(p, half_state, stride, i, compression, state[FIELD_MASS * stride + i]);
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

// Symplectic, second half: the whole step with the rates of its middle.
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
    const real after = before + step * rates[(RATE_U + axis) * stride + i];
    state[(FIELD_U + axis) * stride + i] = after;
    move(state, stride, axis, i, R(0.5) * step * (before + after));
  }
  // ρ⁺ = ρ (2−ε)/(2+ε), ε = −Δt ρ̇/ρ of the middle; written for s = ρ/ρ₀−1, so that it keeps s's own digits
  const real middle = half_state[FIELD_COMPRESSION * stride + i];
  const real epsilon = -step * rates[RATE_COMPRESSION * stride + i] / (R(1.0) + middle);
  const real before = state[FIELD_COMPRESSION * stride + i];
  const real compression = before - (R(1.0) + before) * R(2.0) * epsilon / (R(2.0) + epsilon);
  derive(p, state, stride, i, compression, state[FIELD_MASS * stride + i]);
}

// One iteration of packing: the rates hold displacements..
__kernel void move_packed(int count, __global real* state, int stride, __global const real* rates) {
  const int i = get_global_id(0);
  if (i >= count) return;
  for (int axis = 0; axis < 3; ++axis) {
    state[(FIELD_X + axis) * stride + i] += rates[(RATE_U + axis) * stride + i];
    state[(FIELD_U + axis) * stride + i] = R(0.0);
  }
}

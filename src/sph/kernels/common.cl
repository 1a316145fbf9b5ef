// Types, the fields of the arrays, and the smoothing kernel. Every field array holds its fields one after the other, `stride` values each; facets alone have
// theirs together.
#if USE_DOUBLE
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
typedef double real;
#define R(x) x
#else
typedef float real;
#define R(x) x##f
#endif

// In a tank so long that float32 no longer tells places in it well apart, a place along its long axes (a bit each) is a field FIELD_X less its FIELD_REST_X.
#ifndef LONG_AXES
#define LONG_AXES 0
#endif
#define IS_LONG(axis) ((LONG_AXES >> (axis)) & 1)

// Always inlined: a call in the neighbour loop would keep the compiler from vectorising it.
#define INLINE static inline __attribute__((always_inline))

// From the rows of src/sph/tables.
typedef struct {
#include "parameters.cl"
} parameters_t;

// Places of the fields in the arrays of the state, of the rates of change and of sums of these; from the rows of src/sph/tables.
#include "fields.cl"

// Sizes, and places of values in other arrays.
#include "sizes.cl"

#define OWNER_MOTION(motions, owner) ((motions) + FRAME_COUNT + MOTION_COUNT * (owner))

#define NO_OWNER (-1)

// to's position = from's position + displacement, with what rounding loses carried on (Kahan).
INLINE void move_from(__global const real* from, __global real* to, long stride, int axis, int i, real displacement) {
  const long position = (FIELD_X + axis) * stride + i, rest = (FIELD_REST_X + axis) * stride + i;
  const real before = from[position];
  const real wanted = displacement - from[rest];
  const real sum = before + wanted;
  to[rest] = (sum - before) - wanted;
  to[position] = sum;
}

INLINE void move(__global real* state, long stride, int axis, int i, real displacement) { move_from(state, state, stride, axis, i, displacement); }

// With which a particle moves along an axis: the water's velocity, and what a shifting law adds for the whole of a step.
#ifdef FIELD_SHIFT_X
#define WITH_SHIFT(speed, state, axis, i) ((speed) + (state)[(FIELD_SHIFT_X + (axis)) * stride + (i)])
#define AND_SHIFT(step, state, axis, i) +(step) * (state)[(FIELD_SHIFT_X + (axis)) * stride + (i)]
#define KEEP_SHIFT(from, to, axis, i) (to)[(FIELD_SHIFT_X + (axis)) * stride + (i)] = (from)[(FIELD_SHIFT_X + (axis)) * stride + (i)]
#define FORGET_SHIFT(to, axis, i) (to)[(FIELD_SHIFT_X + (axis)) * stride + (i)] = R(0.0)
#else
#define WITH_SHIFT(speed, state, axis, i) (speed)
#define AND_SHIFT(step, state, axis, i)
#define KEEP_SHIFT(from, to, axis, i)
#define FORGET_SHIFT(to, axis, i)
#endif

// By its bits: fast-math deletes a comparison with itself.
INLINE bool not_finite(real value) {
#if USE_DOUBLE
  return (as_ulong(value) & 0x7ff0000000000000UL) == 0x7ff0000000000000UL;
#else
  return (as_uint(value) & 0x7f800000U) == 0x7f800000U;
#endif
}

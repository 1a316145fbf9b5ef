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

// walls: fields that every kind has ...
#define WALL_X 0              // the element's centre, or a point of the facet's plane
#define WALL_Y 1
#define WALL_Z 2
#define WALL_NORMAL_X 3       // out of the fluid
#define WALL_NORMAL_Y 4
#define WALL_NORMAL_Z 5
#define WALL_OWNER 6
#define WALL_THIN 7           // 1: has water on both sides, nearer than the support, and shows itself on its own side only
#define WALL_AREA 8
// ... and each kind its own from here on

// Regions of the grid about an owner of walls, in which particles may touch it; gone through in runs of slots along x.
#define REGION_RUN 32
#define REGION_OWNER 0
#define REGION_ITEM 1         // its first run among those of all regions
#define REGION_SLOT_X 2
#define REGION_ROW_Y 3
#define REGION_ROW_Z 4
#define REGION_END_X 5        // beyond its last slot
#define REGION_RUNS 6         // in a row of it
#define REGION_ROWS 7         // along y
#define REGION_COUNT 8
#define WRENCH_COUNT 12       // pressure force, viscous force, pressure torque, viscous torque

// Motions of walls. First the tank's frame, in which the fluid is solved: gravity less the acceleration of the frame's origin, angular velocity, angular
// acceleration, and the origin itself.
#define FRAME_COUNT 12
// Then, of each owner of walls: centre, velocity, angular velocity, acceleration, angular acceleration, and the velocity of a belt along the surface.
#define MOTION_COUNT 18
#define OWNER_MOTION(motions, owner) ((motions) + FRAME_COUNT + MOTION_COUNT * (owner))

// Of how many owners of walls the guard tells apart what they take from one particle.
#define GUARD_OWNERS 2
#define NO_OWNER (-1)
#define FACING_OWNERS 2       // other owners whose walls a piece of wall may face nearer than the support
#define IMPULSE_COUNT 6       // impulse, and its moment about the owner's centre

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

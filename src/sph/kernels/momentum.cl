// The accelerations.
#define BOTH_RATES 0
#include "accelerations.cl"

__kernel void momentum(__constant const parameters_t* p, int count, __global const int* slot_start, __global const real* state, long stride, real reach,
                       WALL_ARGUMENTS, __global const real* images, __global const real* gradient, __global const real* wall_loads, __global const real* film,
                       __global const int* blocks, __global real* rates) {
  TAKE_TILE(first, count)
  walls_t walls = WALLS_OF_ARGUMENTS;
  accelerate_tile(p, first, count, slot_start, state, stride, reach, &walls, images, gradient, wall_loads, film, blocks, rates);
}

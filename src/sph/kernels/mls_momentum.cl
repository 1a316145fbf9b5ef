// The accelerations, by moving least squares.
#define WITH_ACCELERATIONS 1
#define WITH_COMPRESSION 0
#include "mls_accelerations.cl"

__kernel void momentum(__constant const parameters_t* p, int count, __global const int* slot_start, __global const real* state, long stride, real reach,
                       WALL_ARGUMENTS, __global const real* images, __global const real* gradient, __global real* rates) {
  TAKE_TILE(first, count)
  walls_t walls = WALLS_OF_ARGUMENTS;
  find_rates_of_tile(p, first, count, slot_start, state, stride, reach, &walls, images, gradient, rates);
}

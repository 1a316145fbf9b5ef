// The rates of the compression and of what else evolves, by moving least squares.
#define WITH_ACCELERATIONS 0
#define WITH_COMPRESSION 1
#include "mls_accelerations.cl"

__kernel void continuity(__constant const parameters_t* p, int count, __global const int* slot_start, __global const real* state, long stride, real reach,
                       WALL_ARGUMENTS, __global const real* images, __global const real* gradient, __global real* rates) {
  TAKE_TILE(first, count)
  walls_t walls = WALLS_OF_ARGUMENTS;
  find_rates_of_tile(p, first, count, slot_start, state, stride, reach, &walls, images, gradient, rates);
}

// The fits by themselves, for rates of neighbours that need them, and where a sweep for both would have more sums than the device has registers: rows of M⁻¹ and
// how far the fit got, in the array of gradients.
#define WITH_ACCELERATIONS 0
#define WITH_COMPRESSION 0
#define FIT_IN_SWEEP 1
#define ONLY_FIT 1
#define WALL_FORCES 0
#include "mls_sums.cl"

__kernel void gradients(__constant const parameters_t* p, int count, __global const int* slot_start, __global const real* state, long stride, real reach,
                        WALL_ARGUMENTS, __global const real* images, __global real* gradient) {
  TAKE_TILE(first, count)
  walls_t walls = WALLS_OF_ARGUMENTS;
  sweep_t a = {0};
  start_sums(&a, p, first, count, state, stride, reach, &walls, gradient);
#if LOCAL_IMAGES
  planes_t planes;
  start_planes(&planes);
  for (int k = 0; k < a.near.own; ++k) find_planes(&planes, p, &walls, &a.near, first + k, k, images);
  a.planes = &planes;
#endif
  find_sums(&a, p, slot_start, images);
  fit_t fit;
  fit_of_tile(&a, p, first, &fit);
  for (int r = 0; r < ROWS; ++r)
    for (int l = 0; l < BASIS; ++l) {
      real lanes[TILE_OWN];
      own_lanes(fit.row[r][l], lanes);
      for (int k = 0; k < a.near.own; ++k) gradient[(r * BASIS + l) * stride + first + k] = lanes[k];
    }
  for (int k = 0; k < a.near.own; ++k) gradient[FIT_LEVEL * stride + first + k] = fit.level[k];
}

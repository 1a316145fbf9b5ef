// Renormalised gradients (gradient_sums.cl) by a sweep of their own, which lists the blocks of candidates that have a pair.
#define KEEPS_BLOCKS
#include "walls.cl"
#include "pair.cl"
#include "moments.cl"
#include "gradient_sums.cl"
#define SWEEP_PARTICLES
#if GRADIENTS_ASK_WALLS
#define SWEEP_WALLS
#endif

typedef struct {
  neighbours_t near;
  moments_t moments;
  gradient_sums_t gradients;
} sweep_t;

#if GRADIENTS_ASK_WALLS
typedef struct {
  const walls_t* walls;
  gradient_walls_t gradients;
} wall_sweep_t;

INLINE void add_wall(wall_sweep_t* a, __constant const parameters_t* p, int s, real x, real y, real z) {
  const contact_t c = see_wall(p, a->walls, s, x, y, z);
  add_wall_to_gradients(&a->gradients, p, &c);
}
#endif

INLINE void add_particle(sweep_t* a, __constant const parameters_t* p, int j, tile rx, tile ry, tile rz, tile r2) {
  const slope_t slope = slope_of(p, &a->near, j, rx, ry, rz, r2);
  add_to_gradients(&a->gradients, p, &a->near, &slope);
  add_to_moments(&a->moments, &slope);
}

#include "sweep.cl"

__kernel void gradients(__constant const parameters_t* p, int count, __global const int* slot_start, __global const real* state, long stride, real reach,
                        WALL_ARGUMENTS, __global const real* images, __global real* gradient, __global int* blocks) {
  TAKE_TILE(first, count)
  walls_t walls = WALLS_OF_ARGUMENTS;
  sweep_t a = {0};
  neighbours_of(&a.near, state, stride, reach, &walls, first, count);
  USE_BLOCK_LIST(a.near)
  start_gradients(&a.gradients, state, stride, first);
  sweep_particles(&a, p, slot_start, images);
  symmetric_t water[TILE_OWN];
  finish_moments(&a.moments, water);
  gradient_own_t own;
  finish_gradients(p, &a.gradients, water, &own);
  for (int k = 0; k < a.near.own; ++k) {
    const real x = a.near.places.x[k], y = a.near.places.y[k], z = a.near.places.z[k];
    gradient_walls_t by_walls;
    start_walls_of_gradients(&by_walls, p, &own, images, k, x, y, z);
#if GRADIENTS_ASK_WALLS && !GHOSTS
    wall_sweep_t b = {&walls, by_walls};
    stand_at(&walls, state, stride, first + k);
    LOOK_THROUGH(walls, a.near, k);
    sweep_walls(&b, p, &walls, images, x, y, z);
    by_walls = b.gradients;
#endif
    write_gradients(p, &own, &by_walls, k, gradient, stride, first + k);
  }
}

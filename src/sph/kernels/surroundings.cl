// Renormalised gradients, and where the water has a free surface with what a shifting law goes by, in one sweep: of a case whose law and scheme want both of the
// same state.
#define KEEPS_BLOCKS
#include "walls.cl"
#include "pair.cl"
#include "moments.cl"
#include "gradient_sums.cl"
#include "surface_sums.cl"
#define SWEEP_PARTICLES
#define SWEEP_WALLS

typedef struct {
  neighbours_t near;
  moments_t moments;
  gradient_sums_t gradients;
  surface_sums_t surface;
} sweep_t;

typedef struct {
  const walls_t* walls;
  gradient_walls_t gradients;
  surface_walls_t surface;
} wall_sweep_t;

INLINE void add_particle(sweep_t* a, __constant const parameters_t* p, int j, tile rx, tile ry, tile rz, tile r2) {
  const slope_t slope = slope_of(p, &a->near, j, rx, ry, rz, r2);
  add_to_gradients(&a->gradients, p, &a->near, &slope);
  add_to_surface(&a->surface, p, &a->near, &slope);
  add_to_moments(&a->moments, &slope);
}

INLINE void add_wall(wall_sweep_t* a, __constant const parameters_t* p, int s, real x, real y, real z) {
  const contact_t c = see_wall(p, a->walls, s, x, y, z);
  add_wall_to_gradients(&a->gradients, p, &c);
  add_wall_to_surface(&a->surface, &c);
}

#include "sweep.cl"

__kernel void surroundings(__constant const parameters_t* p, int count, __global const int* slot_start, __global const real* state, long stride, real reach,
                           WALL_ARGUMENTS, __global const real* images, __global real* gradient, __global int* blocks, __global real* around) {
  TAKE_TILE(first, count)
  walls_t walls = WALLS_OF_ARGUMENTS;
  sweep_t a = {0};
  neighbours_of(&a.near, state, stride, reach, &walls, first, count);
  USE_BLOCK_LIST(a.near)
  start_gradients(&a.gradients, state, stride, first);
  start_surface(&a.surface, state, stride, first);
  sweep_particles(&a, p, slot_start, images);
  write_sums_of_law(&a.surface, around + first, stride, a.near.own);
  symmetric_t water[TILE_OWN];
  finish_moments(&a.moments, water);
  gradient_own_t gradients_own;
  finish_gradients(p, &a.gradients, water, &gradients_own);
  surface_own_t surface_own;
  finish_surface(&a.surface, &surface_own);
  for (int k = 0; k < a.near.own; ++k) {
    const real x = a.near.places.x[k], y = a.near.places.y[k], z = a.near.places.z[k];
    wall_sweep_t b = {0};
    b.walls = &walls;
    b.surface.shepard = R(1.0);
    start_walls_of_gradients(&b.gradients, p, &gradients_own, images, k, x, y, z);
#if !GHOSTS
    stand_at(&walls, state, stride, first + k);
    LOOK_THROUGH(walls, a.near, k);
    sweep_walls(&b, p, &walls, images, x, y, z);
#endif
    write_gradients(p, &gradients_own, &b.gradients, k, gradient, stride, first + k);
    write_surface(p, &surface_own, &water[k], &b.surface, k, around, stride, first + k);
  }
}

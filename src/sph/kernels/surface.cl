// Where the water has a free surface, and what a shifting law goes by (surface_sums.cl), by a sweep of its own. Between the bounds of λ Marrone's cone test tells
// (cone.cl).
#define TAKES_BLOCKS
#include "walls.cl"
#include "pair.cl"
#include "moments.cl"
#include "surface_sums.cl"
#define SWEEP_PARTICLES
#define SWEEP_WALLS

typedef struct {
  neighbours_t near;
  moments_t moments;
  surface_sums_t surface;
} sweep_t;

typedef struct {
  const walls_t* walls;
  surface_walls_t surface;
} wall_sweep_t;

INLINE void add_particle(sweep_t* a, __constant const parameters_t* p, int j, tile rx, tile ry, tile rz, tile r2) {
  const slope_t slope = slope_of(p, &a->near, j, rx, ry, rz, r2);
  add_to_surface(&a->surface, p, &a->near, &slope);
  add_to_moments(&a->moments, &slope);
}

INLINE void add_wall(wall_sweep_t* a, __constant const parameters_t* p, int s, real x, real y, real z) {
  const contact_t c = see_wall(p, a->walls, s, x, y, z);
  add_wall_to_surface(&a->surface, &c);
}

#include "sweep.cl"

__kernel void surface_normals(__constant const parameters_t* p, int count, __global const int* slot_start, __global const real* state, long stride,
                              real reach, WALL_ARGUMENTS, __global const real* images, __global const int* blocks, __global real* around) {
  TAKE_TILE(first, count)
  walls_t walls = WALLS_OF_ARGUMENTS;
  sweep_t a = {0};
  neighbours_of(&a.near, state, stride, reach, &walls, first, count);
  USE_BLOCK_LIST(a.near)
  start_surface(&a.surface, state, stride, first);
  sweep_particles(&a, p, slot_start, images);
  write_sums_of_law(&a.surface, around + first, stride, a.near.own);
  surface_own_t own;
  finish_surface(&a.surface, &own);
  symmetric_t water[TILE_OWN];
  finish_moments(&a.moments, water);
  for (int k = 0; k < a.near.own; ++k) {
    const int i = first + k;
    wall_sweep_t b = {0};
    b.walls = &walls;
    b.surface.shepard = R(1.0);
#if !GHOSTS
    stand_at(&walls, state, stride, i);
    LOOK_THROUGH(walls, a.near, k);
    sweep_walls(&b, p, &walls, images, a.near.places.x[k], a.near.places.y[k], a.near.places.z[k]);
#endif
    write_surface(p, &own, &water[k], &b.surface, k, around, stride, i);
  }
}

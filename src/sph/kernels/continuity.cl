// The rates of the compression and of what else evolves, by the sums of continuity_sums.cl.
#define TAKES_BLOCKS
#include "walls.cl"
#include "pair.cl"
#include "equation_of_state.cl"
#include "scheme.cl"
#include "continuity_sums.cl"
#include "film.cl"
#define SWEEP_PARTICLES
#define SWEEP_WALLS

typedef struct {
  neighbours_t near;
  __global const real* gradient;
  tile u, v, w;
  scheme_own_t own;
  continuity_t continuity;
#if EXCHANGES_MASS
  tile own_shepard;
#endif
#if SHEPARD_VOLUMETRIC
  tile shepard;
#endif
} sweep_t;

typedef struct {
  const walls_t* walls;
  vector_t motion;
  real divergence, shepard;
} wall_sweep_t;

INLINE void add_particle(sweep_t* a, __constant const parameters_t* p, int j, tile rx, tile ry, tile rz, tile r2) {
  const tile volume = near_volume(&a->near, j);
  const tile distance = sqrt(r2);
  const tile slope_volume = kernel_slopes(p, distance) * volume;
  const pair_t pair = pair_of(&a->near, j, rx, ry, rz, r2, distance, slope_volume, a->u, a->v, a->w);
  const exchange_t exchange = pair_exchange(&a->own, p, &a->near, a->gradient, &pair);
#if EXCHANGES_MASS
  const tile shared = shared_shepard(&a->near, a->gradient, a->own_shepard, j);
#else
  const tile shared = (tile)(R(1.0));
#endif
  add_to_continuity(&a->continuity, p, &a->near, a->gradient, &pair, &exchange, shared);
#if SHEPARD_VOLUMETRIC
  a->shepard += kernel_values(p, distance) * volume;
#endif
}

INLINE void add_wall(wall_sweep_t* a, __constant const parameters_t* p, int s, real x, real y, real z) {
  const contact_t c = see_wall(p, a->walls, s, x, y, z);
#if SHEPARD_GEOMETRIC
  a->shepard += c.shepard;
#endif
  a->divergence += wall_divergence(a->walls, s, &c, a->motion, x, y, z);
}

#include "sweep.cl"

__kernel void continuity(__constant const parameters_t* p, int count, __global const int* slot_start, __global const real* state, long stride,
                         real reach, WALL_ARGUMENTS, __global const real* images, __global const real* film, __global const real* gradient,
                         __global const int* blocks, __global real* rates) {
  TAKE_TILE(first, count)
  walls_t walls = WALLS_OF_ARGUMENTS;
  sweep_t a = {0};
  neighbours_of(&a.near, state, stride, reach, &walls, first, count);
  USE_BLOCK_LIST(a.near)
  a.gradient = gradient;
  a.u = own_values(state + FIELD_U * stride, first);
  a.v = own_values(state + FIELD_V * stride, first);
  a.w = own_values(state + FIELD_W * stride, first);
  a.own = scheme_own(p, &a.near, gradient, first);
#if EXCHANGES_MASS
  a.own_shepard = own_values(gradient + GRADIENT_SHEPARD * stride, first);
#endif
#if DENSITY_DIFFUSION
  start_diffusion(&a.continuity.diffusion, p, &a.near, gradient, first);
#endif
  sweep_particles(&a, p, slot_start, images);
  continuity_sums_t sums;
  finish_continuity(&a.continuity, &sums);
#if SHEPARD_VOLUMETRIC
  real shepard[TILE_OWN];
  own_sums(a.shepard, shepard);
#endif
  for (int k = 0; k < TILE_OWN; ++k) {
    const int i = first + k;
    if (i >= count) return;
#if SHEPARD_VOLUMETRIC
    wall_sweep_t b = {&walls, motion_of(state, stride, i), p->slope_scale * sums.divergence[k], shepard[k]};
#else
    wall_sweep_t b = {&walls, motion_of(state, stride, i), p->slope_scale * sums.divergence[k], SHEPARD_START};
#endif
#if !GHOSTS
    stand_at(&walls, state, stride, i);
    LOOK_THROUGH(walls, a.near, k);
    sweep_walls(&b, p, &walls, images, a.near.places.x[k], a.near.places.y[k], a.near.places.z[k]);
    b.divergence = divergence_in_film(p, &walls, film, images, state[FIELD_COMPRESSION * stride + i], b.shepard, a.near.places.x[k], a.near.places.y[k],
                                      a.near.places.z[k], b.divergence);
#endif
    write_continuity(p, state, stride, i, &sums, k, b.divergence, b.shepard, rates);
  }
}

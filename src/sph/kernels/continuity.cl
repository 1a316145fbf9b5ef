// Continuity of δ-SPH, eqs (33) and (36) of the particle shifting paper, with the wall's share of the geometric Shepard paper:
//   ds/dt = −(1+s)/√γ [Σ_j (u_j−u_i)·∇W V_j + Σ_s (u_s−u_i)·n W S] + diffusion/γ,   s = ρ/ρ₀ − 1
// One pass over the neighbours, the Shepard factor γ included. The scheme (scheme/) says what a pair has for (u_j−u_i)·r, and the density diffusion
// (density_diffusion/) what it adds.
//
// The paper has 1/γ before the bracket and 1 before the diffusion. With it sound gains from every wall that it meets, and water eight rows deep rings by
// itself: the walls' part of the divergence is not the transpose of that of the pressure's gradient, (p_i + p_s) n W S, and cannot be while both are right
// for linear fields. Twice the walls' part would be it, and is calm, but the bracket then no longer vanishes where water turns along a wall: impacts get a
// quarter more. √γ and the diffusion's 1/γ leave what has no divergence as it is, and let each sound in a tank decay (docs/numerics.md).
//
// What the diffusion does steadily is taken out of it. At rest the sums of the momentum want some excess of pressure in the uppermost row; the diffusion
// would carry it downwards, the row sink and be compressed again, and so pump pressure into the whole depth.
#include "walls.cl"
#include "pair.cl"
#include "equation_of_state.cl"
#include "scheme.cl"
#include "density_diffusion.cl"
#define SWEEP_PARTICLES
#define SWEEP_WALLS

typedef struct {
  neighbours_t near;
  __global const real* gradient;
  tile u, v, w;
  scheme_own_t own;
  tile divergence;
#if EXCHANGES_MASS
  tile own_shepard, mass;
#endif
#if DENSITY_DIFFUSION
  diffusion_t diffusion;
#endif
#if SHEPARD_VOLUMETRIC
  tile shepard;
#endif
} sweep_t;

typedef struct {
  const walls_t* walls;
  real u, v, w;
  real divergence, shepard;
} wall_sweep_t;

INLINE void add_particle(sweep_t* a, __constant const parameters_t* p, int j, tile rx, tile ry, tile rz, tile r2) {
  const tile volume = near_volume(&a->near, j);
  const tile distance = sqrt(r2);
  const tile slope_volume = kernel_slopes(p, distance) * volume;
  const pair_t pair = pair_of(&a->near, j, rx, ry, rz, r2, slope_volume, a->u, a->v, a->w);
  const exchange_t exchange = pair_exchange(&a->own, p, &a->near, a->gradient, &pair);
  a->divergence += exchange.divergence * slope_volume;
#if EXCHANGES_MASS
  a->mass += exchange.mass * slope_volume * shared_shepard(&a->near, a->gradient, a->own_shepard, j);
#endif
#if SHEPARD_VOLUMETRIC
  a->shepard += kernel_values(p, distance) * volume;
#endif
#if DENSITY_DIFFUSION
  add_diffusion(&a->diffusion, p, &a->near, a->gradient, &pair);
#endif
}

INLINE void add_wall(wall_sweep_t* a, __constant const parameters_t* p, int s, real x, real y, real z) {
  const contact_t c = see_wall(p, a->walls, s, x, y, z);
#if SHEPARD_GEOMETRIC
  a->shepard += c.shepard;
#endif
  const vector_t wall = wall_velocity(a->walls, s, c.normal, x + c.distance * c.normal.x, y + c.distance * c.normal.y, z + c.distance * c.normal.z);
  a->divergence += dot3(make_vector(wall.x - a->u, wall.y - a->v, wall.z - a->w), c.normal) * c.weight;
}

#include "sweep.cl"

// Volumes follow the velocity that the particle moves with, where the scheme lets that be another than the water's.
INLINE vector_t motion_of(__global const real* state, long stride, int i) {
  vector_t own = velocity_of(state, stride, i);
#if EXCHANGES_MASS && defined(FIELD_SHIFT_X)
  own.x += state[FIELD_SHIFT_X * stride + i];
  own.y += DIMENSIONS == 3 ? state[FIELD_SHIFT_Y * stride + i] : R(0.0);
  own.z += state[FIELD_SHIFT_Z * stride + i];
#endif
  return own;
}

__kernel void continuity(__constant const parameters_t* p, int count, __global const int* slot_start, __global const real* state, long stride,
                         real reach, WALL_ARGUMENTS, __global const real* images, __global const real* gradient, __global real* rates) {
  const int first = TILE_OWN * get_global_id(0);
  if (first >= count) return;
  walls_t walls = WALLS_OF_ARGUMENTS;
  sweep_t a = {0};
  neighbours_of(&a.near, state, stride, reach, &walls, first, count);
  a.gradient = gradient;
  a.u = own_values(state + FIELD_U * stride, first);
  a.v = own_values(state + FIELD_V * stride, first);
  a.w = own_values(state + FIELD_W * stride, first);
  a.own = scheme_own(&a.near, gradient, first);
#if EXCHANGES_MASS
  a.own_shepard = own_values(gradient + GRADIENT_SHEPARD * stride, first);
#endif
#if DENSITY_DIFFUSION
  start_diffusion(&a.diffusion, p, &a.near, gradient, first);
#endif
  sweep_particles(&a, p, slot_start, images);
  real divergence[TILE_OWN];
  own_sums(a.divergence, divergence);
#if EXCHANGES_MASS
  real mass[TILE_OWN];
  own_sums(a.mass, mass);
#endif
#if DENSITY_DIFFUSION
  real diffusion[TILE_OWN];
  own_sums(a.diffusion.sum, diffusion);
#endif
#if SHEPARD_VOLUMETRIC
  real shepard[TILE_OWN];
  own_sums(a.shepard, shepard);
#endif

  for (int k = 0; k < TILE_OWN; ++k) {
    const int i = first + k;
    if (i >= count) return;
    const vector_t own = motion_of(state, stride, i);
#if SHEPARD_VOLUMETRIC
    wall_sweep_t b = {&walls, own.x, own.y, own.z, p->slope_scale * divergence[k], shepard[k]};
#else
    wall_sweep_t b = {&walls, own.x, own.y, own.z, p->slope_scale * divergence[k], SHEPARD_START};
#endif
#if !GHOSTS
    stand_at(&walls, state, stride, i);
    LOOK_THROUGH(walls, a.near, k);
    sweep_walls(&b, p, &walls, images, a.near.places.x[k], a.near.places.y[k], a.near.places.z[k]);
#endif
    const real renormalise = RENORMALISE_DIVERGENCE && DIVERGENCE_RENORMALISED ? rsqrt(bounded_shepard(b.shepard)) : R(1.0);
#if DENSITY_DIFFUSION
    const real spread = renormalise * renormalise * R(2.0) * p->density_diffusion * p->slope_scale * diffusion[k];
    const real steady = state[FIELD_STEADY * stride + i];
    rates[RATE_COMPRESSION * stride + i] = spread - steady - renormalise * (R(1.0) + state[FIELD_COMPRESSION * stride + i]) * b.divergence;
    rates[RATE_STEADY * stride + i] = p->steady_rate * (clamp(spread, -p->steady_limit, p->steady_limit) - steady);
#else
    rates[RATE_COMPRESSION * stride + i] = -renormalise * (R(1.0) + state[FIELD_COMPRESSION * stride + i]) * b.divergence;
#endif
#if EXCHANGES_MASS
    rates[RATE_COMPRESSION * stride + i] -= p->slope_scale * mass[k] / p->density;
    rates[RATE_VOLUME * stride + i] = state[FIELD_VOLUME * stride + i] * renormalise * b.divergence;
#endif
    rates[RATE_SHEPARD * stride + i] = b.shepard;
  }
}

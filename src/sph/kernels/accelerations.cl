// The accelerations of a tile by the sums of momentum_sums.cl, and what the guard asks about walls; with BOTH_RATES the other rates too. For momentum.cl and
// rates.cl.
#define WALL_FORCES 0
#if BOTH_RATES
#define TAKES_BLOCKS
#else
#define SKIPS_EMPTY_BLOCKS  // between the states whose gradients are found there is no list
#endif
#include "momentum_sums.cl"

INLINE void accelerate_tile(__constant const parameters_t* p, int first, int count, __global const int* slot_start, __global const real* state, long stride,
                            real reach, walls_t* walls, __global const real* images, __global const real* gradient, __global const real* wall_loads,
                            __global const real* film, __global const int* blocks, __global real* rates) {
  sweep_t a = {0};
  start_sums(&a, p, first, count, state, stride, reach, walls, gradient);
  USE_BLOCK_LIST(a.near)
#if NEEDS_FIT
  bool near = false;
  for (int k = 0; k < a.near.own; ++k) near = near || near_walls(p, walls, a.near.places.x[k], a.near.places.y[k], a.near.places.z[k]);
  // the fit costs as much as all else in the loop over the particles: two loops, so that the compiler leaves it out of one
  if (near) {
    sweep_particles(&a, p, slot_start, images);
  } else {
    a.fitting = false;
    sweep_particles(&a, p, slot_start, images);
  }
#else
  sweep_particles(&a, p, slot_start, images);
#endif
  pair_sums_t sums;
  finish_particles(&a, &sums);
#if BOTH_RATES
  continuity_sums_t continuity;
  finish_continuity(&a.continuity, &continuity);
#endif
  for (int k = 0; k < a.near.own; ++k) {
    const int i = first + k;
    wall_sweep_t b = {0};
    start_wall_sums(&b, p, i, state, stride, walls, wall_loads);
    take_pair_sums(&b, p, &sums, k);
#if BOTH_RATES
    b.motion = motion_of(state, stride, i);
    b.divergence = p->slope_scale * continuity.divergence[k];
#endif
#if GHOSTS
    b.clearance = R(0.0);  // the guard looks for itself
    repel(&b, p, images);
#else
    add_film(&b, p, film, images);
    stand_at(walls, state, stride, i);
    LOOK_THROUGH(*walls, a.near, k);
    sweep_walls(&b, p, walls, images, b.x, b.y, b.z);
#if BOTH_RATES
    b.divergence = divergence_in_film(p, walls, film, images, state[FIELD_COMPRESSION * stride + i], b.shepard, b.x, b.y, b.z, b.divergence);
#endif
#endif
    const real shepard = bounded_shepard(b.shepard);
    const real per_mass = R(1.0) / (shepard * b.density);
#if FRICTION_LAWS  // the viscosity is not divided by it
    b.viscous_x *= shepard;
    b.viscous_y *= shepard;
    b.viscous_z *= shepard;
#endif
    rates[RATE_U * stride + i] = (b.viscous_x - b.force_x) * per_mass + b.gravity.x;
    rates[RATE_V * stride + i] = DIMENSIONS == 3 ? (b.viscous_y - b.force_y) * per_mass + b.gravity.y : R(0.0);
    rates[RATE_W * stride + i] = (b.viscous_z - b.force_z) * per_mass + b.gravity.z;
#if CARRIES_MOMENTUM
    const real carries = p->slope_scale / b.density;
    rates[RATE_U * stride + i] -= carries * sums.carried.x[k];
    if (DIMENSIONS == 3) rates[RATE_V * stride + i] -= carries * sums.carried.y[k];
    rates[RATE_W * stride + i] -= carries * sums.carried.z[k];
#endif
    rates[RATE_CLEARANCE * stride + i] = b.clearance;
#if BOTH_RATES
    write_continuity(p, state, stride, i, &continuity, k, b.divergence, b.shepard, rates);
#endif
  }
}

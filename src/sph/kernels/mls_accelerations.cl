// The rates of a tile by the sums of mls_sums.cl, and what the guard asks about walls.
#define ONLY_FIT 0
#define WALL_FORCES 0
#define FIT_IN_SWEEP (DIMENSIONS == 2 && !ADJOINT_PRESSURE)
#include "mls_sums.cl"
#include "repulsion.cl"

INLINE void find_rates_of_tile(__constant const parameters_t* p, int first, int count, __global const int* slot_start, __global const real* state, long stride,
                               real reach, walls_t* walls, __global const real* images, __global const real* gradient, __global real* rates) {
  sweep_t a = {0};
  start_sums(&a, p, first, count, state, stride, reach, walls, gradient);
  real clearance[TILE_OWN];
  for (int k = 0; k < TILE_OWN; ++k) clearance[k] = R(0.0);  // of ghosts the guard looks for itself
#if LOCAL_IMAGES
  planes_t planes;
  start_planes(&planes);
  for (int k = 0; k < a.near.own; ++k) clearance[k] = find_planes(&planes, p, walls, &a.near, first + k, k, images);
  a.planes = &planes;
#endif
  find_sums(&a, p, slot_start, images);
  fit_t fit;
  fit_of_tile(&a, p, first, &fit);
  derivatives_t found;
  differentiate(&a, p, &fit, &found, found.divergence);
#if WITH_COMPRESSION
  continuity_sums_t sums;
#if DENSITY_DIFFUSION
  own_sums(a.diffusion.sum, sums.diffusion);
  for (int k = 0; k < TILE_OWN; ++k) sums.diffusion[k] *= p->mls_slope_scale / p->slope_scale;
#endif
#endif
  for (int k = 0; k < a.near.own; ++k) {
    const int i = first + k;
#if WITH_ACCELERATIONS
    const real x = a.near.places.x[k], y = a.near.places.y[k], z = a.near.places.z[k];
    const real density = p->density * (R(1.0) + state[FIELD_COMPRESSION * stride + i]);
    const vector_t gravity = gravity_at(p, walls, x, y, z, velocity_of(state, stride, i));
    vector_t force = make_vector(-found.force.x[k], -found.force.y[k], -found.force.z[k]);
#if GHOSTS
    add_repulsion(&force, p, images, x, y, z, density);
#else
    add_planes_repulsion(&force, p, &planes, k, density);
#endif
    rates[RATE_U * stride + i] = force.x / density + found.viscous.x[k] + gravity.x;
    rates[RATE_V * stride + i] = DIMENSIONS == 3 ? force.y / density + found.viscous.y[k] + gravity.y : R(0.0);
    rates[RATE_W * stride + i] = force.z / density + found.viscous.z[k] + gravity.z;
    rates[RATE_CLEARANCE * stride + i] = clearance[k];
#endif
#if WITH_COMPRESSION
    write_continuity(p, state, stride, i, &sums, k, found.divergence[k], R(1.0), rates);
#endif
    rates[RATE_FIT * stride + i] = fit.level[k];
  }
}

// Continuity of δ-SPH, eqs (33) and (36) of the particle shifting paper, with the wall's share of the geometric Shepard paper:
//   ds/dt = −(1+s)/γ [Σ_j (u_j−u_i)·∇W V_j + Σ_s (u_s−u_i)·n W S] + diffusion,   s = ρ/ρ₀ − 1
// One pass over the neighbours, γ included.
#include "wall_element.cl"
#define SWEEP_PARTICLES
#define SWEEP_WALLS

typedef struct {
  __global const real* state;
  int stride;
  __global const real* walls;
  int wall_stride;
#if DIFFUSION_ANTUONO
  __global const real* gradient;
  real gradient_x, gradient_y, gradient_z;
#endif
  real u, v, w, compression;
  real divergence, diffusion;
  real shepard;
} sweep_t;

INLINE void add_particle(sweep_t* a, __constant const parameters_t* p, int j, real rx, real ry, real rz, real r2) {
  __global const real* state = a->state;
  const int n = a->stride;
  const real slope_volume = kernel_slope(p, sqrt(r2)) * state[FIELD_VOLUME * n + j];
  real approach = (state[FIELD_U * n + j] - a->u) * rx + (state[FIELD_W * n + j] - a->w) * rz;
#if DIMENSIONS == 3
  approach += (state[FIELD_V * n + j] - a->v) * ry;
#endif
  a->divergence += approach * slope_volume;

#if DIFFUSION_FOURTAKAS || DIFFUSION_ANTUONO
  const real difference = state[FIELD_COMPRESSION * n + j] - a->compression;
#endif
#if DIFFUSION_FOURTAKAS
  // of the dynamic density only: what hydrostatics explains, linearised, is not diffused
  real explained = p->hydrostatic_x * rx + p->hydrostatic_z * rz;
#if DIMENSIONS == 3
  explained += p->hydrostatic_y * ry;
#endif
  a->diffusion += R(2.0) * slope_volume * (difference - explained);
#elif DIFFUSION_ANTUONO
  real explained = (a->gradient_x + a->gradient[j]) * rx + (a->gradient_z + a->gradient[2 * n + j]) * rz;
#if DIMENSIONS == 3
  explained += (a->gradient_y + a->gradient[n + j]) * ry;
#endif
  a->diffusion += slope_volume * (R(2.0) * difference - explained);
#endif
}

INLINE void add_wall(sweep_t* a, __constant const parameters_t* p, int s, real rx, real ry, real rz, real r2) {
  const wall_view_t view = view_wall(p, a->walls, a->wall_stride, s, rx, ry, rz);
  a->shepard += shepard_term(p, &view, r2);
  const real normal_speed = a->u * view.normal_x + a->v * view.normal_y + a->w * view.normal_z;
  a->divergence -= normal_speed * kernel_value(p, sqrt(r2)) * view.area;
}

#include "sweep.cl"

__kernel void continuity(__constant const parameters_t* p, int count, __global const int* cell_start, __global const real* state, int stride,
                         __global const int* wall_start, __global const real* walls, int wall_stride, __global const real* gradient,
                         __global real* rates) {
  const int i = get_global_id(0);
  if (i >= count) return;
  sweep_t a = {0};
  a.state = state;
  a.stride = stride;
  a.walls = walls;
  a.wall_stride = wall_stride;
#if DIFFUSION_ANTUONO
  a.gradient = gradient;
  a.gradient_x = gradient[i];
  a.gradient_y = DIMENSIONS == 3 ? gradient[stride + i] : R(0.0);
  a.gradient_z = gradient[2 * stride + i];
#endif
  a.u = state[FIELD_U * stride + i];
  a.v = DIMENSIONS == 3 ? state[FIELD_V * stride + i] : R(0.0);
  a.w = state[FIELD_W * stride + i];
  a.compression = state[FIELD_COMPRESSION * stride + i];
  a.shepard = R(1.0);
  const real x = state[FIELD_X * stride + i];
  const real y = DIMENSIONS == 3 ? state[FIELD_Y * stride + i] : R(0.0);
  const real z = state[FIELD_Z * stride + i];
  sweep_particles(&a, p, cell_start, state, stride, x, y, z);
  sweep_walls(&a, p, wall_start, walls, wall_stride, x, y, z);
  rates[RATE_COMPRESSION * stride + i] =
      -(R(1.0) + a.compression) * a.divergence / bounded_shepard(a.shepard) + p->density_diffusion * a.diffusion;
  rates[RATE_SHEPARD * stride + i] = a.shepard;
}

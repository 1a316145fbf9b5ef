// Packing before the start: x ← x − 0.1 h² E with the zeroth-order error E = Σ_j ∇W V_j + Σ_s n W S, walls and lid in it. Positions only; the lattice is
// not an equilibrium of the boundary integrals, and would ring the tank.
#include "wall_element.cl"
#define SWEEP_PARTICLES
#define SWEEP_WALLS

typedef struct {
  __global const real* state;
  int stride;
  __global const real* walls;
  int wall_stride;
  real error_x, error_y, error_z;
  real clearance;
} sweep_t;

INLINE void add_particle(sweep_t* a, __constant const parameters_t* p, int j, real rx, real ry, real rz, real r2) {
  const real slope_volume = kernel_slope(p, sqrt(r2)) * a->state[FIELD_VOLUME * a->stride + j];
  a->error_x += slope_volume * rx;
  a->error_z += slope_volume * rz;
#if DIMENSIONS == 3
  a->error_y += slope_volume * ry;
#endif
}

INLINE void add_wall(sweep_t* a, __constant const parameters_t* p, int s, real rx, real ry, real rz, real r2) {
  const wall_view_t view = view_wall(p, a->walls, a->wall_stride, s, rx, ry, rz);
  const real weight = kernel_value(p, sqrt(r2)) * view.area;
  a->error_x += weight * view.normal_x;
  a->error_y += weight * view.normal_y;
  a->error_z += weight * view.normal_z;
  const real clearance = wall_clearance(p, &view);
  a->clearance = clearance < a->clearance ? clearance : a->clearance;
}

#include "sweep.cl"

// The displacement of one iteration, written as rates over a unit of time; RATE_COMPRESSION holds h |E|, for the report.
__kernel void packing(__constant const parameters_t* p, int count, __global const int* cell_start, __global const real* state, int stride,
                      __global const int* wall_start, __global const real* walls, int wall_stride, __global real* rates) {
  const int i = get_global_id(0);
  if (i >= count) return;
  sweep_t a = {0};
  a.state = state;
  a.stride = stride;
  a.walls = walls;
  a.wall_stride = wall_stride;
  a.clearance = p->support;
  const real x = state[FIELD_X * stride + i];
  const real y = DIMENSIONS == 3 ? state[FIELD_Y * stride + i] : R(0.0);
  const real z = state[FIELD_Z * stride + i];
  sweep_particles(&a, p, cell_start, state, stride, x, y, z);
  sweep_walls(&a, p, wall_start, walls, wall_stride, x, y, z);
  const real size = sqrt(a.error_x * a.error_x + a.error_y * a.error_y + a.error_z * a.error_z);
  const real h = p->smoothing_length;
  // no further than a tenth of the spacing at once: on a coarse curved wall E is large at first
  const real factor = fmin(R(0.1) * h * h, R(0.1) * p->spacing / fmax(size, R(1.0e-30)));
  rates[RATE_U * stride + i] = -factor * a.error_x;
  rates[RATE_V * stride + i] = -factor * a.error_y;
  rates[RATE_W * stride + i] = -factor * a.error_z;
  rates[RATE_COMPRESSION * stride + i] = h * size;
  rates[RATE_CLEARANCE * stride + i] = a.clearance;
}

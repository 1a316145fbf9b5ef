// Packing before the start: x ← x − 0.1 h² E with the zeroth-order error E = Σ_j ∇W V_j + Σ_s n W S, walls and lid in it. Positions only; the lattice is
// not an equilibrium of the boundary integrals, and would ring the tank.
#include "walls.cl"
#define SWEEP_PARTICLES
#define SWEEP_WALLS
#define SWEEP_BRIMS

typedef struct {
  neighbours_t near;
  const walls_t* walls;
  real error_x, error_y, error_z;
  real clearance;
} sweep_t;

INLINE void add_particle(sweep_t* a, __constant const parameters_t* p, int j, real rx, real ry, real rz, real r2) {
  const real slope_volume = kernel_slope(p, sqrt(r2)) * a->near.state[FIELD_VOLUME * a->near.stride + j];
  a->error_x += slope_volume * rx;
  a->error_z += slope_volume * rz;
#if DIMENSIONS == 3
  a->error_y += slope_volume * ry;
#endif
}

INLINE void add_wall(sweep_t* a, __constant const parameters_t* p, int s, real x, real y, real z) {
  const contact_t c = see_wall(p, a->walls, s, x, y, z);
  a->error_x += c.weight * c.normal.x;
  a->error_y += c.weight * c.normal.y;
  a->error_z += c.weight * c.normal.z;
  const real clearance = wall_clearance(p, &c);
  a->clearance = clearance < a->clearance ? clearance : a->clearance;
}

#if THIN_WALLS
INLINE void add_brim(sweep_t* a, __constant const parameters_t* p, int s, real x, real y, real z) {
  const brim_view_t b = view_brim(p, a->walls, s, x, y, z);
  a->error_x += b.weight * b.normal.x;
  a->error_y += b.weight * b.normal.y;
  a->error_z += b.weight * b.normal.z;
}
#endif

#include "sweep.cl"

// The displacement of one iteration, written as rates over a unit of time; RATE_COMPRESSION holds h |E|, for the report.
__kernel void packing(__constant const parameters_t* p, int count, __global const int* cell_start, __global const real* state, int stride,
                      WALL_ARGUMENTS, __global const real* images, __global real* rates) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const walls_t walls = WALLS_OF_ARGUMENTS;
  sweep_t a = {0};
  a.near = neighbours_of(state, stride, &walls, state[FIELD_X * stride + i], DIMENSIONS == 3 ? state[FIELD_Y * stride + i] : R(0.0),
                         state[FIELD_Z * stride + i]);
  a.walls = &walls;
  a.clearance = p->support;
  sweep_particles(&a, p, cell_start, images);
  sweep_walls(&a, p, &walls, images, a.near.x, a.near.y, a.near.z);  // with ghosts: the lid and what the guard needs
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

// Packing before the start: x ← x − 0.3 h² E with the zeroth-order error E = Σ_j ∇W V_j + Σ_s n W S, walls and lid in it. Positions only; the lattice is
// not an equilibrium of the boundary integrals, and would ring the tank.
#include "walls.cl"
#include "film.cl"
#define STEP R(0.3)  // of h²: half of where the iteration still converges; with smaller steps it goes the same way, only slower
#define SWEEP_PARTICLES
#define SWEEP_WALLS

typedef struct {
  neighbours_t near;
  tile error_x, error_y, error_z;
} sweep_t;

typedef struct {
  const walls_t* walls;
  real error_x, error_y, error_z;
  real clearance;
} wall_sweep_t;

INLINE void add_particle(sweep_t* a, __constant const parameters_t* p, int j, tile rx, tile ry, tile rz, tile r2) {
  const tile slope_volume = kernel_slopes(p, sqrt(r2)) * near_volume(&a->near, j);
  a->error_x += slope_volume * rx;
  a->error_z += slope_volume * rz;
#if DIMENSIONS == 3
  a->error_y += slope_volume * ry;
#endif
}

INLINE void add_wall(wall_sweep_t* a, __constant const parameters_t* p, int s, real x, real y, real z) {
  const contact_t c = see_wall(p, a->walls, s, x, y, z);
  a->error_x += c.weight * c.normal.x;
  a->error_y += c.weight * c.normal.y;
  a->error_z += c.weight * c.normal.z;
  const real clearance = wall_clearance(p, &c);
  a->clearance = clearance < a->clearance ? clearance : a->clearance;
}

#include "sweep.cl"

// The displacement of one iteration, written as rates over a unit of time; RATE_COMPRESSION holds h |E|, for the report.
__kernel void packing(__constant const parameters_t* p, int count, __global const int* slot_start, __global const real* state, long stride, real reach,
                      WALL_ARGUMENTS, __global const real* images, __global const real* film, __global real* rates) {
  TAKE_TILE(first, count)
  walls_t walls = WALLS_OF_ARGUMENTS;
  sweep_t a = {0};
  neighbours_of(&a.near, state, stride, reach, &walls, first, count);
  sweep_particles(&a, p, slot_start, images);
  places_t error;
  own_sums(a.error_x, error.x);
  own_sums(a.error_y, error.y);
  own_sums(a.error_z, error.z);
  const real h = p->smoothing_length;
  for (int k = 0; k < a.near.own; ++k) {
    wall_sweep_t b = {&walls, p->slope_scale * error.x[k], p->slope_scale * error.y[k], p->slope_scale * error.z[k], p->support};
    stand_at(&walls, state, stride, first + k);
    LOOK_THROUGH(walls, a.near, k);
#if !GHOSTS
    const vector_t filled = film_push(p, &walls, film, images, R(1.0), R(0.0), a.near.places.x[k], a.near.places.y[k], a.near.places.z[k]);
    b.error_x += filled.x;
    b.error_y += filled.y;
    b.error_z += filled.z;
#endif
    sweep_walls(&b, p, &walls, images, a.near.places.x[k], a.near.places.y[k], a.near.places.z[k]);  // with ghosts: the lid and what the guard needs
    const real size = sqrt(b.error_x * b.error_x + b.error_y * b.error_y + b.error_z * b.error_z);
    // no further than a tenth of the spacing at once: on a coarse curved wall E is large at first
    const real factor = fmin(STEP * h * h, R(0.1) * p->spacing / fmax(size, R(1.0e-30)));
    rates[RATE_U * stride + first + k] = -factor * b.error_x;
    rates[RATE_V * stride + first + k] = -factor * b.error_y;
    rates[RATE_W * stride + first + k] = -factor * b.error_z;
    rates[RATE_COMPRESSION * stride + first + k] = h * size;
    rates[RATE_CLEARANCE * stride + first + k] = b.clearance;
  }
}

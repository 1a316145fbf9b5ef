// Momentum of δ-SPH, eqs (35, its sign corrected) and (37) of the particle shifting paper, with the wall's share of the geometric Shepard paper:
//   du/dt = −1/(γ ρ_i) [Σ_j (p_i+p_j) ∇W V_j + Σ_s (p_i+p_s) n W S − viscosity] + g
// One pass over the neighbours, γ included.
#include "wall_element.cl"
#define SWEEP_PARTICLES
#define SWEEP_WALLS

typedef struct {
  __global const real* state;
  int stride;
  __global const real* walls;
  int wall_stride;
  __global const real* wall_loads;
  real u, v, w, pressure;
  real force_x, force_y, force_z;  // Σ (p_i+p_j) ∇W V, less the viscosity along the line of centres
  real viscous_x, viscous_y, viscous_z;
  real shepard, clearance;
} sweep_t;

INLINE void add_particle(sweep_t* a, __constant const parameters_t* p, int j, real rx, real ry, real rz, real r2) {
  __global const real* state = a->state;
  const int n = a->stride;
  const real slope_volume = kernel_slope(p, sqrt(r2)) * state[FIELD_VOLUME * n + j];
  const real du = state[FIELD_U * n + j] - a->u;
  const real dw = state[FIELD_W * n + j] - a->w;
#if DIMENSIONS == 3
  const real dv = state[FIELD_V * n + j] - a->v;
  const real approach = du * rx + dv * ry + dw * rz;
#else
  const real approach = du * rx + dw * rz;
#endif
  const real inverse = R(1.0) / (r2 + R(0.01) * p->smoothing_length * p->smoothing_length);
#if VISCOSITY_MORRIS
  // isotropic for the physical viscosity (MLS paper, eq 14); the artificial one acts along the line of centres all the same
  const real shear = R(2.0) * p->viscosity * slope_volume * r2 * inverse;
  a->viscous_x += shear * du;
  a->viscous_z += shear * dw;
#if DIMENSIONS == 3
  a->viscous_y += shear * dv;
#endif
#endif
  const real central = slope_volume * (a->pressure + state[FIELD_PRESSURE * n + j] - p->pair_viscosity * approach * inverse);
  a->force_x += central * rx;
  a->force_z += central * rz;
#if DIMENSIONS == 3
  a->force_y += central * ry;
#endif
}

INLINE void add_wall(sweep_t* a, __constant const parameters_t* p, int s, real rx, real ry, real rz, real r2) {
  const wall_view_t view = view_wall(p, a->walls, a->wall_stride, s, rx, ry, rz);
  a->shepard += shepard_term(p, &view, r2);
  const real clearance = wall_clearance(p, &view);
  a->clearance = clearance < a->clearance ? clearance : a->clearance;
  const real weight = kernel_value(p, sqrt(r2)) * view.area;
  const real normal_speed = a->u * view.normal_x + a->v * view.normal_y + a->w * view.normal_z;
  const real push = (a->pressure + a->wall_loads[LOAD_PRESSURE * a->wall_stride + s]) * weight;
  a->force_x += push * view.normal_x;
  a->force_y += push * view.normal_y;
  a->force_z += push * view.normal_z;
#if NO_SLIP
  // the velocity falls to the wall's over the distance from it; nearer than half a spacing that is taken as half a spacing
  const real drag = R(2.0) * p->viscosity * weight / fmax(fabs(view.distance), R(0.5) * p->spacing);
  a->viscous_x -= drag * (a->u - normal_speed * view.normal_x);
  a->viscous_y -= drag * (a->v - normal_speed * view.normal_y);
  a->viscous_z -= drag * (a->w - normal_speed * view.normal_z);
#endif
}

#include "sweep.cl"

__kernel void momentum(__constant const parameters_t* p, int count, __global const int* cell_start, __global const real* state, int stride,
                       __global const int* wall_start, __global const real* walls, int wall_stride, __global const real* wall_loads,
                       __global real* rates) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const real x = state[FIELD_X * stride + i];
  const real y = DIMENSIONS == 3 ? state[FIELD_Y * stride + i] : R(0.0);
  const real z = state[FIELD_Z * stride + i];

  sweep_t a = {0};
  a.state = state;
  a.stride = stride;
  a.walls = walls;
  a.wall_stride = wall_stride;
  a.wall_loads = wall_loads;
  a.u = state[FIELD_U * stride + i];
  a.v = DIMENSIONS == 3 ? state[FIELD_V * stride + i] : R(0.0);
  a.w = state[FIELD_W * stride + i];
  a.pressure = state[FIELD_PRESSURE * stride + i];
  a.shepard = R(1.0);
  a.clearance = p->support;

  sweep_particles(&a, p, cell_start, state, stride, x, y, z);
  sweep_walls(&a, p, wall_start, walls, wall_stride, x, y, z);

  const real renormalise = R(1.0) / bounded_shepard(a.shepard);
  const real per_mass = renormalise / (p->density * (R(1.0) + state[FIELD_COMPRESSION * stride + i]));
  rates[RATE_U * stride + i] = (a.viscous_x - a.force_x) * per_mass + p->gravity_x;
  rates[RATE_V * stride + i] = DIMENSIONS == 3 ? (a.viscous_y - a.force_y) * per_mass + p->gravity_y : R(0.0);
  rates[RATE_W * stride + i] = (a.viscous_z - a.force_z) * per_mass + p->gravity_z;
  rates[RATE_CLEARANCE * stride + i] = a.clearance;
}

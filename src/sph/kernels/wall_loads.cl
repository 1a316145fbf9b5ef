// What the fluid does to each wall element: its pressure, zero where no fluid is near; with
// WITH_SHEAR also the shear stress μ u_t/d of the same average (only the instruments ask for it).
#include "linear_fit.cl"
#define SWEEP_PARTICLES

typedef struct {
  __global const real* state;
  int stride;
  linear_fit_t fit;
#if WITH_SHEAR
  real normal_x, normal_y, normal_z;
  real shear_x, shear_y, shear_z;
#endif
} sweep_t;

INLINE void add_particle(sweep_t* a, __constant const parameters_t* p, int j, real rx, real ry, real rz, real r2) {
  __global const real* state = a->state;
  const int n = a->stride;
  const real volume = state[FIELD_VOLUME * n + j];
  const real weight = kernel_value(p, sqrt(r2)) * volume;
  const real density = p->density * (R(1.0) + state[FIELD_COMPRESSION * n + j]);
  // r = x_j − x_s
  const real head = p->gravity_x * rx + p->gravity_y * ry + p->gravity_z * rz;
  add_to_fit(&a->fit, weight, state[FIELD_PRESSURE * n + j] - density * head, rx, ry, rz);
#if WITH_SHEAR
  const real u = state[FIELD_U * n + j], w = state[FIELD_W * n + j];
  const real v = DIMENSIONS == 3 ? state[FIELD_V * n + j] : R(0.0);
  const real distance = -(a->normal_x * rx + a->normal_y * ry + a->normal_z * rz);
  const real normal_speed = a->normal_x * u + a->normal_y * v + a->normal_z * w;
  const real rate = weight / fmax(distance, R(0.5) * p->spacing);
  a->shear_x += rate * (u - normal_speed * a->normal_x);
  a->shear_y += rate * (v - normal_speed * a->normal_y);
  a->shear_z += rate * (w - normal_speed * a->normal_z);
#endif
}

#include "sweep.cl"

// Less than this share of the full kernel sum and an element counts as dry: its average would be one droplet's.
#define DRY R(0.01)

__kernel void wall_loads(__constant const parameters_t* p, int count, __global const int* cell_start, __global const real* state, int stride,
                         __global const real* walls, int wall_stride, __global real* loads) {
  const int s = get_global_id(0);
  if (s >= count) return;
  sweep_t a = {0};
  a.state = state;
  a.stride = stride;
#if WITH_SHEAR
  a.normal_x = walls[WALL_NORMAL_X * wall_stride + s];
  a.normal_y = walls[WALL_NORMAL_Y * wall_stride + s];
  a.normal_z = walls[WALL_NORMAL_Z * wall_stride + s];
#endif
  sweep_particles(&a, p, cell_start, state, stride, walls[WALL_X * wall_stride + s], walls[WALL_Y * wall_stride + s], walls[WALL_Z * wall_stride + s]);
  const bool wet = a.fit.weight > DRY;
  loads[LOAD_PRESSURE * wall_stride + s] = wet ? fitted_pressure(p, &a.fit) : R(0.0);
#if WITH_SHEAR
  const real scale = wet ? R(1.0) / a.fit.weight : R(0.0);
  loads[LOAD_SHEAR_X * wall_stride + s] = p->viscosity * a.shear_x * scale;
  loads[LOAD_SHEAR_Y * wall_stride + s] = p->viscosity * a.shear_y * scale;
  loads[LOAD_SHEAR_Z * wall_stride + s] = p->viscosity * a.shear_z * scale;
#endif
}

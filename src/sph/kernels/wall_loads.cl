// The fluid's pressure on each wall element, zero where no fluid is near.
#include "walls.cl"
#include "linear_fit.cl"
#define SWEEP_PARTICLES

typedef struct {
  neighbours_t near;
  vector_t gravity;  // less the wall's acceleration
  linear_fit_t fit;
} sweep_t;

INLINE void add_particle(sweep_t* a, __constant const parameters_t* p, int j, real rx, real ry, real rz, real r2) {
  __global const real* state = a->near.state;
  const int n = a->near.stride;
  const real weight = kernel_value(p, sqrt(r2)) * state[FIELD_VOLUME * n + j];
  const real density = p->density * (R(1.0) + state[FIELD_COMPRESSION * n + j]);
  // r = x_j − x_s
  const real head = a->gravity.x * rx + a->gravity.y * ry + a->gravity.z * rz;
  add_to_fit(&a->fit, weight, state[FIELD_PRESSURE * n + j] - density * head, rx, ry, rz);
}

#include "sweep.cl"

// Less than this share of the full kernel sum and an element counts as dry: its average would be one droplet's.
#define DRY R(0.01)

__kernel void wall_loads(__constant const parameters_t* p, int count, __global const int* cell_start, __global const real* state, int stride,
                         WALL_ARGUMENTS, __global const real* images, __global real* loads) {
  const int s = get_global_id(0);
  if (s >= count) return;
  const walls_t walls = WALLS_OF_ARGUMENTS;
  const real x = wall_fields[WALL_X * wall_stride + s], y = wall_fields[WALL_Y * wall_stride + s], z = wall_fields[WALL_Z * wall_stride + s];
  sweep_t a = {0};
#if THIN_WALLS
  // off a thin wall, to its own side, or it would see both
  const real lift = -R(1.0e-3) * p->spacing;
  a.near = neighbours_of(state, stride, &walls, x + lift * wall_fields[WALL_NORMAL_X * wall_stride + s], y + lift * wall_fields[WALL_NORMAL_Y * wall_stride + s],
                         z + lift * wall_fields[WALL_NORMAL_Z * wall_stride + s]);
#else
  a.near = neighbours_of(state, stride, &walls, x, y, z);
#endif
  a.gravity = gravity_at_wall(p, &walls, s, x, y, z, wall_velocity(&walls, s, make_vector(R(0.0), R(0.0), R(0.0)), x, y, z));
  sweep_particles(&a, p, cell_start, images);
  const bool wet = a.fit.weight > DRY;
  loads[s] = wet ? fitted_plane(p, &a.fit, make_vector(R(0.0), R(0.0), R(0.0))).value : R(0.0);
}

// The fluid's pressure on each wall element, zero where no fluid is near. Built for tiles of one point.
#include "walls.cl"
#include "linear_fit.cl"
#define SWEEP_PARTICLES

typedef struct {
  neighbours_t near;
  vector_t gravity;  // less the wall's acceleration
  tile_fit_t fit;
} sweep_t;

INLINE void add_particle(sweep_t* a, __constant const parameters_t* p, int j, tile rx, tile ry, tile rz, tile r2) {
  const tile weight = kernel_values(p, sqrt(r2)) * near_volume(&a->near, j);
  const tile density = p->density * (R(1.0) + near_field(&a->near, FIELD_COMPRESSION, j));
  // r = x_j − x_s
  const tile head = a->gravity.x * rx + a->gravity.y * ry + a->gravity.z * rz;
  add_to_fit(&a->fit, weight, near_field(&a->near, FIELD_PRESSURE, j) - density * head, rx, ry, rz);
}

#include "sweep.cl"

// Less than this share of the full kernel sum and an element counts as dry: its average would be one droplet's.
#define DRY R(0.01)

__kernel void wall_loads(__constant const parameters_t* p, int count, __global const int* slot_start, __global const real* state, long stride, real reach,
                         WALL_ARGUMENTS, __global const real* images, __global real* loads) {
  const int s = get_global_id(0);
  if (s >= count) return;
  walls_t walls = WALLS_OF_ARGUMENTS;
  const real x = wall_fields[WALL_X * wall_stride + s], y = wall_fields[WALL_Y * wall_stride + s], z = wall_fields[WALL_Z * wall_stride + s];
  sweep_t a = {0};
#if THIN_WALLS
  // off a thin wall, to its own side, or it would see both
  const real lift = -R(1.0e-3) * p->spacing;
  neighbours_at(&a.near, state, stride, reach, &walls, x + lift * wall_fields[WALL_NORMAL_X * wall_stride + s],
                y + lift * wall_fields[WALL_NORMAL_Y * wall_stride + s], z + lift * wall_fields[WALL_NORMAL_Z * wall_stride + s]);
#else
  neighbours_at(&a.near, state, stride, reach, &walls, x, y, z);
#endif
  a.gravity = gravity_at_wall(p, &walls, s, x, y, z, wall_velocity(&walls, s, make_vector(R(0.0), R(0.0), R(0.0)), x, y, z));
  sweep_particles(&a, p, slot_start, images);
  linear_fit_t fit;
  own_fits(&a.fit, &fit);
  const bool wet = fit.weight > DRY;
  loads[s] = wet ? fitted_plane(p, &fit, make_vector(R(0.0), R(0.0), R(0.0))).value : R(0.0);
}

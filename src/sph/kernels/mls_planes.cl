// Finds the planes of mls_images.cl, by the loop of sweep.cl.
#include "repulsion.cl"

#define LEAST_SHARE R(1.0e-4)

// The planes about own particle k, which is particle i, and how near the nearest wall is, at the least.
INLINE real find_planes(planes_t* planes, __constant const parameters_t* p, walls_t* walls, const neighbours_t* near, int i, int k, __global const real* images) {
  stand_at(walls, near->state, near->stride, i);
  wall_sweep_t a = {walls, planes, k, 0, velocity_of(near->state, near->stride, i), p->support};
  sweep_walls(&a, p, walls, images, near->places.x[k], near->places.y[k], near->places.z[k]);
  for (int q = 0; q < a.count; ++q) {
    const real taken = taken_by_plane(p, planes->distance[q][k]);
    const real share = taken > R(0.0) ? clamp(planes->share[q][k] / taken, R(0.0), R(1.0)) : R(0.0);
    planes->share[q][k] = share > LEAST_SHARE ? share : R(0.0);
    if (planes->share[q][k] > R(0.0)) planes->count = max(planes->count, q + 1);
  }
  return a.clearance;
}

// Of own particle k, from the planes by their shares.
INLINE void add_planes_repulsion(vector_t* force, __constant const parameters_t* p, const planes_t* planes, int k, real density) {
  for (int q = 0; q < planes->count; ++q) {
    const real size = planes->share[q][k] * repulsion_at(p, planes->distance[q][k], density);
    force->x -= size * planes->normal_x[q][k];
    force->y -= size * planes->normal_y[q][k];
    force->z -= size * planes->normal_z[q][k];
  }
}

// Every value: a lane whose particle has fewer planes than another's takes part in the sums with no share, and nothing times what is not finite is not finite.
INLINE void start_planes(planes_t* planes) {
  const planes_t none = {0};
  *planes = none;
}

// Marrone's cone test (2010), of particles whose λ does not tell: one with a neighbour in the cone of 45° about its normal, or in the ball that closes it, is
// inside. The cone's length R/3 is that test's own, and finds holes of three spacings.
#define TAKES_BLOCKS
#include "walls.cl"
#include "around.cl"
#define SWEEP_PARTICLES

typedef struct {
  neighbours_t near;
  tile_vector_t normal;
  tile covered;
} sweep_t;

INLINE void add_particle(sweep_t* a, __constant const parameters_t* p, int j, tile rx, tile ry, tile rz, tile r2) {
  const real length = p->support / R(3.0);
  const tile one = (tile)(R(1.0));
  const tile along = tile_dot(a->normal, make_tile_vector(rx, ry, rz));
  const tile beyond = one_above(r2, (tile)(R(2.0) * length * length));
  const tile in_ball = one_above(R(2.0) * length * along, r2);
  const tile in_cone = one_above(along, (tile)(R(0.0))) * one_above(along * along, R(0.5) * r2);
  tile covered = beyond * in_ball + (one - beyond) * in_cone;
#if PARTLY_SEEN
  covered *= a->near.seen;
#endif
  a->covered = fmax(a->covered, covered);
}

#include "sweep.cl"

__kernel void surface_cone(__constant const parameters_t* p, int count, __global const int* slot_start, __global const real* state, long stride, real reach,
                           WALL_ARGUMENTS, __global const real* images, __global const int* blocks, __global real* around) {
  TAKE_TILE(first, count)
  walls_t walls = WALLS_OF_ARGUMENTS;
  sweep_t a = {0};
  neighbours_of(&a.near, state, stride, reach, &walls, first, count);
  USE_BLOCK_LIST(a.near)
  __global const real* eigenvalue = around + AROUND_EIGENVALUE * stride;
  bool unsure = false;
  for (int k = 0; k < a.near.own; ++k)
    unsure = unsure || (eigenvalue[first + k] >= EIGENVALUE_OF_SURFACE && eigenvalue[first + k] <= EIGENVALUE_INSIDE);
  real covered[TILE_OWN];
  if (unsure) {
    __global const real* normal = around + AROUND_NORMAL * stride;
    a.normal = make_tile_vector(own_values(normal, first), own_values(normal + stride, first), own_values(normal + 2 * stride, first));
    sweep_particles(&a, p, slot_start, images);
  }
  own_greatest(a.covered, covered);
  for (int k = 0; k < a.near.own; ++k) {
    const real l = eigenvalue[first + k];
    const bool open = l < EIGENVALUE_OF_SURFACE || (l <= EIGENVALUE_INSIDE && covered[k] < R(0.5));
    around[AROUND_SURFACE * stride + first + k] = open ? R(1.0) : R(0.0);
  }
}

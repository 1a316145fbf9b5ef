// How crowded the water is: Σ_j W V_j of each particle, itself included. It is 1 where particles of the volumes that their densities say fill their space,
// less beside walls and under a free surface, and more where they lie upon each other.
#include "walls.cl"
#define SWEEP_PARTICLES

typedef struct {
  neighbours_t near;
  tile filling;
} sweep_t;

INLINE void add_particle(sweep_t* a, __constant const parameters_t* p, int j, tile rx, tile ry, tile rz, tile r2) {
  a->filling += kernel_values(p, sqrt(r2)) * near_volume(&a->near, j);
}

#include "sweep.cl"

__kernel void crowding(__constant const parameters_t* p, int count, __global const int* slot_start, __global const real* state, long stride, real reach,
                       WALL_ARGUMENTS, __global const real* images, __global real* fillings) {
  TAKE_TILE(first, count)
  const walls_t walls = WALLS_OF_ARGUMENTS;
  sweep_t a = {0};
  neighbours_of(&a.near, state, stride, reach, &walls, first, count);
  sweep_particles(&a, p, slot_start, images);
  real filling[TILE_OWN];
  own_sums(a.filling, filling);
  for (int k = 0; k < a.near.own; ++k) fillings[first + k] = filling[k];
}

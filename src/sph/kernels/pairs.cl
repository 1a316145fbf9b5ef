// What the neighbour loop goes through: per particle, its true pairs, within the support, in sight and itself left out, and all of its candidates.
#include "walls.cl"
#define SWEEP_PARTICLES

typedef struct {
  neighbours_t near;
  tile within, candidates;
} sweep_t;

INLINE void add_particle(sweep_t* a, __constant const parameters_t* p, int j, tile rx, tile ry, tile rz, tile r2) {
#if THIN_WALLS
  const tile counted = fmin(a->near.seen * R(1.0e20), (tile)(R(1.0)));
#else
  const tile counted = (tile)(R(1.0));
#endif
  a->within += r2 < (tile)(p->support_squared) ? counted : (tile)(R(0.0));
  a->candidates += R(1.0);
}

#include "sweep.cl"

// counts: the pairs of each particle, and a stride on their candidates: all whose distance was found, those of a vector's lanes that go to waste among them.
__kernel void pairs(__constant const parameters_t* p, int count, __global const int* slot_start, __global const real* state, long stride, real reach,
                    WALL_ARGUMENTS, __global const real* images, __global int* counts) {
  TAKE_TILE(first, count)
  const walls_t walls = WALLS_OF_ARGUMENTS;
  sweep_t a = {0};
  neighbours_of(&a.near, state, stride, reach, &walls, first, count);
  sweep_particles(&a, p, slot_start, images);
  real within[TILE_OWN], candidates[TILE_OWN];
  own_sums(a.within, within);
  own_sums(a.candidates, candidates);
  for (int k = 0; k < a.near.own; ++k) {
    counts[first + k] = (int)within[k] - 1;  // it is its own candidate, once
    counts[stride + first + k] = (int)candidates[k];
  }
}

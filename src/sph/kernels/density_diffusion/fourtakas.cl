// Of the dynamic density only: what hydrostatics explains of a difference in compression, linearised, is not diffused ([F] of docs/numerics.md).
#include "hydrostatics.cl"
#define DENSITY_DIFFUSION 1
#define DIVERGENCE_RENORMALISED 1

typedef struct {
  tile compression;
  hydrostatics_t hydrostatics;
  tile sum;
} diffusion_t;

INLINE void start_diffusion(diffusion_t* d, __constant const parameters_t* p, const neighbours_t* n, __global const real* gradient, int first) {
  d->compression = own_values(n->state + FIELD_COMPRESSION * n->stride, first);
  d->hydrostatics = hydrostatics_of(p, n, first);
}

// Half of what is summed.
INLINE void add_diffusion(diffusion_t* d, __constant const parameters_t* p, const neighbours_t* n, __global const real* gradient, const pair_t* pair) {
  const tile difference = neighbour_compression(n, p, pair->j, pair->rx, pair->ry, pair->rz) - d->compression;
  d->sum += pair->slope_volume * (difference - explained_difference(&d->hydrostatics, pair));
}

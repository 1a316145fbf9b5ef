// With renormalised gradients ([A] of docs/numerics.md), which gradients.cl has found before.
#define DENSITY_DIFFUSION 1
// it hardly sees the slowest sound, and needs more than what √γ takes from the divergence
#define DIVERGENCE_RENORMALISED 0

typedef struct {
  tile compression;
  tile_vector_t gradient;
  tile sum;
} diffusion_t;

INLINE void start_diffusion(diffusion_t* d, __constant const parameters_t* p, const neighbours_t* n, __global const real* gradient, int first) {
  d->compression = own_values(n->state + FIELD_COMPRESSION * n->stride, first);
  d->gradient = own_gradient(n, gradient, GRADIENT_COMPRESSION, first);
}

// Half of what is summed.
INLINE void add_diffusion(diffusion_t* d, __constant const parameters_t* p, const neighbours_t* n, __global const real* gradient, const pair_t* pair) {
  const tile difference = neighbour_compression(n, p, pair->j, pair->rx, pair->ry, pair->rz) - d->compression;
  const tile_vector_t near = neighbour_gradient(n, p, gradient, pair->j);
  tile explained = (d->gradient.x + near.x) * pair->rx + (d->gradient.z + near.z) * pair->rz;
#if DIMENSIONS == 3
  explained += (d->gradient.y + near.y) * pair->ry;
#endif
  d->sum += pair->slope_volume * (difference - R(0.5) * explained);
}

// Of the dynamic density only: what hydrostatics explains of a difference in compression, linearised, is not diffused ([F] of docs/numerics.md).
#define DENSITY_DIFFUSION 1
#define DIVERGENCE_RENORMALISED 1

typedef struct {
  tile compression;
#if MOVING_FRAME
  tile_vector_t hydrostatic;  // gradient of the compression
  vector_t spin;
  real half_inverse;  // ρ/(2K)
#endif
  tile sum;
} diffusion_t;

INLINE void start_diffusion(diffusion_t* d, __constant const parameters_t* p, const neighbours_t* n, __global const real* gradient, int first) {
  d->compression = own_values(n->state + FIELD_COMPRESSION * n->stride, first);
#if MOVING_FRAME
  const real inverse = p->density / p->bulk_modulus;
  places_t hydrostatic;
  for (int k = 0; k < TILE_OWN; ++k) {
    const vector_t gravity =
        gravity_at(p, n->walls, n->places.x[k], n->places.y[k], n->places.z[k], velocity_of(n->state, n->stride, first + k));
    hydrostatic.x[k] = gravity.x * inverse;
    hydrostatic.y[k] = gravity.y * inverse;
    hydrostatic.z[k] = gravity.z * inverse;
  }
  d->hydrostatic = make_tile_vector(spread_own(hydrostatic.x), spread_own(hydrostatic.y), spread_own(hydrostatic.z));
  d->spin = motion_vector(n->walls->motions, 1);
  d->half_inverse = R(0.5) * inverse;
#endif
}

INLINE tile explained_difference(const diffusion_t* d, __constant const parameters_t* p, const pair_t* pair) {
#if MOVING_FRAME
  // by the mean of gravity at either end, so that what one gains the other loses: centrifugal and Coriolis' forces differ between them
  const tile_vector_t apart = make_tile_vector(pair->rx, pair->ry, pair->rz);
  const tile_vector_t around = tile_cross(d->spin, apart);
  const tile_vector_t carried = tile_cross(d->spin, pair->relative);
  return tile_dot(d->hydrostatic, apart) + d->half_inverse * (tile_dot(around, around) - R(2.0) * tile_dot(carried, apart));
#elif DIMENSIONS == 3
  return p->hydrostatic_x * pair->rx + p->hydrostatic_y * pair->ry + p->hydrostatic_z * pair->rz;
#else
  return p->hydrostatic_x * pair->rx + p->hydrostatic_z * pair->rz;
#endif
}

// Half of what is summed.
INLINE void add_diffusion(diffusion_t* d, __constant const parameters_t* p, const neighbours_t* n, __global const real* gradient, const pair_t* pair) {
  const tile difference = neighbour_compression(n, p, pair->j, pair->rx, pair->ry, pair->rz) - d->compression;
  d->sum += pair->slope_volume * (difference - explained_difference(d, p, pair));
}

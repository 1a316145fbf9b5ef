// What hydrostatics explains of a difference in compression between two particles, linearised, in the frame of the tank. For terms that are to leave water at
// rest alone.
#ifndef HYDROSTATICS
#define HYDROSTATICS

typedef struct {
#if MOVING_FRAME
  tile_vector_t gradient;  // of the compression, at the tile's particles
  vector_t spin;
  real half_inverse;  // ρ/(2K)
#else
  vector_t gradient;
#endif
} hydrostatics_t;

INLINE hydrostatics_t hydrostatics_of(__constant const parameters_t* p, const neighbours_t* n, int first) {
  hydrostatics_t h;
#if MOVING_FRAME
  const real inverse = p->density / p->bulk_modulus;
  places_t gradient;
  for (int k = 0; k < TILE_OWN; ++k) {
    const vector_t gravity =
        gravity_at(p, n->walls, n->places.x[k], n->places.y[k], n->places.z[k], velocity_of(n->state, n->stride, first + k));
    gradient.x[k] = gravity.x * inverse;
    gradient.y[k] = gravity.y * inverse;
    gradient.z[k] = gravity.z * inverse;
  }
  h.gradient = make_tile_vector(spread_own(gradient.x), spread_own(gradient.y), spread_own(gradient.z));
  h.spin = motion_vector(n->walls->motions, 1);
  h.half_inverse = R(0.5) * inverse;
#else
  h.gradient = make_vector(p->hydrostatic_x, p->hydrostatic_y, p->hydrostatic_z);
#endif
  return h;
}

INLINE tile explained_difference(const hydrostatics_t* h, const pair_t* pair) {
#if MOVING_FRAME
  // by the mean of gravity at either end, so that what one gains the other loses: centrifugal and Coriolis' forces differ between them
  const tile_vector_t apart = make_tile_vector(pair->rx, pair->ry, pair->rz);
  const tile_vector_t around = tile_cross(h->spin, apart);
  const tile_vector_t carried = tile_cross(h->spin, pair->relative);
  return tile_dot(h->gradient, apart) + h->half_inverse * (tile_dot(around, around) - R(2.0) * tile_dot(carried, apart));
#elif DIMENSIONS == 3
  return h->gradient.x * pair->rx + h->gradient.y * pair->ry + h->gradient.z * pair->rz;
#else
  return h->gradient.x * pair->rx + h->gradient.z * pair->rz;
#endif
}
#endif

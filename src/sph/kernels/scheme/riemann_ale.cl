// Vila's scheme, eqs (24)–(27) of the particle shifting paper, gravity added: particles move with u⁰ = u + δu, which need not be the water's velocity, and
// exchange the mass and the momentum that cross the middle between them, by their Riemann problem. Volumes evolve by the divergence of u⁰.
#include "riemann.cl"
#define EXCHANGES_MASS 1

typedef struct {
  tile pressure, divergence;
  tile mass;             // 2 ρ_E (u_E − u⁰_ij)·(x_j − x_i): what is summed over F V, less, is the gain of density at a given volume
  tile_vector_t carried;  // u_E − u_i: what that mass brings beyond the particle's own velocity
} exchange_t;

#ifdef FIELD_SHIFT_X
INLINE tile_vector_t shift_of(const neighbours_t* n, int j) {
  const tile_vector_t shift = make_tile_vector(near_field(n, FIELD_SHIFT_X, j), DIMENSIONS == 3 ? near_field(n, FIELD_SHIFT_Y, j) : (tile)(R(0.0)),
                                               near_field(n, FIELD_SHIFT_Z, j));
#if GHOSTS
  if (n->mirrored) return turned(n->image + IMAGE_MATRIX, shift.x, shift.y, shift.z);
#endif
  return shift;
}
#endif

// A component of u_l − u_i or, from the other side, of u_r − u_i.
INLINE tile side_of_middle(__constant const parameters_t* p, tile from_own, tile own_change, tile near_change, tile difference) {
  const limits_t most = limits_of(p->limiter * difference);
  const tile left = R(0.5) * minmod(&most, own_change), right = difference - R(0.5) * minmod(&most, near_change);
  return right + from_own * (left - right);
}

INLINE exchange_t pair_exchange(const scheme_own_t* own, __constant const parameters_t* p, const neighbours_t* n, __global const real* gradient,
                                const pair_t* pair) {
  const star_t star = riemann_of(own, p, n, gradient, pair);
  const tile_vector_t way = make_tile_vector(pair->rx, pair->ry, pair->rz);
  tile middle = R(0.5) * pair->approach, apart = pair->approach;  // (u⁰_ij − u_i)·r, (u⁰_j − u⁰_i)·r
#ifdef FIELD_SHIFT_X
  const tile own_shift = tile_dot(own->shift, way), near_shift = tile_dot(shift_of(n, pair->j), way);
  middle += R(0.5) * (own_shift + near_shift);
  apart += near_shift - own_shift;
#endif
  const tile density = p->density * (R(1.0) + fluid_compression(p, star.pressure));
  const tile crossing = star.advance - middle;
  // the mass comes from the side that the middle leaves behind, with its velocity across the line of centres
  const tile from_own = one_above(crossing, (tile)(R(0.0)));
  const tile_vector_t far_change = neighbour_velocity_change(n, gradient, pair->j, pair->rx, pair->ry, pair->rz);
  const tile ux = side_of_middle(p, from_own, tile_dot(own->slope_u, way), far_change.x, pair->relative.x);
#if DIMENSIONS == 3
  const tile uy = side_of_middle(p, from_own, tile_dot(own->slope_v, way), far_change.y, pair->relative.y);
#else
  const tile uy = (tile)(R(0.0));
#endif
  const tile uz = side_of_middle(p, from_own, tile_dot(own->slope_w, way), far_change.z, pair->relative.z);
  const tile inverse = R(1.0) / (pair->r2 + R(1.0e-12) * p->smoothing_length * p->smoothing_length);
  const tile along = (star.advance - tile_dot(way, make_tile_vector(ux, uy, uz))) * inverse;
  exchange_t exchange;
  exchange.pressure = R(2.0) * star.pressure;
  exchange.divergence = apart;
  exchange.mass = R(2.0) * density * crossing;
  exchange.carried = make_tile_vector(ux + along * way.x, uy + along * way.y, uz + along * way.z);
  return exchange;
}

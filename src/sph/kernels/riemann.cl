// The Riemann problem between a particle (left) and its neighbour (right) along the line between them, acoustic, with values at the midpoint by MUSCL: each
// side's own renormalised gradient, limited by minmod against the difference of the two. Linear fields have no jump, so hydrostatics is free of dissipation.
// For schemes; [S] of docs/numerics.md leaves the solver and the limiter's arguments open.
EQUATION_OF_STATE(tile, fluid)

typedef struct {
  tile compression;
  tile_vector_t velocity;
  tile_vector_t slope, slope_u, slope_v, slope_w;  // gradients
#ifdef FIELD_SHIFT_X
  tile_vector_t shift;  // δu
#endif
} scheme_own_t;

INLINE scheme_own_t scheme_own(const neighbours_t* n, __global const real* gradient, int first) {
  scheme_own_t own;
  own.compression = own_values(n->state + FIELD_COMPRESSION * n->stride, first);
  own.velocity = make_tile_vector(own_values(n->state + FIELD_U * n->stride, first),
                                  DIMENSIONS == 3 ? own_values(n->state + FIELD_V * n->stride, first) : (tile)(R(0.0)),
                                  own_values(n->state + FIELD_W * n->stride, first));
  own.slope = own_gradient(n, gradient, GRADIENT_COMPRESSION, first);
  own.slope_u = own_gradient(n, gradient, GRADIENT_U, first);
  own.slope_v = own_gradient(n, gradient, GRADIENT_U + 3, first);
  own.slope_w = own_gradient(n, gradient, GRADIENT_U + 6, first);
#ifdef FIELD_SHIFT_X
  own.shift = make_tile_vector(own_values(n->state + FIELD_SHIFT_X * n->stride, first),
                               DIMENSIONS == 3 ? own_values(n->state + FIELD_SHIFT_Y * n->stride, first) : (tile)(R(0.0)),
                               own_values(n->state + FIELD_SHIFT_Z * n->stride, first));
#endif
  return own;
}

// The smaller in size of two of one sign, else 0.
INLINE tile minmod(tile a, tile b) { return fmax(fmin(a, b), R(0.0)) + fmin(fmax(a, b), R(0.0)); }

// Velocities are relative to the particle's own u_i, and times r = |x_j − x_i| where they are along e: differences alone matter, and what is far away has
// no direction.
typedef struct {
  tile pressure;       // p*
  tile advance;        // (u* − u_i)·(x_j − x_i)
  tile left, right;    // (u_l − u_i)·(x_j − x_i), likewise of the right
  tile_vector_t u_left, u_right;  // u_l − u_i, u_r − u_i
} star_t;

INLINE star_t riemann_of(const scheme_own_t* own, __constant const parameters_t* p, const neighbours_t* n, __global const real* gradient,
                         const pair_t* pair) {
  const tile_vector_t way = make_tile_vector(pair->rx, pair->ry, pair->rz);
  const tile near = neighbour_compression(n, p, pair->j, pair->rx, pair->ry, pair->rz);
  const tile difference = near - own->compression;
  const tile s_left = own->compression + R(0.5) * minmod(tile_dot(own->slope, way), difference);
  const tile s_right = near - R(0.5) * minmod(tile_dot(neighbour_gradient(n, gradient, GRADIENT_COMPRESSION, pair->j), way), difference);
  const tile_vector_t change = neighbour_velocity_change(n, gradient, pair->j, pair->rx, pair->ry, pair->rz);
  const tile_vector_t d = pair->relative;
  star_t star;
  star.u_left = make_tile_vector(R(0.5) * minmod(tile_dot(own->slope_u, way), d.x),
                                 DIMENSIONS == 3 ? R(0.5) * minmod(tile_dot(own->slope_v, way), d.y) : (tile)(R(0.0)),
                                 R(0.5) * minmod(tile_dot(own->slope_w, way), d.z));
  star.u_right = make_tile_vector(d.x - R(0.5) * minmod(change.x, d.x), DIMENSIONS == 3 ? d.y - R(0.5) * minmod(change.y, d.y) : (tile)(R(0.0)),
                                  d.z - R(0.5) * minmod(change.z, d.z));
  star.left = tile_dot(star.u_left, way);
  star.right = tile_dot(star.u_right, way);
  tile p_left = fluid_pressure(p, s_left), p_right = fluid_pressure(p, s_right);
#if CLAMP_PRESSURE
  p_left = fmax(p_left, R(0.0));
  p_right = fmax(p_right, R(0.0));
#endif
  const tile z_left = fluid_impedance(p, s_left), z_right = fluid_impedance(p, s_right);
  const tile inverse = R(1.0) / (z_left + z_right);
  // along e, velocities are those products over r; at r = 0 there is no pair
  const tile distance = sqrt(pair->r2 + R(1.0e-12) * p->smoothing_length * p->smoothing_length);
  star.pressure = inverse * (z_right * p_left + z_left * p_right + z_left * z_right * (star.left - star.right) / distance);
  star.advance = inverse * (z_left * star.left + z_right * star.right + distance * (p_left - p_right));
  return star;
}

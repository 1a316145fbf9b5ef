// The Riemann problem between a particle (left) and its neighbour (right) along the line between them, acoustic, with values at the midpoint by MUSCL: each
// side's own renormalised gradient, limited by minmod against θ times the difference of the two, θ from 1 to 2. Of velocities what is along that line is reconstructed and limited,
// whatever the axes are. Linear fields have no jump. Of compressions what hydrostatics explains is not limited: in disordered water at rest the limiter would
// take of each difference more often than add to it, and so carry compression upwards and sink the water. For schemes; [S] of docs/numerics.md leaves the
// solver and the limiter's arguments open.
#include "hydrostatics.cl"

EQUATION_OF_STATE(tile, fluid)

typedef struct {
  tile compression;
#if ACOUSTIC_DAMPER
  tile pressure;  // with the acoustic damper's
#endif
  tile_vector_t slope;  // its gradient
  hydrostatics_t hydrostatics;
#if GRADIENT_OF_VELOCITY
  tile_vector_t slope_u, slope_v, slope_w;
#else
  strain_t strain;
#endif
#ifdef FIELD_SHIFT_X
  tile_vector_t shift;  // δu
#endif
} scheme_own_t;

#if ACOUSTIC_DAMPER
// Of the pressure, what the equation of state does not explain: the acoustic damper's.
INLINE tile damper_of(__constant const parameters_t* p, tile pressure, tile compression) {
  const tile stated = fluid_pressure(p, compression);
  return pressure - (CLAMP_PRESSURE ? fmax(stated, R(0.0)) : stated);
}
#endif

INLINE scheme_own_t scheme_own(__constant const parameters_t* p, const neighbours_t* n, __global const real* gradient, int first) {
  scheme_own_t own;
  own.compression = own_values(n->state + FIELD_COMPRESSION * n->stride, first);
#if ACOUSTIC_DAMPER
  own.pressure = own_values(n->state + FIELD_PRESSURE * n->stride, first);
#endif
  own.slope = own_gradient(n, gradient, GRADIENT_COMPRESSION, first);
  own.hydrostatics = hydrostatics_of(p, n, first);
#if GRADIENT_OF_VELOCITY
  own.slope_u = own_gradient(n, gradient, GRADIENT_U, first);
  own.slope_v = own_gradient(n, gradient, GRADIENT_U + 3, first);
  own.slope_w = own_gradient(n, gradient, GRADIENT_U + 6, first);
#else
  own.strain = own_strain(n, gradient, first);
#endif
#ifdef FIELD_SHIFT_X
  own.shift = make_tile_vector(own_values(n->state + FIELD_SHIFT_X * n->stride, first),
                               DIMENSIONS == 3 ? own_values(n->state + FIELD_SHIFT_Y * n->stride, first) : (tile)(R(0.0)),
                               own_values(n->state + FIELD_SHIFT_Z * n->stride, first));
#endif
  return own;
}

// The smaller in size of two of one sign, else 0: the first, no farther from 0 than the second is, and on its side of it. Both sides of a pair are limited by
// the same second one, whose bounds are found once.
typedef struct {
  tile least, most;
} limits_t;

INLINE limits_t limits_of(tile difference) {
  const tile none = (tile)(R(0.0));
  const limits_t limits = {fmin(difference, none), fmax(difference, none)};
  return limits;
}

INLINE tile minmod(const limits_t* limits, tile change) { return fmin(fmax(change, limits->least), limits->most); }

// What u changes by over the way r from a particle, times r: r·(r·∇)u.
INLINE tile own_stretch(const scheme_own_t* own, const pair_t* pair) {
#if GRADIENT_OF_VELOCITY
  const tile_vector_t way = make_tile_vector(pair->rx, pair->ry, pair->rz);
  return tile_dot(way, make_tile_vector(tile_dot(own->slope_u, way), DIMENSIONS == 3 ? tile_dot(own->slope_v, way) : (tile)(R(0.0)),
                                        tile_dot(own->slope_w, way)));
#else
  return stretch_of(&own->strain, pair->rx, pair->ry, pair->rz);
#endif
}

INLINE tile neighbour_stretch(const neighbours_t* n, __global const real* gradient, const pair_t* pair) {
#if GRADIENT_OF_VELOCITY
  const tile_vector_t change = neighbour_velocity_change(n, gradient, pair->j, pair->rx, pair->ry, pair->rz);
  return tile_dot(make_tile_vector(pair->rx, pair->ry, pair->rz), change);
#else
  const strain_t strain = near_strain(n, gradient, pair->j);
#if GHOSTS
  if (n->mirrored) {
    const vector_t way = turned(n->image + IMAGE_MATRIX, pair->rx, pair->ry, pair->rz);  // of what it mirrors: a reflection is its own inverse
    return stretch_of(&strain, way.x, way.y, way.z);
  }
#endif
  return stretch_of(&strain, pair->rx, pair->ry, pair->rz);
#endif
}

// Velocities are relative to the particle's own u_i, along e, and times r = |x_j − x_i|: differences alone matter, and what is far away has no direction.
typedef struct {
  tile pressure;     // p*
  tile advance;      // (u* − u_i)·(x_j − x_i)
  tile left, right;  // (u_l − u_i)·(x_j − x_i), likewise of the right
} star_t;

INLINE star_t riemann_of(const scheme_own_t* own, __constant const parameters_t* p, const neighbours_t* n, __global const real* gradient,
                         const pair_t* pair) {
  const tile near = neighbour_compression(n, p, pair->j, pair->rx, pair->ry, pair->rz);
  const tile difference = near - own->compression;
  const tile_vector_t slope = neighbour_gradient(n, p, gradient, pair->j);
  tile own_change = own->slope.x * pair->rx + own->slope.z * pair->rz, near_change = slope.x * pair->rx + slope.z * pair->rz;
#if DIMENSIONS == 3
  own_change += own->slope.y * pair->ry;
  near_change += slope.y * pair->ry;
#endif
  const tile explained = explained_difference(&own->hydrostatics, pair);
  const limits_t most = limits_of(p->limiter * (difference - explained)), most_approach = limits_of(p->limiter * pair->approach);
  const tile s_left = own->compression + R(0.5) * (explained + minmod(&most, own_change - explained));
  const tile s_right = near - R(0.5) * (explained + minmod(&most, near_change - explained));
  star_t star;
  star.left = R(0.5) * minmod(&most_approach, own_stretch(own, pair));
  star.right = pair->approach - R(0.5) * minmod(&most_approach, neighbour_stretch(n, gradient, pair));
  tile p_left = fluid_pressure(p, s_left), p_right = fluid_pressure(p, s_right);
#if ACOUSTIC_DAMPER
  p_left += damper_of(p, own->pressure, own->compression);
  p_right += damper_of(p, near_field(n, FIELD_PRESSURE, pair->j), near_field(n, FIELD_COMPRESSION, pair->j));
#endif
#if CLAMP_PRESSURE
  p_left = fmax(p_left, R(0.0));
  p_right = fmax(p_right, R(0.0));
#endif
  const tile z_left = fluid_impedance(p, s_left), z_right = fluid_impedance(p, s_right);
  // along e, velocities are those products over r; at r = 0 there is no pair
  const tile sum = z_left + z_right;
  const tile least = (tile)(R(1.0e-6) * p->smoothing_length);
  const tile distance = pair->distance > least ? pair->distance : least;  // fmax of two that are not known before takes five instructions
  star.pressure = (distance * (z_right * p_left + z_left * p_right) + z_left * z_right * (star.left - star.right)) / (distance * sum);
  star.advance = (z_left * star.left + z_right * star.right + pair->distance * (p_left - p_right)) / sum;
  return star;
}

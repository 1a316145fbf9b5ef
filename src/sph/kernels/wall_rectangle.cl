// Numerical wall elements ([C] B.2): rectangles (2-D: segments) of about the spacing, whose integrals are midpoint rules, except for the singular part
// of Φ, whose integral is the angle that the rectangle subtends.

#if DIMENSIONS == 3
// Solid angle between the foot point and the corner (a, b) of a rectangle at distance d ≥ 0, signed by a and b ([C] of docs/numerics.md, B.2). As an
// arctangent of a quotient it needs no case distinction, keeps its precision for small elements, and tends to ±π/2 on the plane.
INLINE turn_t corner_turn(real d, real a, real b) {
  const turn_t turn = {d * sqrt(d * d + a * a + b * b), a * b};
  return turn;
}

INLINE turn_t turned_back(turn_t turn) {
  turn.sine = -turn.sine;
  return turn;
}
#endif

// Farther than three sides from an element Φ is as smooth as its polynomial part; in squares of the half diagonal.
#if DIMENSIONS == 3
#define FAR_ELEMENT R(18.0)
#else
#define FAR_ELEMENT R(36.0)
#endif

// The element's term of γ(x) = 1 + Σ_s ∫ n·(y−x) Φ dS ([C] eqs 8–12 with signs corrected): the polynomial part of Φ by the midpoint rule with its
// second-order term (the squared sides/24 of the tangential second derivatives), without which walls at right angles miss γ by more than 2e-3; the
// divergent part exactly, through the angle that the element subtends, unless the element is far.
INLINE real rectangle_shepard(__constant const parameters_t* p, real distance, bool over, real along, real across, real half_along, real half_across,
                              real area, real r2) {
#if SHEPARD_MONOLITHIC
  return distance * area * whole_value(p, r2);
#else
  const bool far = r2 > FAR_ELEMENT * (half_along * half_along + half_across * half_across);
  const real inverse2 = p->inverse_smoothing * p->inverse_smoothing;
  const real along2 = along * along * inverse2, across2 = across * across * inverse2;
  const real length2 = R(0.166666666667) * half_along * half_along * inverse2;  // side²/24 in units of h
  const real width2 = R(0.166666666667) * half_across * half_across * inverse2;
  potential_t f;
  if (far)
    f = whole_potential(p, r2);
  else
    f = potential_polynomial(p, r2);
  const real mean = f.scale * (f.value + (length2 + width2) * f.slope + (length2 * along2 + width2 * across2) * f.bend) * area;
  if (far) return distance * mean;
  const bool near_behind = over && distance > -BEHIND_TOLERANCE * p->spacing;
  const real side = side_of(p, distance, over);
  const real d = fmax(fabs(distance), LEAST_DISTANCE * p->spacing);
  const real height = near_behind ? fabs(distance) : distance;
  const real a0 = along - half_along, a1 = along + half_along;
#if DIMENSIONS == 3
  const real b0 = across - half_across, b1 = across + half_across;
  const real angle = angle_of(added(corner_turn(d, a1, b1), turned_back(corner_turn(d, a0, b1)))) +
                     angle_of(added(corner_turn(d, a0, b0), turned_back(corner_turn(d, a1, b0))));
  return height * mean - R(0.0795774715459) * side * angle;
#else
  const turn_t turn = {d * d + a0 * a1, d * (a1 - a0)};
  return height * mean - R(0.159154943092) * side * angle_of(turn);
#endif
#endif
}

INLINE contact_t touch_wall(__constant const parameters_t* p, const walls_t* walls, int s, real x, real y, real z) {
  __global const real* fields = walls->fields;
  const long n = walls->wall_stride;
  const real rx = wall_way(walls, 0, fields[WALL_X * n + s], x), rz = wall_way(walls, 2, fields[WALL_Z * n + s], z);
  const real ry = DIMENSIONS == 3 ? wall_way(walls, 1, fields[WALL_Y * n + s], y) : R(0.0);
  const real r2 = rx * rx + ry * ry + rz * rz;
  contact_t c;
  c.normal = make_vector(fields[WALL_NORMAL_X * n + s], DIMENSIONS == 3 ? fields[WALL_NORMAL_Y * n + s] : R(0.0), fields[WALL_NORMAL_Z * n + s]);
  const real tx = fields[WALL_TANGENT_X * n + s], tz = fields[WALL_TANGENT_Z * n + s];
  const real area = fields[WALL_AREA * n + s], half_along = fields[WALL_HALF_ALONG * n + s];
  c.distance = c.normal.x * rx + c.normal.y * ry + c.normal.z * rz;
#if DIMENSIONS == 3
  const real ty = fields[WALL_TANGENT_Y * n + s];
  const real half_across = fields[WALL_HALF_ACROSS * n + s];
  const real along = tx * rx + ty * ry + tz * rz;
  const real bx = c.normal.y * tz - c.normal.z * ty;
  const real by = c.normal.z * tx - c.normal.x * tz;
  const real bz = c.normal.x * ty - c.normal.y * tx;
  const real across = bx * rx + by * ry + bz * rz;
#else
  const real half_across = R(0.0);
  const real along = tx * rx + tz * rz;
  const real across = R(0.0);
#endif
  c.over = fmax(fabs(along) - half_along, fabs(across) - half_across) <= BORDER * p->spacing;
  c.beside = fmax(fabs(along) - half_along - fields[WALL_GAP_ALONG * n + s], fabs(across) - half_across - fields[WALL_GAP_ACROSS * n + s]);
  c.weight = kernel_value(p, sqrt(r2)) * area;
  c.moment = make_vector(rx * c.weight, ry * c.weight, rz * c.weight);
  c.shepard = rectangle_shepard(p, c.distance, c.over, along, across, half_along, half_across, area, r2);
  return c;
}

// Numerical wall elements ([C] B.2): rectangles (2-D: segments) of about the spacing, whose integrals are midpoint rules, except for the singular part
// of Φ, whose integral is the angle that the rectangle subtends.
#define WALL_TANGENT_X 9
#define WALL_TANGENT_Y 10
#define WALL_TANGENT_Z 11
#define WALL_HALF_ALONG 12
#define WALL_HALF_ACROSS 13
#define WALL_GAP_ALONG 14     // by which the wall that it stands for reaches beyond the rectangle: nothing unless that wall is no rectangle
#define WALL_GAP_ACROSS 15

#if DIMENSIONS == 3
// Solid angle between the foot point and the corner (a, b) of a rectangle at distance d ≥ 0, signed by a and b ([C] of docs/numerics.md, B.2). As an arctangent of a quotient
// it needs no case distinction, keeps its precision for small elements, and tends to ±π/2 on the plane.
INLINE real corner_angle(real d, real a, real b) { return arctangent(a * b, d * sqrt(d * d + a * a + b * b)); }
#endif

// The element's term of γ(x) = 1 + Σ_s ∫ n·(y−x) Φ dS ([C] eqs 8–12 with signs corrected): the polynomial part of Φ by the midpoint rule with its
// second-order term (the squared sides/24 of the tangential second derivatives), without which walls at right angles miss γ by more than 2e-3; the
// divergent part exactly, through the angle that the element subtends.
INLINE real rectangle_shepard(__constant const parameters_t* p, real distance, bool over, real along, real across, real half_along, real half_across,
                              real area, real r2) {
#if SHEPARD_MONOLITHIC
  return distance * area * monolithic_potential(p, r2);
#else
  const bool near_behind = over && distance > -BEHIND_TOLERANCE * p->spacing;
  const real side = side_of(p, distance, over);
  const real d = fmax(fabs(distance), LEAST_DISTANCE * p->spacing);
  const real height = near_behind ? fabs(distance) : distance;
  const real inverse2 = p->inverse_smoothing * p->inverse_smoothing;
  const potential_t f = potential_polynomial(p, r2);
  const real along2 = along * along * inverse2, across2 = across * across * inverse2;
  const real length2 = R(0.166666666667) * half_along * half_along * inverse2;  // side²/24 in units of h
  const real width2 = R(0.166666666667) * half_across * half_across * inverse2;
#if DIMENSIONS == 3
  const real polynomial = f.scale * (f.value + (length2 + width2) * f.slope + (length2 * along2 + width2 * across2) * f.bend);
  const real a0 = along - half_along, a1 = along + half_along;
  const real b0 = across - half_across, b1 = across + half_across;
  const real angle = corner_angle(d, a1, b1) - corner_angle(d, a0, b1) - corner_angle(d, a1, b0) + corner_angle(d, a0, b0);
  return height * polynomial * area - R(0.0795774715459) * side * angle;
#else
  const real polynomial = f.scale * (f.value + length2 * (f.slope + along2 * f.bend));
  const real angle = arctangent(along + half_along, d) - arctangent(along - half_along, d);
  return height * polynomial * area - R(0.159154943092) * side * angle;
#endif
#endif
}

INLINE contact_t touch_wall(__constant const parameters_t* p, const walls_t* walls, int s, real x, real y, real z) {
  __global const real* fields = walls->fields;
  const int n = walls->stride;
  const real rx = fields[WALL_X * n + s] - x, rz = fields[WALL_Z * n + s] - z;
  const real ry = DIMENSIONS == 3 ? fields[WALL_Y * n + s] - y : R(0.0);
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

// The geometry of a wall element seen from a point, and its share of the geometric Shepard factor.
#include "common.cl"

typedef struct {
  real normal_x, normal_y, normal_z;  // out of the fluid
  real area;
  real half_along;   // half the sides of the rectangle that it is taken for
  real half_across;
  real distance;     // of the point from the element's plane, positive on the fluid's side
  real along;        // signed tangential coordinates of the element's centre
  real across;
  real gap_along;    // by which the wall that it stands for reaches beyond the rectangle: nothing unless that wall is no rectangle
  real gap_across;
  bool over;         // the point's foot lies on the rectangle
} wall_view_t;

// Points this far behind an element that they stand over count as lying on its fluid side: rounding and the guard's own tolerance; far above the
// float32 resolution of the coordinates, and γ is continuous across the plane.
#define BEHIND_TOLERANCE R(0.25)  // of the spacing

// Two elements that meet both count as under a point this near to their border, so that rounding leaves no point between them.
#define BORDER R(0.01)  // of the spacing

// How far the point's foot lies beside the rectangle; negative on it.
INLINE real beside_wall(const wall_view_t* v) { return fmax(fabs(v->along) - v->half_along, fabs(v->across) - v->half_across); }

// The same for the wall that the rectangle stands for, or less.
INLINE real beside_whole_wall(const wall_view_t* v) {
  return fmax(fabs(v->along) - v->half_along - v->gap_along, fabs(v->across) - v->half_across - v->gap_across);
}

INLINE wall_view_t view_wall(__constant const parameters_t* p, __global const real* walls, int stride, int s, real rx, real ry, real rz) {
  wall_view_t v;
  v.normal_x = walls[WALL_NORMAL_X * stride + s];
  v.normal_z = walls[WALL_NORMAL_Z * stride + s];
  const real tx = walls[WALL_TANGENT_X * stride + s];
  const real tz = walls[WALL_TANGENT_Z * stride + s];
  v.area = walls[WALL_AREA * stride + s];
  v.half_along = walls[WALL_HALF_ALONG * stride + s];
  v.gap_along = walls[WALL_GAP_ALONG * stride + s];
  v.gap_across = walls[WALL_GAP_ACROSS * stride + s];
#if DIMENSIONS == 3
  v.normal_y = walls[WALL_NORMAL_Y * stride + s];
  const real ty = walls[WALL_TANGENT_Y * stride + s];
  v.half_across = walls[WALL_HALF_ACROSS * stride + s];
  v.distance = v.normal_x * rx + v.normal_y * ry + v.normal_z * rz;
  v.along = tx * rx + ty * ry + tz * rz;
  const real bx = v.normal_y * tz - v.normal_z * ty;
  const real by = v.normal_z * tx - v.normal_x * tz;
  const real bz = v.normal_x * ty - v.normal_y * tx;
  v.across = bx * rx + by * ry + bz * rz;
#else
  v.normal_y = R(0.0);
  v.half_across = R(0.0);
  v.distance = v.normal_x * rx + v.normal_z * rz;
  v.along = tx * rx + tz * rz;
  v.across = R(0.0);
#endif
  v.over = beside_wall(&v) <= BORDER * p->spacing;
  return v;
}

// How near the point is to the element, at the least: what the guard asks. Beside an element it counts too, for a point that comes round an edge.
INLINE real wall_clearance(__constant const parameters_t* p, const wall_view_t* v) {
  if (v->over) return v->distance > -BEHIND_TOLERANCE * p->spacing ? v->distance : p->support;
  return fmax(fabs(v->distance), beside_whole_wall(v));
}

// atan2(y, x) for x ≥ 0. In float32 by a polynomial of our own, fitted at Chebyshev nodes, error below 1.1e-7: the library's function is a call, which
// keeps the loop over the wall elements from being vectorised.
INLINE real arctangent(real y, real x) {
#if USE_DOUBLE
  return atan2(y, x);
#else
  const real size = fabs(y);
  const real t = fmin(size, x) / fmax(size, x);
  const real u = t * t;
  real sum = 0.00283411056f;
  sum = sum * u - 0.0160052898f;
  sum = sum * u + 0.042588171f;
  sum = sum * u - 0.0749550797f;
  sum = sum * u + 0.106367926f;
  sum = sum * u - 0.142025837f;
  sum = sum * u + 0.199924859f;
  sum = sum * u - 0.33333067f;
  sum = sum * u + 0.999999984f;
  const real angle = size > x ? 1.57079632679f - t * sum : t * sum;
  return y < 0.0f ? -angle : angle;
#endif
}

#if DIMENSIONS == 3
// Solid angle between the foot point and the corner (a, b) of a rectangle at distance d ≥ 0, signed by a and b ([C] of docs/numerics.md, B.2). As an arctangent of a quotient
// it needs no case distinction, keeps its precision for small elements, and tends to ±π/2 on the plane.
INLINE real corner_angle(real d, real a, real b) { return arctangent(a * b, d * sqrt(d * d + a * a + b * b)); }
#endif

// The element's term of γ(x) = 1 + Σ_s ∫ n·(y−x) Φ dS ([C] eqs 8–12 with signs corrected): the polynomial part of Φ by the midpoint rule with its
// second-order term (the squared sides/24 of the tangential second derivatives), without which walls at right angles miss γ by more than 2e-3; the divergent part exactly,
// through the angle that the element subtends. Nearer than LEAST_DISTANCE that angle is taken at LEAST_DISTANCE, or the rounding of a border would be as
// large as the distance and the angles of two neighbours would not add up; down to half of it behind the plane, the point lies in the plane.
#define LEAST_DISTANCE R(2.0e-3)  // of the spacing
INLINE real shepard_term(__constant const parameters_t* p, const wall_view_t* v, real r2) {
  const real least = LEAST_DISTANCE * p->spacing;
  const bool near_behind = v->over && v->distance > -BEHIND_TOLERANCE * p->spacing;
  const real side = near_behind ? R(1.0) : fmin(fmax(R(3.0) + R(4.0) * v->distance / least, R(-1.0)), R(1.0));
  const real d = fmax(fabs(v->distance), least);
  const real height = near_behind ? fabs(v->distance) : v->distance;
  const real inverse2 = p->inverse_smoothing * p->inverse_smoothing;
  const real q = fmax(sqrt(r2) * p->inverse_smoothing, R(1.0e-6));
  const real along2 = v->along * v->along * inverse2, across2 = v->across * v->across * inverse2;
  const real length2 = R(0.166666666667) * v->half_along * v->half_along * inverse2;  // side²/24 in units of h
  const real width2 = R(0.166666666667) * v->half_across * v->half_across * inverse2;
#if DIMENSIONS == 3
  const real value = R(5.33333333333) + q * q * (R(-8.0) + q * (R(6.66666666667) + q * (R(-2.14285714286) + q * R(0.25))));
  const real slope = R(-16.0) + q * (R(20.0) + q * (R(-8.57142857143) + q * R(1.25)));  // value'/q
  const real bend = R(20.0) / q + R(-17.1428571429) + q * R(3.75);                      // (value'' − value'/q)/q²
  const real polynomial = R(0.0261113579) * inverse2 * p->inverse_smoothing * (value + (length2 + width2) * slope + (length2 * along2 + width2 * across2) * bend);
  const real a0 = v->along - v->half_along, a1 = v->along + v->half_along;
  const real b0 = v->across - v->half_across, b1 = v->across + v->half_across;
  const real angle = corner_angle(d, a1, b1) - corner_angle(d, a0, b1) - corner_angle(d, a1, b0) + corner_angle(d, a0, b0);
  return height * polynomial * v->area - R(0.0795774715459) * side * angle;
#else
  const real value = R(8.0) + q * q * (R(-10.0) + q * (R(8.0) + q * (R(-2.5) + q * R(0.285714285714))));
  const real slope = R(-20.0) + q * (R(24.0) + q * (R(-10.0) + q * R(1.42857142857)));
  const real bend = R(24.0) / q + R(-20.0) + q * R(4.28571428571);
  const real polynomial = R(0.0348151439) * inverse2 * (value + length2 * (slope + along2 * bend));
  const real angle = arctangent(v->along + v->half_along, d) - arctangent(v->along - v->half_along, d);
  return height * polynomial * v->area - R(0.159154943092) * side * angle;
#endif
}

// γ exceeds 1 or vanishes only by quadrature error: bounded, and the callers count how often.
#define SHEPARD_LEAST R(0.05)
INLINE real bounded_shepard(real shepard) { return fmin(fmax(shepard, SHEPARD_LEAST), R(1.0)); }

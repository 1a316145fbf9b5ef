// The geometry of a wall element seen from a point, and its share of the geometric Shepard factor.
#include "common.cl"

typedef struct {
  real normal_x, normal_y, normal_z;  // out of the fluid
  real area;
  real half_side;
  real distance;     // of the point from the element's plane, positive on the fluid's side
  real along;        // signed tangential coordinates of the element's centre
  real across;
  bool over;         // the point's foot lies on the element
} wall_view_t;

// Points this far behind an element that they stand over count as lying on its fluid side: rounding and the guard's own tolerance; far above the
// float32 resolution of the coordinates, and γ is continuous across the plane.
#define BEHIND_TOLERANCE R(0.25)  // of the spacing

INLINE wall_view_t view_wall(__constant const parameters_t* p, __global const real* walls, int stride, int s, real rx, real ry, real rz) {
  wall_view_t v;
  v.normal_x = walls[WALL_NORMAL_X * stride + s];
  v.normal_z = walls[WALL_NORMAL_Z * stride + s];
  const real tx = walls[WALL_TANGENT_X * stride + s];
  const real tz = walls[WALL_TANGENT_Z * stride + s];
  v.area = walls[WALL_AREA * stride + s];
#if DIMENSIONS == 3
  v.normal_y = walls[WALL_NORMAL_Y * stride + s];
  const real ty = walls[WALL_TANGENT_Y * stride + s];
  v.half_side = R(0.5) * sqrt(v.area);
  v.distance = v.normal_x * rx + v.normal_y * ry + v.normal_z * rz;
  v.along = tx * rx + ty * ry + tz * rz;
  const real bx = v.normal_y * tz - v.normal_z * ty;
  const real by = v.normal_z * tx - v.normal_x * tz;
  const real bz = v.normal_x * ty - v.normal_y * tx;
  v.across = bx * rx + by * ry + bz * rz;
#else
  v.normal_y = R(0.0);
  v.half_side = R(0.5) * v.area;
  v.distance = v.normal_x * rx + v.normal_z * rz;
  v.along = tx * rx + tz * rz;
  v.across = R(0.0);
#endif
  const real reach = v.half_side + R(0.01) * p->spacing;
  v.over = fabs(v.along) <= reach && fabs(v.across) <= reach;
  return v;
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
// Solid angle between the foot point and the corner (a, b) of a rectangle at distance d ≥ 0, signed by a and b ([G] B.2). As an arctangent of a quotient
// it needs no case distinction, keeps its precision for small elements, and tends to ±π/2 on the plane.
INLINE real corner_angle(real d, real a, real b) { return arctangent(a * b, d * sqrt(d * d + a * a + b * b)); }
#endif

// The element's term of γ(x) = 1 + Σ_s ∫ n·(y−x) Φ dS ([G] eqs 8–12 with signs corrected): the polynomial part of Φ by its value at the centre, the
// divergent part exactly, through the angle that the element subtends.
INLINE real shepard_term(__constant const parameters_t* p, const wall_view_t* v, real r2) {
  const real q = sqrt(r2) * p->inverse_smoothing;
  const bool near_behind = v->over && v->distance > -BEHIND_TOLERANCE * p->spacing;
  const real d = fmax(fabs(v->distance), R(1.0e-6) * p->spacing);  // 0/0 has no value
  const real side = (v->distance >= R(0.0) || near_behind) ? R(1.0) : R(-1.0);
#if DIMENSIONS == 3
  const real polynomial = R(0.0261113579) * (R(5.33333333333) + q * q * (R(-8.0) + q * (R(6.66666666667) + q * (R(-2.14285714286) + q * R(0.25)))));
  const real scale = p->inverse_smoothing * p->inverse_smoothing * p->inverse_smoothing;
  const real a0 = v->along - v->half_side, a1 = v->along + v->half_side;
  const real b0 = v->across - v->half_side, b1 = v->across + v->half_side;
  const real angle = corner_angle(d, a1, b1) - corner_angle(d, a0, b1) - corner_angle(d, a1, b0) + corner_angle(d, a0, b0);
  return side * (d * polynomial * scale * v->area - R(0.0795774715459) * angle);
#else
  const real polynomial = R(0.0348151439) * (R(8.0) + q * q * (R(-10.0) + q * (R(8.0) + q * (R(-2.5) + q * R(0.285714285714)))));
  const real scale = p->inverse_smoothing * p->inverse_smoothing;
  const real angle = arctangent(v->along + v->half_side, d) - arctangent(v->along - v->half_side, d);
  return side * (d * polynomial * scale * v->area - R(0.159154943092) * angle);
#endif
}

// γ exceeds 1 or vanishes only by quadrature error: bounded, and the callers count how often.
#define SHEPARD_LEAST R(0.05)
INLINE real bounded_shepard(real shepard) { return fmin(fmax(shepard, SHEPARD_LEAST), R(1.0)); }

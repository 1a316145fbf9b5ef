// The free edges of thin plates. What a plate hides begins, beyond its edge, at the plane through the point and the edge: there the kernel is cut off
// without a wall. The integrals of W over that plane's part within the support close Σ ∇W V + Σ n ∫ W dS = 0 about such edges.
#define BRIM_COUNT 20
#define BRIM_DIRECTION 3
#define BRIM_LENGTH 6
#define BRIM_NORMAL 7        // of the face, out of the fluid
#define BRIM_INWARDS 10      // in the face's plane, from the edge onto the face
#define BRIM_OTHER_NORMAL 13 // of the face beyond the edge ...
#define BRIM_HAS_OTHER 16    // ... if there is one

typedef struct {
  vector_t normal;  // out of what is seen
  real weight;      // ∫ W dS
  vector_t moment;  // ∫ (y − x) W dS
} brim_view_t;

#if DIMENSIONS == 3
// ∫ W ρ² dρ from q on, in units of h.
INLINE real8 sector_moments(real8 q) {
  const real8 q2 = q * q;
  return R(0.417781725616) * (R(0.190476190476) + q2 * q * (R(-0.333333333333) + q2 * (R(0.5) + q * (R(-0.416666666667) + q * (R(0.133928571429) - q * R(0.015625))))));
}
#else
// ∫ W dρ from q on, in units of h.
INLINE real ray_integral(real q) {
  const real q2 = q * q;
  return SCALE * (R(0.666666666667) - q * (R(1.0) + q2 * (R(-0.833333333333) + q * (R(0.625) + q * (R(-0.1875) + q * R(0.0208333333333))))));
}
#endif

INLINE brim_view_t view_brim(__constant const parameters_t* p, const walls_t* walls, int s, real x, real y, real z) {
  __global const real* b = walls->brims + BRIM_COUNT * s;
  brim_view_t v;
  v.weight = R(0.0);
  v.moment = make_vector(R(0.0), R(0.0), R(0.0));
  v.normal = v.moment;
  const vector_t to = make_vector(b[0] - x, b[1] - y, b[2] - z);
  const vector_t face = make_vector(b[BRIM_NORMAL], b[BRIM_NORMAL + 1], b[BRIM_NORMAL + 2]);
  const vector_t other = make_vector(b[BRIM_OTHER_NORMAL], b[BRIM_OTHER_NORMAL + 1], b[BRIM_OTHER_NORMAL + 2]);
  if (dot3(face, to) <= R(0.0)) return v;                                        // the face is not seen
  if (b[BRIM_HAS_OTHER] > R(0.5) && dot3(other, to) > R(0.0)) return v;          // nor does sight end here
  const vector_t inwards = make_vector(b[BRIM_INWARDS], b[BRIM_INWARDS + 1], b[BRIM_INWARDS + 2]);
  const vector_t way = make_vector(b[BRIM_DIRECTION], b[BRIM_DIRECTION + 1], b[BRIM_DIRECTION + 2]);
  const real along = dot3(to, way);
  const vector_t foot = make_vector(to.x - along * way.x, to.y - along * way.y, to.z - along * way.z);  // of the point on the edge's line
  const real away = fmax(sqrt(dot3(foot, foot)), R(1.0e-5) * p->smoothing_length);
  const real q = away * p->inverse_smoothing;
  if (q >= R(2.0)) return v;
  const vector_t ray = make_vector(foot.x / away, foot.y / away, foot.z / away);
  vector_t normal = cross3(way, ray);
  const real sign = dot3(normal, inwards) < R(0.0) ? R(-1.0) : R(1.0);
  v.normal = make_vector(sign * normal.x, sign * normal.y, sign * normal.z);
#if DIMENSIONS == 3
  const real reach = sqrt(R(4.0) - q * q);
  const real from = fmin(fmax(along * p->inverse_smoothing, -reach), reach);
  const real end = fmin(fmax((along + b[BRIM_LENGTH]) * p->inverse_smoothing, -reach), reach);
  if (end <= from) return v;
  const real first = arctangent(from, q), last = arctangent(end, q);
  const real half_turn = R(0.5) * (last - first);
  const real8 angle = R(0.5) * (first + last) + half_turn * GAUSS_PLACE;
  const real8 cosine = cos(angle);
  const real8 rho = fmin(q / cosine, R(2.0));
  const real8 moments = GAUSS_WEIGHT * sector_moments(rho);
  v.weight = half_turn * sum8(GAUSS_WEIGHT * height_integrals(rho));
  const real across = half_turn * sum8(cosine * moments), sideways = half_turn * sum8(sin(angle) * moments);
#else
  v.weight = ray_integral(q);
  const real across = height_integral(q), sideways = R(0.0);
#endif
  v.weight *= p->inverse_smoothing;
  v.moment = make_vector(across * ray.x + sideways * way.x, across * ray.y + sideways * way.y, across * ray.z + sideways * way.z);
  if (v.weight > R(0.0)) {
    // the edge itself may be hidden
    const real t = fmin(fmax(-along, R(0.0)), b[BRIM_LENGTH]) * R(0.99);
    if (hidden_in_cell(p, walls, x, y, z, R(0.99) * (to.x + t * way.x), R(0.99) * (to.y + t * way.y), R(0.99) * (to.z + t * way.z))) {
      v.weight = R(0.0);
      v.moment = make_vector(R(0.0), R(0.0), R(0.0));
    }
  }
  return v;
}

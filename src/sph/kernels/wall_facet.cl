// Facets: the mesh's own flat triangles (2-D: segments) of any size, integrated exactly over the part within the support. In the facet's plane, with
// the point's foot as the centre, ∫ n·(y−x) Φ dS = d Σ_edges ∫ [G(d) − G(ρ)] dϕ and ∫ W dS = Σ_edges ∫ [H(d) − H(ρ)] dϕ, where G' = −Φ ρ, H' = −W ρ, both
// zero from 2h on, and ϕ turns with the edge about the foot. With t along the edge and p its distance from the foot, dϕ = p dt/(p² + t²) and
// p² + t² = ρ² − d²: the quotients are polynomials of d and ρ without a pole, and eight Gauss points, taken as one vector, give them to 1e-6; the singular
// part of Φ gives an angle. Over a small facet the regular parts are smooth: seven points all over it are cheaper than its edges. Lengths below are in units of h.
#define WALL_SMALL_AREA WALL_AREA  // of a small facet; 0 if it is large

// Distances below this are as good as zero: far below what a coordinate resolves, but enough to keep the angles defined.
#define LEAST_HEIGHT R(1.0e-6)

#if DIMENSIONS == 3
// Coefficients of the polynomial part of G by powers of ρ.
#define G0 R(0.119366207319)
#define G2 R(-0.0696302876026)
#define G4 R(0.0522227157020)
#define G5 R(-0.0348151438013)
#define G6 R(0.00932548494678)
#define G7 R(-0.000932548494678)
#define QUARTER_PI_INVERSE R(0.0795774715459)

INLINE real potential_integral(real q) {
  const real q2 = q * q;
  return G0 + q2 * (G2 + q2 * (G4 + q * (G5 + q * (G6 + q * G7))));
}

// The angle of the cone over a right triangle: from the foot along p to the edge, and along it by t. As a length: p² ρ + d t².
INLINE turn_t cone_turn(real d, real p, real t) {
  const real rho = sqrt(d * d + p * p + t * t);
  const turn_t turn = {p * p * rho + d * t * t, t * p * (rho - d)};
  return turn;
}

// At the foot from (p, from) to (p, to).
INLINE turn_t plane_turn(real p, real from, real to) {
  const turn_t turn = {p * p + from * to, p * (to - from)};
  return turn;
}

typedef struct {
  real shepard, weight, moment;
} edge_t;

// `inner`: within the support the edge's share cancels with that of the next facet of the plane, which is in reach too, and is left out.
INLINE edge_t edge_terms(real d, real p, real from, real to, bool inner) {
  edge_t e = {R(0.0), R(0.0), R(0.0)};
  const real chord2 = R(4.0) - d * d - p * p;
  const real chord = sqrt(fmax(chord2, R(0.0)));
  const real a = fmin(fmax(from, -chord), chord), b = fmin(fmax(to, -chord), chord);
  real outside, cone = R(0.0);
  if (b > a && inner) return e;
  if (b > a) {
    // beyond the support on the one side or the other; less than half a turn in all, for the edge is straight
    outside = a > from || b < to ? angle_of(added(plane_turn(p, from, a), plane_turn(p, b, to))) : R(0.0);
    const turn_t first = cone_turn(d, p, a), last = cone_turn(d, p, b);
    const turn_t back = {first.cosine, -first.sine};
    cone = angle_of(added(last, back));
    const real half_length = R(0.5) * (b - a);
    const real d2 = d * d;
    const real8 t = R(0.5) * (a + b) + half_length * GAUSS_PLACE;
    const real8 rho2 = d2 + p * p + t * t;
    const real8 rho = sqrt(rho2);
    const real8 inverse = R(1.0) / (d + rho);
    const real8 s3 = rho2 + d * (rho + d);
    const real8 s4 = d2 + rho2;
    const real8 s5 = rho2 * rho2 + d * rho2 * rho + d2 * s3;
    const real8 s6 = d2 * s4 + rho2 * rho2;
    const real8 s7 = rho2 * rho2 * rho2 + d * rho2 * rho2 * rho + d2 * s5;
    e.weight = -half_length * p * sum8(GAUSS_WEIGHT * (H2 + H4 * s4 + H6 * s6 + inverse * (H5 * s5 + H7 * s7)));
    e.shepard = -d * half_length * p * sum8(GAUSS_WEIGHT * (G2 + G4 * s4 + G6 * s6 + inverse * (G5 * s5 + G7 * s7)));
    e.moment = half_length * sum8(GAUSS_WEIGHT * height_integrals(rho));
  } else {
    outside = angle_of(plane_turn(p, from, to));
  }
  e.weight += height_integral(d) * outside;
  e.shepard += (d * potential_integral(d) - QUARTER_PI_INVERSE) * outside - QUARTER_PI_INVERSE * cone;
  return e;
}

// Nearer to its plane than this, even a small facet is integrated by its edges: an angle is then known from both its facets to the last bit.
#define LEAST_CUBATURE_HEIGHT R(0.02)

// Radon's seven points of a triangle, exact to degree five, by the weights of its corners; the eighth place is not used.
#define RADON_A R(0.470142064105)
#define RADON_B R(0.101286507323)
#define RADON_A_REST R(0.05971587179)
#define RADON_B_REST R(0.797426985353)
#define RADON_THIRD R(0.333333333333)
#define RADON_FIRST (real8)(RADON_THIRD, RADON_A, RADON_A, RADON_A_REST, RADON_B, RADON_B, RADON_B_REST, RADON_THIRD)
#define RADON_SECOND (real8)(RADON_THIRD, RADON_A, RADON_A_REST, RADON_A, RADON_B, RADON_B_REST, RADON_B, RADON_THIRD)
#define RADON_THIRD_CORNER (real8)(RADON_THIRD, RADON_A_REST, RADON_A, RADON_A, RADON_B_REST, RADON_B, RADON_B, RADON_THIRD)
#define RADON_WEIGHT (real8)(R(0.225), R(0.132394152789), R(0.132394152789), R(0.132394152789), R(0.125939180545), R(0.125939180545), R(0.125939180545), R(0.0))

INLINE real8 radon_places(real first, real second, real third) {
  return first * RADON_FIRST + second * RADON_SECOND + third * RADON_THIRD_CORNER;
}

typedef struct {
  real shepard, weight;
  vector_t moment;
} small_t;

// d: distance from the plane, positive; corners from the point. Beyond the support Φ is 0, and the regular part therefore what cancels the solid angle.
INLINE small_t small_facet(real d, const vector_t corner[3], real area) {
  const real8 x = radon_places(corner[0].x, corner[1].x, corner[2].x);
  const real8 y = radon_places(corner[0].y, corner[1].y, corner[2].y);
  const real8 z = radon_places(corner[0].z, corner[1].z, corner[2].z);
  const real8 q2 = x * x + y * y + z * z;
  const real8 q = sqrt(q2);
  const real8 u = fmax(R(1.0) - R(0.5) * q, R(0.0));
  const real8 weight = RADON_WEIGHT * area * R(0.417781725616) * u * u * u * u * (R(1.0) + R(2.0) * q);
  const real8 within = R(0.0261113579) * (R(5.33333333333) + q2 * (R(-8.0) + q * (R(6.66666666667) + q * (R(-2.14285714286) + q * R(0.25)))));
  const real8 beyond = QUARTER_PI_INVERSE / (q2 * q);
  const real8 regular = RADON_WEIGHT * area * (q < R(2.0) ? within : beyond);
  const real size0 = sqrt(dot3(corner[0], corner[0])), size1 = sqrt(dot3(corner[1], corner[1])), size2 = sqrt(dot3(corner[2], corner[2]));
  const real triple = R(2.0) * area * d;
  const real below = size0 * size1 * size2 + dot3(corner[0], corner[1]) * size2 + dot3(corner[1], corner[2]) * size0 + dot3(corner[2], corner[0]) * size1;
  small_t f;
  f.weight = sum8(weight);
  f.shepard = d * sum8(regular) - R(2.0) * QUARTER_PI_INVERSE * whole_arctangent(triple, below);
  f.moment = make_vector(sum8(weight * x), sum8(weight * y), sum8(weight * z));
  return f;
}
#else
__constant real gauss_place[5] = {R(-0.906179845939), R(-0.538469310106), R(0.0), R(0.538469310106), R(0.906179845939)};
__constant real gauss_weight[5] = {R(0.236926885056), R(0.478628670499), R(0.568888888889), R(0.478628670499), R(0.236926885056)};

typedef struct {
  real weight, potential;
} part_t;

// ∫ W dt and ∫ of the polynomial part of Φ over [from, to], on one side of the foot.
INLINE part_t part_of_segment(real d, real from, real to) {
  part_t part = {R(0.0), R(0.0)};
  const real half_length = R(0.5) * (to - from), middle = R(0.5) * (from + to);
  for (int k = 0; k < 5; ++k) {
    const real t = middle + half_length * gauss_place[k];
    const real q2 = d * d + t * t;
    const real q = sqrt(q2);
    const real u = fmax(R(1.0) - R(0.5) * q, R(0.0));
    part.weight += gauss_weight[k] * u * u * u * u * (R(1.0) + R(2.0) * q);
    part.potential += gauss_weight[k] * (R(8.0) + q2 * (R(-10.0) + q * (R(8.0) + q * (R(-2.5) + q * R(0.285714285714)))));
  }
  part.weight *= SCALE * half_length;
  part.potential *= R(0.0348151438013) * half_length;
  return part;
}

typedef struct {
  real shepard, weight, moment;  // the moment along the segment
} segment_t;

// The integrals over what lies within the support of a segment from `from` to `to` along its line, as seen from the foot.
INLINE segment_t segment_terms(real d, real from, real to) {
  segment_t s = {R(0.0), R(0.0), R(0.0)};
  const real chord = sqrt(R(4.0) - d * d);
  const real a = fmin(fmax(from, -chord), chord), b = fmin(fmax(to, -chord), chord);
  if (b <= a) return s;
  const real middle = fmin(fmax(R(0.0), a), b);  // W and Φ have odd powers of the distance: no Gauss points across the foot
  const part_t left = part_of_segment(d, a, middle), right = part_of_segment(d, middle, b);
  s.weight = left.weight + right.weight;
  s.shepard = d * (left.potential + right.potential) - R(0.159154943092) * (arctangent(b, d) - arctangent(a, d));
  s.moment = height_integral(sqrt(d * d + a * a)) - height_integral(sqrt(d * d + b * b));
  return s;
}
#endif

// Of (x, y, z) from the plane of the facet with these fields; positive on the fluid's side.
INLINE real plane_distance(const walls_t* walls, __global const real* fields, real x, real y, real z) {
  const real distance =
      fields[WALL_NORMAL_X] * wall_way(walls, 0, fields[WALL_X], x) + fields[WALL_NORMAL_Z] * wall_way(walls, 2, fields[WALL_Z], z);
  return DIMENSIONS == 3 ? distance + fields[WALL_NORMAL_Y] * wall_way(walls, 1, fields[WALL_Y], y) : distance;
}

INLINE contact_t touch_wall(__constant const parameters_t* p, const walls_t* walls, int s, real x, real y, real z) {
  __global const real* fields = walls->fields + s * walls->wall_stride;
  contact_t c;
  c.normal = make_vector(fields[WALL_NORMAL_X], DIMENSIONS == 3 ? fields[WALL_NORMAL_Y] : R(0.0), fields[WALL_NORMAL_Z]);
  c.distance = plane_distance(walls, fields, x, y, z);
  c.weight = R(0.0);
  c.shepard = R(0.0);
  c.moment = make_vector(R(0.0), R(0.0), R(0.0));
  c.beside = p->support;
  c.over = false;
  const real height = c.distance * p->inverse_smoothing;
  const real d = fmax(fabs(height), LEAST_HEIGHT);
  if (d >= R(2.0)) return c;
  real shepard = R(0.0), along_x = R(0.0), along_y = R(0.0), along_z = R(0.0);
#if DIMENSIONS == 3
  real from[3], to[3], beside[3];
  vector_t out[3], corner[3];
  for (int k = 0; k < 3; ++k) {
    const int field = WALL_EDGES + EDGE_COUNT * k;
    const real bx = wall_way(walls, 0, fields[field], x) * p->inverse_smoothing;
    const real by = wall_way(walls, 1, fields[field + 1], y) * p->inverse_smoothing;
    const real bz = wall_way(walls, 2, fields[field + 2], z) * p->inverse_smoothing;
    const vector_t way = make_vector(fields[field + 3], fields[field + 4], fields[field + 5]);
    const real sign = fields[field + 7] > R(0.0) ? R(1.0) : R(-1.0);
    // the base and the direction belong to the edge, not to the facet, so that the two facets that share it see exactly opposite distances
    const vector_t across = cross3(way, c.normal);
    out[k] = make_vector(sign * across.x, sign * across.y, sign * across.z);
    beside[k] = -(out[k].x * bx + out[k].y * by + out[k].z * bz);
    from[k] = way.x * bx + way.y * by + way.z * bz;
    const real length = fields[field + 6] * p->inverse_smoothing;
    to[k] = from[k] + length;
    const real start = sign > R(0.0) ? R(0.0) : length;
    corner[k] = make_vector(bx + start * way.x, by + start * way.y, bz + start * way.z);
  }
  const real farthest = fmax(fmax(beside[0], beside[1]), beside[2]);
  c.beside = farthest * p->smoothing_length;
  c.over = farthest <= R(0.0);
  // a little beyond the support: an edge within it must be so for both its facets, whatever the rounding
  if (farthest * farthest >= R(4.001) - d * d && farthest > R(0.0)) return c;
  const bool in_front = height >= R(0.0) || (c.over && c.distance > -BEHIND_TOLERANCE * p->spacing);
  const real small_area = fields[WALL_SMALL_AREA] * p->inverse_smoothing * p->inverse_smoothing;
  if (small_area > R(0.0) && d > LEAST_CUBATURE_HEIGHT) {
    const small_t f = small_facet(d, corner, small_area);
    c.shepard = in_front ? f.shepard : -f.shepard;
    c.weight = f.weight * p->inverse_smoothing;
    c.moment = f.moment;
    return c;
  }
#if THIN_WALLS
  const bool whole = !MAY_HIDE(p, walls, x, y, z);
#else
  const bool whole = true;
#endif
  for (int k = 0; k < 3; ++k) {
    // as long as both facets of the plane show the same side, and are not hidden by themselves
    const bool inner = whole && height >= R(0.0) && fabs(fields[WALL_EDGES + EDGE_COUNT * k + 7]) > R(1.5);
    const edge_t e = edge_terms(d, -beside[k], from[k], to[k], inner);
    shepard += e.shepard;
    c.weight += e.weight;
    along_x -= e.moment * out[k].x;
    along_y -= e.moment * out[k].y;
    along_z -= e.moment * out[k].z;
  }
#else
  const real bx = wall_way(walls, 0, fields[WALL_EDGES], x) * p->inverse_smoothing;
  const real bz = wall_way(walls, 2, fields[WALL_EDGES + 2], z) * p->inverse_smoothing;
  const real wx = fields[WALL_EDGES + 3], wz = fields[WALL_EDGES + 5];
  const real from = wx * bx + wz * bz;
  const real to = from + fields[WALL_EDGES + 6] * p->inverse_smoothing;
  const real farthest = fmax(from, -to);
  c.beside = farthest * p->smoothing_length;
  c.over = farthest <= R(0.0);
  const bool in_front = height >= R(0.0) || (c.over && c.distance > -BEHIND_TOLERANCE * p->spacing);
  const segment_t part = segment_terms(d, from, to);
  shepard = part.shepard;
  c.weight = part.weight;
  along_x = part.moment * wx;
  along_z = part.moment * wz;
#endif
  c.shepard = in_front ? shepard : -shepard;
  const real depth = height * c.weight;
  c.moment = make_vector(along_x + depth * c.normal.x, along_y + depth * c.normal.y, along_z + depth * c.normal.z);
  c.weight *= p->inverse_smoothing;
  return c;
}

#if THIN_WALLS
// Of a facet that the point stands before, the part on the point's side of its screen: what lies beyond the thin wall, and under its thickness, is not seen.
// A facet may be far larger than the support, and pass below a plate that stands on it. `c`: the whole facet's.
INLINE contact_t part_before(__constant const parameters_t* p, const walls_t* walls, int s, real x, real y, real z, contact_t c) {
  const real tolerance = R(1.0e-3) * p->spacing * p->inverse_smoothing;
  const real height = c.distance * p->inverse_smoothing;
  const real d = fmax(fabs(height), LEAST_HEIGHT);
  if (d >= R(2.0)) return c;
  __global const real* fields = walls->fields + s * walls->wall_stride;
  const vector_t n = make_vector(walls->screen[0], walls->screen[1], walls->screen[2]);
  const real own = (n.x * x + n.y * y + n.z * z + walls->screen[3]) * p->inverse_smoothing;  // below zero on the point's side
#if DIMENSIONS == 3
  vector_t corner[3];
  real side[3];
  for (int k = 0; k < 3; ++k) {
    const int field = WALL_EDGES + EDGE_COUNT * k;
    const real start = fields[field + 7] > R(0.0) ? R(0.0) : fields[field + 6];
    corner[k] = make_vector((fields[field] + start * fields[field + 3] - x) * p->inverse_smoothing,
                            (fields[field + 1] + start * fields[field + 4] - y) * p->inverse_smoothing,
                            (fields[field + 2] + start * fields[field + 5] - z) * p->inverse_smoothing);
    side[k] = own + dot3(n, corner[k]);
  }
  const real least = fmin(fmin(side[0], side[1]), side[2]), most = fmax(fmax(side[0], side[1]), side[2]);
  if (most <= tolerance) return c;
  real shepard = R(0.0), along_x = R(0.0), along_y = R(0.0), along_z = R(0.0);
  c.weight = R(0.0);
  if (least < -tolerance) {
    vector_t polygon[4];
    int corners = 0;
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3;
      if (side[k] <= R(0.0)) polygon[corners++] = corner[k];
      if ((side[k] <= R(0.0)) == (side[next] <= R(0.0))) continue;
      const real part = side[k] / (side[k] - side[next]);
      polygon[corners++] = make_vector(corner[k].x + part * (corner[next].x - corner[k].x), corner[k].y + part * (corner[next].y - corner[k].y),
                                       corner[k].z + part * (corner[next].z - corner[k].z));
    }
    for (int k = 0; k < corners; ++k) {
      const vector_t a = polygon[k], b = polygon[(k + 1) % corners];
      const vector_t edge = make_vector(b.x - a.x, b.y - a.y, b.z - a.z);
      const real length = sqrt(dot3(edge, edge));
      if (length < R(1.0e-5)) continue;
      const vector_t way = make_vector(edge.x / length, edge.y / length, edge.z / length);
      const vector_t out = cross3(way, c.normal);
      const real from = dot3(way, a);
      const edge_t e = edge_terms(d, dot3(out, a), from, from + length, false);
      shepard += e.shepard;
      c.weight += e.weight;
      along_x -= e.moment * out.x;
      along_y -= e.moment * out.y;
      along_z -= e.moment * out.z;
    }
  }
#else
  const real bx = wall_way(walls, 0, fields[WALL_EDGES], x) * p->inverse_smoothing;
  const real bz = wall_way(walls, 2, fields[WALL_EDGES + 2], z) * p->inverse_smoothing;
  const real wx = fields[WALL_EDGES + 3], wz = fields[WALL_EDGES + 5];
  real from = wx * bx + wz * bz;
  real to = from + fields[WALL_EDGES + 6] * p->inverse_smoothing;
  const real first = own + n.x * bx + n.z * bz, slope = n.x * wx + n.z * wz;
  const real last = first + slope * (to - from);
  if (fmax(first, last) <= tolerance) return c;
  segment_t part = {R(0.0), R(0.0), R(0.0)};
  if (fmin(first, last) < -tolerance) {
    const real cut = from - first / slope;
    if (first > R(0.0)) from = cut;
    if (last > R(0.0)) to = cut;
    part = segment_terms(d, from, to);
  }
  c.weight = part.weight;
  const real shepard = part.shepard;
  const real along_x = part.moment * wx, along_y = R(0.0), along_z = part.moment * wz;
#endif
  c.shepard = shepard;
  const real depth = height * c.weight;
  c.moment = make_vector(along_x + depth * c.normal.x, along_y + depth * c.normal.y, along_z + depth * c.normal.z);
  c.weight *= p->inverse_smoothing;
  return c;
}
#endif

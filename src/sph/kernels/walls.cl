// Walls as a point sees them. Each kind of wall (rectangles, triangles, facets) is a file that gives touch_wall(): all integrals over one element or
// facet, from which every sweep takes what it needs.
#include "neighbours.cl"

typedef struct {
  vector_t normal;   // out of the fluid
  real distance;     // of the point from the wall's plane, positive on the fluid's side
  // Of facets, only their sums over a plane mean anything: what two of one plane have in common is left out of both.
  real weight;       // ∫ W dS
  vector_t moment;   // ∫ (y − x) W dS
  real shepard;      // ∫ n·(y − x) Φ dS
  real beside;       // how far the point's foot lies beside the wall; negative or zero on it
  bool over;         // it lies on it
} contact_t;

// W(r), for one point of a wall.
INLINE real kernel_value(__constant const parameters_t* p, real distance) {
  const real q = distance * p->inverse_smoothing;
  const real t = fmax(R(1.0) - R(0.5) * q, R(0.0));
  return p->kernel_scale * t * t * t * t * (R(1.0) + R(2.0) * q);
}

// Points this far behind a wall that they stand over count as lying on its fluid side: rounding and the guard's own tolerance; far above the
// float32 resolution of the coordinates, and γ is continuous across the plane.
#define BEHIND_TOLERANCE R(0.25)  // of the spacing

// Two elements that meet both count as under a point this near to their border, so that rounding leaves no point between them.
#define BORDER R(0.01)  // of the spacing

// Nearer than this, the angle under which an element is seen is taken at this distance, or the rounding of a border would be as large as the distance
// and the angles of two neighbours would not add up; down to half of it behind the plane, the point lies in the plane.
#define LEAST_DISTANCE R(2.0e-3)  // of the spacing

// atan2(y, x) for x ≥ 0. In float32 by a polynomial of our own, fitted at Chebyshev nodes, error below 1.1e-7: the library's function is a call, which
// keeps the loop over the wall elements from being vectorised.
INLINE real arctangent(real y, real x) {
#if USE_DOUBLE
  return atan2(y, x);
#else
  const real size = fabs(y);
  const real t = fmin(size, x) / fmax(fmax(size, x), 1.0e-30f);
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

// The same for any x.
INLINE real whole_arctangent(real y, real x) {
  const real angle = arctangent(y, fabs(x));
  const real half_turn = R(3.14159265359);
  return x < R(0.0) ? (y < R(0.0) ? -half_turn - angle : half_turn - angle) : angle;
}

// A complex number of any length, whose argument is an angle: angles are added by multiplying, and only their sum is found.
typedef struct {
  real cosine, sine;
} turn_t;

INLINE turn_t added(turn_t a, turn_t b) {
  const turn_t sum = {a.cosine * b.cosine - a.sine * b.sine, a.cosine * b.sine + a.sine * b.cosine};
  return sum;
}
INLINE real angle_of(turn_t a) { return whole_arctangent(a.sine, a.cosine); }

// H(q) = ∫ W ρ dρ from q to 2, in units of h, which ∫ W dS over flat walls and moments along straight ones are made of.
#if DIMENSIONS == 3
#if USE_DOUBLE
typedef double8 real8;
#else
typedef float8 real8;
#endif
// Eight Gauss points of [−1, 1] as one vector.
#define GAUSS_PLACE (real8)(R(-0.960289856498), R(-0.796666477414), R(-0.525532409916), R(-0.183434642496), R(0.183434642496), R(0.525532409916), R(0.796666477414), R(0.960289856498))
#define GAUSS_WEIGHT (real8)(R(0.10122853629), R(0.222381034453), R(0.313706645878), R(0.362683783378), R(0.362683783378), R(0.313706645878), R(0.222381034453), R(0.10122853629))

INLINE real sum8(real8 v) { return ((v.s0 + v.s1) + (v.s2 + v.s3)) + ((v.s4 + v.s5) + (v.s6 + v.s7)); }

#define H0 R(0.119366207319)
#define H2 R(-0.208890862808)
#define H4 R(0.261113578510)
#define H5 R(-0.208890862808)
#define H6 R(0.0652783946274)
#define H7 R(-0.00746038795742)
INLINE real height_integral(real q) {
  const real q2 = q * q;
  return H0 + q2 * (H2 + q2 * (H4 + q * (H5 + q * (H6 + q * H7))));
}

INLINE real8 height_integrals(real8 q) {
  const real8 q2 = q * q;
  return H0 + q2 * (H2 + q2 * (H4 + q * (H5 + q * (H6 + q * H7))));
}
#else
#define SCALE R(0.557042300822)  // α of W in units of h
INLINE real height_integral(real q) {
  const real q2 = q * q;
  return SCALE * (R(0.285714285714) + q2 * (R(-0.5) + q2 * (R(0.625) + q * (R(-0.5) + q * (R(0.15625) + q * R(-0.0178571428571))))));
}
#endif

// The polynomial part of Φ at q, and what its second tangential derivatives are made of: value'/q and (value'' − value'/q)/q², all to be scaled.
typedef struct {
  real value, slope, bend, scale;
} potential_t;

INLINE potential_t potential_polynomial(__constant const parameters_t* p, real r2) {
  const real q = fmax(sqrt(r2) * p->inverse_smoothing, R(1.0e-6));
  potential_t f;
#if DIMENSIONS == 3
  f.value = R(5.33333333333) + q * q * (R(-8.0) + q * (R(6.66666666667) + q * (R(-2.14285714286) + q * R(0.25))));
  f.slope = R(-16.0) + q * (R(20.0) + q * (R(-8.57142857143) + q * R(1.25)));
  f.bend = R(20.0) / q + R(-17.1428571429) + q * R(3.75);
  f.scale = R(0.0261113579) * p->inverse_smoothing * p->inverse_smoothing * p->inverse_smoothing;
#else
  f.value = R(8.0) + q * q * (R(-10.0) + q * (R(8.0) + q * (R(-2.5) + q * R(0.285714285714))));
  f.slope = R(-20.0) + q * (R(24.0) + q * (R(-10.0) + q * R(1.42857142857)));
  f.bend = R(24.0) / q + R(-20.0) + q * R(4.28571428571);
  f.scale = R(0.0348151439) * p->inverse_smoothing * p->inverse_smoothing;
#endif
  return f;
}

// Φ itself far from its singularity, as the polynomial part with the singular one added to each member; `scale` stays the polynomial's.
INLINE potential_t whole_potential(__constant const parameters_t* p, real r2) {
  potential_t f = potential_polynomial(p, r2);
  const real inverse_q2 = R(1.0) / (r2 * p->inverse_smoothing * p->inverse_smoothing);
#if DIMENSIONS == 3
  const real singular = R(-3.04761904762) * inverse_q2 * sqrt(inverse_q2);  // −1/(4π q³) over the scale
  f.value += singular;
  f.slope -= R(3.0) * singular * inverse_q2;
  f.bend += R(15.0) * singular * inverse_q2 * inverse_q2;
#else
  const real singular = R(-4.57142857143) * inverse_q2;  // −1/(2π q²) over the scale
  f.value += singular;
  f.slope -= R(2.0) * singular * inverse_q2;
  f.bend += R(8.0) * singular * inverse_q2 * inverse_q2;
#endif
  return f;
}

#if SHEPARD_MONOLITHIC
// Φ at an element's centre, singular part and all ([C] eq 8 by the midpoint rule): for comparison.
INLINE real whole_value(__constant const parameters_t* p, real r2) {
  const potential_t f = whole_potential(p, fmax(r2, R(1.0e-12) * p->smoothing_length * p->smoothing_length));
  return f.scale * f.value;
}
#endif

// On which side of an element's plane a point counts, from 1 in front to −1 behind.
INLINE real side_of(__constant const parameters_t* p, real distance, bool over) {
  if (over && distance > -BEHIND_TOLERANCE * p->spacing) return R(1.0);
  return fmin(fmax(R(3.0) + R(4.0) * distance / (LEAST_DISTANCE * p->spacing), R(-1.0)), R(1.0));
}

#if FACETS
#include "wall_facet.cl"
#elif TRIANGLES
#include "wall_triangle.cl"
#else
#include "wall_rectangle.cl"
#endif

#if THIN_WALLS
#define RIM R(1.5)  // WALL_THIN of a rim is more

INLINE contact_t unseen(__constant const parameters_t* p, contact_t c) {
  c.weight = R(0.0);
  c.shepard = R(0.0);
  c.moment = make_vector(R(0.0), R(0.0), R(0.0));
  c.beside = p->support;
  c.over = false;
  return c;
}

#if FACETS
// A convex side of a thin part falls away behind the plane of each of its facets: it is all one side, unlike a wall that stands as far behind the part.
INLINE bool of_screens_side(__constant const parameters_t* p, const walls_t* walls, real x, real y, real z, const contact_t* c) {
  const vector_t screen = make_vector(walls->screen[0], walls->screen[1], walls->screen[2]);
  const real distance = -(dot3(screen, make_vector(x, y, z)) + walls->screen[3]);
  return dot3(screen, c->normal) > R(0.5) && c->distance < distance + R(0.5) * p->spacing;
}
#endif

// What thin walls leave of a wall for the point; `c`: all of it.
SELDOM contact_t visible_part(__constant const parameters_t* p, const walls_t* walls, int s, real x, real y, real z, contact_t c) {
  const bool behind = c.distance < R(0.0);
  // beyond a thin wall's two sides: the rim between them is nothing of its own
  if (behind && WALL_FIELD(walls, WALL_THIN, s) > RIM) return unseen(p, c);
#if FACETS
  if (!behind && c.weight > R(0.0) && walls->screened && !of_screens_side(p, walls, x, y, z, &c)) c = part_before(p, walls, s, x, y, z, c);
#endif
  if (c.weight <= R(0.0)) return behind && WALL_FIELD(walls, WALL_THIN, s) > R(0.5) ? unseen(p, c) : c;
  const real inverse = R(1.0) / c.weight;
  const vector_t middle = make_vector(c.moment.x * inverse, c.moment.y * inverse, c.moment.z * inverse);
  // From behind, a wall is the far side of the solid that the point stands beside, and counts with it, unless that is so thin that there is water beyond:
  // then the wall is that water's. A sheet's two sides lie upon each other.
  if (behind)
    return behind_opposite(p, walls, x, y, z, R(1.01) * middle.x, R(1.01) * middle.y, R(1.01) * middle.z, c.normal) ? unseen(p, c) : c;
  // not quite to the wall, which may be thin itself
  return hidden_in_cell(p, walls, x, y, z, R(0.99) * middle.x, R(0.99) * middle.y, R(0.99) * middle.z) != NO_OWNER ? unseen(p, c) : c;
}

// A wall as it would be if nothing hid it. Who stands before one side of a sharp tip, or of a sheet, is behind the other: by next to nothing, but not by
// rounding.
INLINE contact_t whole_wall(__constant const parameters_t* p, const walls_t* walls, int s, real x, real y, real z) {
  contact_t c = touch_wall(p, walls, s, x, y, z);
  if (!walls->screened || !c.over || c.distance >= R(0.0) || c.distance <= -BEHIND_TOLERANCE * p->spacing) return c;
  if (c.normal.x * walls->screen[0] + c.normal.y * walls->screen[1] + c.normal.z * walls->screen[2] < R(-0.5)) c.shepard = -c.shepard;
  return c;
}

// A wall as the point sees it.
INLINE contact_t see_wall(__constant const parameters_t* p, const walls_t* walls, int s, real x, real y, real z) {
  const contact_t all = whole_wall(p, walls, s, x, y, z);
  if (!MAY_HIDE(p, walls, x, y, z)) return all;
  contact_t c = visible_part(p, walls, s, x, y, z, all);
  c.weight += walls->share * (all.weight - c.weight);
  c.shepard += walls->share * (all.shepard - c.shepard);
  c.moment.x += walls->share * (all.moment.x - c.moment.x);
  c.moment.y += walls->share * (all.moment.y - c.moment.y);
  c.moment.z += walls->share * (all.moment.z - c.moment.z);
  return c;
}
#else
INLINE contact_t see_wall(__constant const parameters_t* p, const walls_t* walls, int s, real x, real y, real z) {
  return touch_wall(p, walls, s, x, y, z);
}
#endif

// Two walls face each other if the cosine of their normals is less. In gaps between them narrower than this, in spacings, there is no room for particles, and
// from the second on there is: between, the water film (src/simulation/water_film.h) goes over into particles.
#define FACING R(-0.7)
#define FILM_CLOSED R(0.5)
#define FILM_OPEN R(0.9)

// How near the point is to the wall, at the least: what the guard asks. Beside a wall it counts too, for a point that comes round an edge.
INLINE real wall_clearance(__constant const parameters_t* p, const contact_t* c) {
  if (c->over) return c->distance > -BEHIND_TOLERANCE * p->spacing ? c->distance : p->support;
  return fmax(fabs(c->distance), c->beside);
}

// γ exceeds 1 or vanishes only by quadrature error, the volumetric one by disorder: bounded, and the callers count how often.
#define SHEPARD_LEAST R(0.05)
INLINE real bounded_shepard(real shepard) {
#if SHEPARD_VOLUMETRIC
  return fmax(shepard, SHEPARD_LEAST);
#else
  return fmin(fmax(shepard, SHEPARD_LEAST), R(1.0));
#endif
}

// Where the sum of the Shepard factor begins, and whether walls add to it.
#if SHEPARD_VOLUMETRIC
#define SHEPARD_START R(0.0)
#else
#define SHEPARD_START R(1.0)
#endif

#define MOTION_OF(walls, s) OWNER_MOTION((walls)->motions, (int)WALL_FIELD(walls, WALL_OWNER, s))

INLINE vector_t motion_vector(__global const real* motion, int which) { return make_vector(motion[3 * which], motion[3 * which + 1], motion[3 * which + 2]); }

// Gravity at the point (x, y, z) as it acts on what moves there at the given velocity, in the tank's frame.
INLINE vector_t gravity_at(__constant const parameters_t* p, const walls_t* walls, real x, real y, real z, vector_t velocity) {
#if MOVING_FRAME
  __global const real* frame = walls->motions;
  const vector_t spin = motion_vector(frame, 1);
  const vector_t arm = make_vector(x - frame[9], y - frame[10], z - frame[11]);
  const vector_t turn = cross3(motion_vector(frame, 2), arm);
  const vector_t around = cross3(spin, arm);
  const vector_t carried = cross3(spin, make_vector(around.x + R(2.0) * velocity.x, around.y + R(2.0) * velocity.y, around.z + R(2.0) * velocity.z));
  return make_vector(frame[0] - turn.x - carried.x, frame[1] - turn.y - carried.y, frame[2] - turn.z - carried.z);
#else
  return make_vector(p->gravity_x, p->gravity_y, p->gravity_z);
#endif
}

// The wall's velocity at the point (x, y, z) of it.
INLINE vector_t wall_velocity(const walls_t* walls, int s, vector_t normal, real x, real y, real z) {
#if MOVING_WALLS
  __global const real* motion = MOTION_OF(walls, s);
  const vector_t arm = make_vector(x - motion[0], y - motion[1], z - motion[2]);
  const vector_t turn = cross3(motion_vector(motion, 2), arm);
  const vector_t belt = motion_vector(motion, 5);
  const real off = dot3(belt, normal);
  return make_vector(motion[3] + turn.x + belt.x - off * normal.x, motion[4] + turn.y + belt.y - off * normal.y,
                     motion[5] + turn.z + belt.z - off * normal.z);
#else
  return make_vector(R(0.0), R(0.0), R(0.0));
#endif
}

// Gravity as fluid of the given velocity feels it that stays on the wall at the point (x, y, z): less the wall's acceleration.
INLINE vector_t gravity_at_wall(__constant const parameters_t* p, const walls_t* walls, int s, real x, real y, real z, vector_t velocity) {
  vector_t g = gravity_at(p, walls, x, y, z, velocity);
#if MOVING_WALLS
  __global const real* motion = MOTION_OF(walls, s);
  const vector_t arm = make_vector(x - motion[0], y - motion[1], z - motion[2]);
  const vector_t spin = motion_vector(motion, 2);
  const vector_t turn = cross3(motion_vector(motion, 4), arm);
  const vector_t inwards = cross3(spin, cross3(spin, arm));
  g.x -= motion[9] + turn.x + inwards.x;
  g.y -= motion[10] + turn.y + inwards.y;
  g.z -= motion[11] + turn.z + inwards.z;
#endif
  return g;
}

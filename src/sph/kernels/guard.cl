// Guard against penetration ([C] of docs/numerics.md): a particle nearer to a wall than the guard distance and approaching it loses its normal velocity
// relative to the wall; one that rounding or a violent step put behind the wall, or through it beside an edge or a corner, is set back onto it. The splash guard does the same above the rim of an
// open tank, where there is no wall: as if the tank's walls went on upwards from the rim, and at the sides of the tank's bounding box. Where bodies are
// free (GUARD_IMPULSES), what each particle loses is kept for them, by the walls' owners.
#include "walls.cl"
#define SWEEP_WALLS

typedef struct {
  const walls_t* walls;
  vector_t from;  // where it was at the start of the step
  real step;
  real x, y, z;  // how far it was set back
  real u, v, w;
  int hits;
  bool above_rim;
#if GUARD_IMPULSES
  int owners[GUARD_OWNERS];
  vector_t lost[GUARD_OWNERS];  // of its velocity, to each
#endif
} wall_sweep_t;

#if GUARD_IMPULSES
// A particle that walls of more owners hold at once gives what is beyond to the last of them.
INLINE void lose(wall_sweep_t* a, int owner, vector_t velocity) {
  int slot = 0;
  while (slot + 1 < GUARD_OWNERS && a->owners[slot] != NO_OWNER && a->owners[slot] != owner) ++slot;
  if (a->owners[slot] == NO_OWNER) a->owners[slot] = owner;
  a->lost[slot] = make_vector(a->lost[slot].x + velocity.x, a->lost[slot].y + velocity.y, a->lost[slot].z + velocity.z);
}
#endif

// Whether the particle went through the wall in this step: from a wall's front past its edge or corner it may come out behind two walls, over neither.
INLINE bool went_through(const wall_sweep_t* a, __constant const parameters_t* p, int s, const contact_t* c, real x, real y, real z) {
  if (c->distance >= R(0.0) || c->distance < -p->spacing || c->beside > p->spacing || a->above_rim) return false;
  // where it was, seen from where the wall is now
  const vector_t carried = wall_velocity(a->walls, s, c->normal, a->from.x, a->from.y, a->from.z);
  const vector_t way = make_vector(x - a->from.x - a->step * carried.x, y - a->from.y - a->step * carried.y, z - a->from.z - a->step * carried.z);
  const real before = c->distance + dot3(c->normal, way);
  if (before < -BORDER * p->spacing) return false;
  const real back = c->distance / fmax(fmax(before, R(0.0)) - c->distance, R(1.0e-6) * p->spacing);  // to the plane, of the way; negative
  const contact_t there = touch_wall(p, a->walls, s, x + back * way.x, y + back * way.y, z + back * way.z);
  return there.beside <= BORDER * p->spacing;
}

INLINE void add_wall(wall_sweep_t* a, __constant const parameters_t* p, int s, real x, real y, real z) {
  // seen from where the walls before this one left the particle
  contact_t c = touch_wall(p, a->walls, s, x + a->x, y + a->y, z + a->z);
  if (a->above_rim) {
    const vector_t sideways = make_vector(p->top_axis == 0 ? R(0.0) : c.normal.x, p->top_axis == 1 ? R(0.0) : c.normal.y, p->top_axis == 2 ? R(0.0) : c.normal.z);
    const real level = sqrt(dot3(sideways, sideways));
    if (level < R(0.1) || WALL_FIELD(a->walls, WALL_OWNER, s) > R(0.5)) return;
    c.normal = make_vector(sideways.x / level, sideways.y / level, sideways.z / level);
    c.distance /= level;
  }
#if THIN_WALLS
  const bool thin = WALL_FIELD(a->walls, WALL_THIN, s) > R(0.5);
  if (thin) {
    // it holds what was on its own side; where it was then, seen from where it is now
    const vector_t carried = wall_velocity(a->walls, s, c.normal, a->from.x, a->from.y, a->from.z);
    const contact_t before = touch_wall(p, a->walls, s, a->from.x + a->step * carried.x, a->from.y + a->step * carried.y, a->from.z + a->step * carried.z);
    if (before.distance < R(0.0)) return;
  }
  const real least = thin ? R(1.0e-3) * p->spacing : R(0.0);  // never in its very plane, from where both sides can be seen
#else
  const real least = R(0.0);
#endif
  // behind a wall as far as half a spacing on the wall itself, by no more than the guard distance beside it: there a body's own side may lie
  const bool through = went_through(a, p, s, &c, x + a->x, y + a->y, z + a->z);
  const real deepest = c.over ? -R(2.0) * BEHIND_TOLERANCE * p->spacing : -p->guard_distance;
  if (!through && (c.beside > BORDER * p->spacing || c.distance > p->guard_distance || c.distance < deepest)) return;
  const vector_t wall = wall_velocity(a->walls, s, c.normal, x, y, z);
  const real approach = (a->u - wall.x) * c.normal.x + (a->v - wall.y) * c.normal.y + (a->w - wall.z) * c.normal.z;
  if (approach > R(0.0)) {
    a->u -= approach * c.normal.x;
    a->v -= approach * c.normal.y;
    a->w -= approach * c.normal.z;
    a->hits += 1;
#if GUARD_IMPULSES
    lose(a, (int)WALL_FIELD(a->walls, WALL_OWNER, s), make_vector(approach * c.normal.x, approach * c.normal.y, approach * c.normal.z));
#endif
  }
  if (c.distance < least) {
    const real back = c.distance - least;
    a->x += back * c.normal.x;
    a->y += back * c.normal.y;
    a->z += back * c.normal.z;
  }
}

#include "sweep.cl"

// A particle set back onto one wall may now be behind the next: in a corner of three dimensions three hold it.
INLINE void hold(wall_sweep_t* a, __constant const parameters_t* p, const walls_t* walls, __global const real* images, real x, real y, real z) {
  for (int pass = 0; pass < DIMENSIONS; ++pass) {
    const vector_t before = make_vector(a->x, a->y, a->z);
    sweep_walls(a, p, walls, images, x, y, z);
    if (fabs(a->x - before.x) + fabs(a->y - before.y) + fabs(a->z - before.z) < R(1.0e-4) * p->spacing) return;
  }
}

typedef struct {
  real move, speed;
  bool hit;
} held_t;

INLINE held_t hold_between(real at, real speed, real lower, real upper, real guard_distance) {
  held_t held;
  held.move = fmax(lower - at, R(0.0)) + fmin(upper - at, R(0.0));
  held.hit = (at < lower + guard_distance && speed < R(0.0)) || (at > upper - guard_distance && speed > R(0.0));
  held.speed = held.hit ? R(0.0) : speed;
  return held;
}

// Between the sides of the tank's bounding box, its top's axis left out.
INLINE bool hold_over_tank(__constant const parameters_t* p, __global real* state, long stride, int i) {
  const real lower[3] = {p->tank_lower_x, p->tank_lower_y, p->tank_lower_z}, upper[3] = {p->tank_upper_x, p->tank_upper_y, p->tank_upper_z};
  const real period[3] = {p->period_x, p->period_y, p->period_z};
  bool hit = false;
  for (int axis = 0; axis < 3; ++axis) {
#if DIMENSIONS == 2
    if (axis == 1) continue;
#endif
    if (axis == p->top_axis || period[axis] != R(0.0)) continue;
    __global real* at = state + (FIELD_X + axis) * stride + i;
    __global real* speed = state + (FIELD_U + axis) * stride + i;
    const held_t held = hold_between(*at, *speed, lower[axis], upper[axis], p->guard_distance);
    if (IS_LONG(axis)) {
      move(state, stride, axis, i, held.move);
    } else {
      *at += held.move;
    }
    *speed = held.speed;
    hit = hit || held.hit;
  }
  return hit;
}

__kernel void guard(__constant const parameters_t* p, int count, __global const int* slot_start, __global real* state, long stride, real reach,
                    WALL_ARGUMENTS,
                    __global const real* images, __global const real* rates, __global const real* half_state, __global const real* time_step,
                    __global int* guard_hits, __global int* takers, __global real* lost) {
  const int i = get_global_id(0);
  if (i >= count) return;
  guard_hits[i] = 0;
#if GUARD_IMPULSES
  for (int slot = 0; slot < GUARD_OWNERS; ++slot) takers[slot * stride + i] = NO_OWNER;
#endif
  const bool above_rim = p->top_way * state[(FIELD_X + p->top_axis) * stride + i] > p->rim;
  if (above_rim) guard_hits[i] = hold_over_tank(p, state, stride, i) ? 1 : 0;
  // who was further away than it has moved since cannot have come near, but for what walls move in a step (Δx/5 at the most)
  real moved = R(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    const real way = state[(FIELD_X + axis) * stride + i] - half_state[(FIELD_X + axis) * stride + i];
    moved += way * way;
  }
  const bool near = p->guard_distance > R(0.0) && rates[RATE_CLEARANCE * stride + i] <= p->guard_distance + R(0.25) * p->spacing + sqrt(moved);
  if (!near && !above_rim) return;
  wall_sweep_t a = {0};
  walls_t walls = WALLS_OF_ARGUMENTS;
  stand_at(&walls, state, stride, i);
  a.walls = &walls;
  // the middle of the step is half a step of the first velocity away from its start
  a.step = time_step[0];
  const real back = -R(0.5) * a.step;
  a.from = make_vector(half_state[FIELD_X * stride + i] + back * WITH_SHIFT(half_state[FIELD_U * stride + i], half_state, 0, i),
                       half_state[FIELD_Y * stride + i] + back * WITH_SHIFT(half_state[FIELD_V * stride + i], half_state, 1, i),
                       half_state[FIELD_Z * stride + i] + back * WITH_SHIFT(half_state[FIELD_W * stride + i], half_state, 2, i));
  a.u = state[FIELD_U * stride + i];
  a.v = DIMENSIONS == 3 ? state[FIELD_V * stride + i] : R(0.0);
  a.w = state[FIELD_W * stride + i];
  const real x = state[FIELD_X * stride + i], y = DIMENSIONS == 3 ? state[FIELD_Y * stride + i] : R(0.0), z = state[FIELD_Z * stride + i];
#if GUARD_IMPULSES
  for (int slot = 0; slot < GUARD_OWNERS; ++slot) a.owners[slot] = NO_OWNER;
#endif
  if (near) hold(&a, p, &walls, images, x, y, z);
  a.above_rim = above_rim;
  if (above_rim) {
    const real at_rim = p->top_way * (p->rim - R(0.25) * p->spacing);
    sweep_walls(&a, p, &walls, images, p->top_axis == 0 ? at_rim : x, p->top_axis == 1 ? at_rim : y, p->top_axis == 2 ? at_rim : z);
  }
  guard_hits[i] |= a.hits > 0 ? 1 : 0;
  state[FIELD_U * stride + i] = a.u;
  state[FIELD_W * stride + i] = a.w;
#if DIMENSIONS == 3
  state[FIELD_V * stride + i] = a.v;
#endif
  const real back_by[3] = {a.x, a.y, a.z};
  for (int axis = 0; axis < 3; ++axis) {
    if (DIMENSIONS == 2 && axis == 1) continue;
    if (IS_LONG(axis)) {
      move(state, stride, axis, i, back_by[axis]);
    } else {
      state[(FIELD_X + axis) * stride + i] += back_by[axis];
    }
  }
#if GUARD_IMPULSES
  for (int slot = 0; slot < GUARD_OWNERS; ++slot) {
    takers[slot * stride + i] = a.owners[slot];
    lost[3 * slot * stride + i] = a.lost[slot].x;
    lost[(3 * slot + 1) * stride + i] = a.lost[slot].y;
    lost[(3 * slot + 2) * stride + i] = a.lost[slot].z;
  }
#endif
}

// The shift δu of each particle by the case's law (shifting/), with the treatment of the free surface of eqs (43)–(48) of the particle shifting paper, for every
// law: within the support of a particle of the surface nothing is moved across that, and little where λ is small. Nor does it move a particle at a wall into it.
// What the laws go by surface.cl has found. Neighbours are gone over once more for the nearest particle of the surface, where there may be any: in tiles that
// are near one of the cells that have some.
#define TAKES_BLOCKS
#include "walls.cl"
#include "around.cl"
#include "shifting.cl"
#define SWEEP_PARTICLES
#define SWEEP_WALLS

typedef struct {
  neighbours_t near;
  __global const real* around;
  tile nearest;                       // r² of the nearest particle of the surface
  tile normal_x, normal_y, normal_z;  // its normal
} sweep_t;

typedef struct {
  const walls_t* walls;
  vector_t velocity, shift;
  bool holding;      // the shift back from walls; else their tensile part is summed
  vector_t tensile;
} wall_sweep_t;

INLINE void add_particle(sweep_t* a, __constant const parameters_t* p, int j, tile rx, tile ry, tile rz, tile r2) {
  __global const real* around = a->around;
  const long stride = a->near.stride;
  tile nearer = near_values(around + AROUND_SURFACE * stride, j) * one_above(a->nearest, r2);
#if PARTLY_SEEN
  nearer *= one_above(a->near.seen, (tile)(R(0.5)));
#endif
  __global const real* normal = around + AROUND_NORMAL * stride;
  tile_vector_t n = make_tile_vector(near_values(normal, j), DIMENSIONS == 3 ? near_values(normal + stride, j) : (tile)(R(0.0)),
                                     near_values(normal + 2 * stride, j));
#if GHOSTS
  if (a->near.mirrored) n = turned(a->near.image + IMAGE_MATRIX, n.x, n.y, n.z);
#endif
  a->nearest += nearer * (fmin(r2, a->nearest) - a->nearest);
  a->normal_x += nearer * (n.x - a->normal_x);
  a->normal_y += nearer * (n.y - a->normal_y);
  a->normal_z += nearer * (n.z - a->normal_z);
}

#if SHIFT_TENSILE
// ∫ W⁵ dS/W(Δx)⁴ over ∫ W dS, of a plane at a distance, by Gauss' rule of eight points: over the circle that the support cuts out of it, in 2-D the chord.
INLINE real tensile_of_plane(__constant const parameters_t* p, real distance) {
  const real place[4] = {R(0.1834346425), R(0.5255324099), R(0.7966664774), R(0.9602898565)};
  const real weight[4] = {R(0.3626837834), R(0.3137066459), R(0.2223810345), R(0.1012285363)};
  const real d = fmin(fabs(distance), p->support);
#if DIMENSIONS == 3
  const real from = d, to = p->support;  // the distance, with the circle's length about it
#else
  const real from = R(0.0), to = sqrt(fmax(p->support_squared - d * d, R(0.0)));  // along the chord
#endif
  real plain = R(0.0), tensile = R(0.0);
  for (int k = 0; k < 8; ++k) {
    const real at = R(0.5) * ((to + from) + (to - from) * (k < 4 ? place[k] : -place[k - 4]));
#if DIMENSIONS == 3
    const real distance_there = at, share = at * weight[k & 3];
#else
    const real distance_there = sqrt(d * d + at * at), share = weight[k & 3];
#endif
    const real value = kernel_value(p, distance_there), ratio = value * p->inverse_kernel_at_spacing;
    plain += share * value;
    tensile += share * value * (ratio * ratio) * (ratio * ratio);
  }
  return plain > R(0.0) ? tensile / plain : R(0.0);
}
#endif
INLINE void add_wall(wall_sweep_t* a, __constant const parameters_t* p, int s, real x, real y, real z) {
#if SHIFT_TENSILE
  if (!a->holding) {
    const contact_t seen = see_wall(p, a->walls, s, x, y, z);
    if (seen.weight == R(0.0)) return;
    const real tensile = p->tensile_of_walls * seen.weight * tensile_of_plane(p, seen.distance);
    a->tensile = make_vector(a->tensile.x + tensile * seen.normal.x, a->tensile.y + tensile * seen.normal.y, a->tensile.z + tensile * seen.normal.z);
    return;
  }
#endif
  const contact_t c = touch_wall(p, a->walls, s, x, y, z);
  if (c.beside > BORDER * p->spacing || c.distance > p->guard_distance || c.distance < -R(0.5) * p->spacing) return;
#if THIN_WALLS
  if (c.distance < R(0.0) && WALL_FIELD(a->walls, WALL_THIN, s) > R(0.5)) return;  // the far side of what the particle stands before
#endif
  const vector_t wall = wall_velocity(a->walls, s, c.normal, x, y, z);
  const real approach = dot3(make_vector(a->velocity.x + a->shift.x - wall.x, a->velocity.y + a->shift.y - wall.y, a->velocity.z + a->shift.z - wall.z),
                             c.normal);
  const real taken = fmin(fmax(approach, R(0.0)), fmax(dot3(a->shift, c.normal), R(0.0)));
  a->shift = make_vector(a->shift.x - taken * c.normal.x, a->shift.y - taken * c.normal.y, a->shift.z - taken * c.normal.z);
}

#include "sweep.cl"

// Of the surface's nearest particle: the square of its distance and its normal.
typedef struct {
  real r2;
  vector_t normal;
} nearest_t;

INLINE void own_nearest(const sweep_t* a, nearest_t* nearest) {
#if TILE_LANES == 1
  nearest[0].r2 = a->nearest;
  nearest[0].normal = make_vector(a->normal_x, a->normal_y, a->normal_z);
#else
  real r2[TILE_LANES], x[TILE_LANES], y[TILE_LANES], z[TILE_LANES];
  lanes_of(a->nearest, r2);
  lanes_of(a->normal_x, x);
  lanes_of(a->normal_y, y);
  lanes_of(a->normal_z, z);
  for (int k = 0; k < TILE_OWN; ++k) {
    int best = k * TILE_NEAR;
    for (int lane = best + 1; lane < (k + 1) * TILE_NEAR; ++lane) best = r2[lane] < r2[best] ? lane : best;
    nearest[k].r2 = r2[best];
    nearest[k].normal = make_vector(x[best], y[best], z[best]);
  }
#endif
}

// Eq (48), by the distance from the surface's nearest particle in parts of the support.
INLINE vector_t under_surface(vector_t shift, real eigenvalue, real depth, vector_t normal) {
  if (eigenvalue < R(0.4)) return make_vector(R(0.0), R(0.0), R(0.0));
  const real across = fmin(fmax((R(1.0) - depth) * R(2.0), R(0.0)), R(1.0)) * dot3(shift, normal);
  return times(eigenvalue * eigenvalue, make_vector(shift.x - across * normal.x, shift.y - across * normal.y, shift.z - across * normal.z));
}

// Whether a particle of the surface may be within the support of the place.
INLINE bool near_surface(__constant const parameters_t* p, __global const int* surface_cells, real x, real y, real z) {
#if IMAGES
  return true;
#else
  const real reach = R(1.001) * p->support;
  const int x0 = cell_coordinate(x - reach, p->inverse_cell, p->cells_x), x1 = cell_coordinate(x + reach, p->inverse_cell, p->cells_x);
  const int z0 = cell_coordinate(z - reach, p->inverse_cell, p->cells_z), z1 = cell_coordinate(z + reach, p->inverse_cell, p->cells_z);
#if DIMENSIONS == 3
  const int y0 = cell_coordinate(y - reach, p->inverse_cell, p->cells_y), y1 = cell_coordinate(y + reach, p->inverse_cell, p->cells_y);
#else
  const int y0 = 0, y1 = 0;
#endif
  int any = 0;
  for (int cz = z0; cz <= z1; ++cz)
    for (int cy = y0; cy <= y1; ++cy)
      for (int cx = x0; cx <= x1; ++cx) any |= surface_cells[(DIMENSIONS == 3 ? cz * p->cells_y + cy : cz) * p->cells_x + cx];
  return any != 0;
#endif
}

__kernel void shifts(__constant const parameters_t* p, int count, __global const int* slot_start, __global real* state, long stride, real reach,
                     WALL_ARGUMENTS, __global const real* images, __global const int* blocks, __global const real* around,
                     __global const int* surface_cells, __global const real* time_step) {
  TAKE_TILE(first, count)
  walls_t walls = WALLS_OF_ARGUMENTS;
  sweep_t a = {0};
  neighbours_of(&a.near, state, stride, reach, &walls, first, count);
  USE_BLOCK_LIST(a.near)
  a.around = around;
  a.nearest = (tile)(p->support_squared);
  bool near = false;
  for (int k = 0; k < a.near.own; ++k) near = near || near_surface(p, surface_cells, a.near.places.x[k], a.near.places.y[k], a.near.places.z[k]);
  if (near) sweep_particles(&a, p, slot_start, images);
  nearest_t nearest[TILE_OWN];
  own_nearest(&a, nearest);
  for (int k = 0; k < a.near.own; ++k) {
    const int i = first + k;
    wall_sweep_t b = {&walls, velocity_of(state, stride, i), {R(0.0), R(0.0), R(0.0)}, false, {R(0.0), R(0.0), R(0.0)}};
    stand_at(&walls, state, stride, i);
    LOOK_THROUGH(walls, a.near, k);
    shifted_t s;
    s.velocity = b.velocity;
    s.approach = R(0.0);
#if SHIFT_BY_APPROACH
    s.approach = around[AROUND_APPROACH * stride + i];
#endif
    s.depth = sqrt(nearest[k].r2) * p->inverse_support;
    s.step = time_step[0];
    s.concentration = make_vector(around[AROUND_CONCENTRATION * stride + i], around[(AROUND_CONCENTRATION + 1) * stride + i],
                                  around[(AROUND_CONCENTRATION + 2) * stride + i]);
#if SHIFT_TENSILE || SHIFT_SMOOTHS
    const vector_t law = make_vector(around[AROUND_LAW * stride + i], around[(AROUND_LAW + 1) * stride + i], around[(AROUND_LAW + 2) * stride + i]);
#endif
#if SHIFT_TENSILE
    // by a wall its own tensile part would have to balance that of the water; without either, water rests there
    const bool by_wall = around[AROUND_WALLS * stride + i] != R(0.0);
    if (!by_wall || p->tensile_by_walls > R(0.0)) {
      const real factor = p->slope_scale * p->tensile;
#if !GHOSTS
      if (by_wall) sweep_walls(&b, p, &walls, images, a.near.places.x[k], a.near.places.y[k], a.near.places.z[k]);
#endif
      s.concentration.x += factor * law.x + b.tensile.x;
      s.concentration.y += factor * law.y + b.tensile.y;
      s.concentration.z += factor * law.z + b.tensile.z;
    }
#endif
#if SHIFT_SMOOTHS
    s.concentration = law;
#endif
    vector_t shift = shift_by_law(p, &s);
    if (s.depth < R(1.0)) shift = under_surface(shift, around[AROUND_EIGENVALUE * stride + i], s.depth, nearest[k].normal);
    shift = limited(shift, SHIFT_MOST * p->spacing / s.step);
    b.shift = shift;
    b.holding = true;
    sweep_walls(&b, p, &walls, images, a.near.places.x[k], a.near.places.y[k], a.near.places.z[k]);
    shift = b.shift;
    state[FIELD_SHIFT_X * stride + i] = shift.x;
    state[FIELD_SHIFT_Y * stride + i] = DIMENSIONS == 3 ? shift.y : R(0.0);
    state[FIELD_SHIFT_Z * stride + i] = shift.z;
  }
}

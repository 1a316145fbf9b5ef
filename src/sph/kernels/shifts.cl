// The shift δu of each particle by the case's law (shifting/), with the treatment of the free surface of eqs (43)–(48) of the particle shifting paper, for every
// law: within the support of a particle of the surface nothing is moved across that, and little where λ is small. Nor does it move a particle at a wall into it.
#include "walls.cl"
#include "around.cl"
#include "shifting.cl"
#define SWEEP_PARTICLES
#define SWEEP_WALLS

typedef struct {
  neighbours_t near;
  __global const real* around;
  tile nearest;                          // r² of the nearest particle of the surface
  tile normal_x, normal_y, normal_z;     // its normal
} sweep_t;

typedef struct {
  const walls_t* walls;
  vector_t velocity, shift;
} wall_sweep_t;

INLINE void add_particle(sweep_t* a, __constant const parameters_t* p, int j, tile rx, tile ry, tile rz, tile r2) {
  __global const real* around = a->around;
  const long stride = a->near.stride;
  tile nearer = near_values(around + AROUND_SURFACE * stride, j) * ((tile)(R(1.0)) - step(a->nearest, r2));
#if THIN_WALLS
  nearer *= step((tile)(R(0.5)), a->near.seen);
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

INLINE void add_wall(wall_sweep_t* a, __constant const parameters_t* p, int s, real x, real y, real z) {
  const contact_t c = touch_wall(p, a->walls, s, x, y, z);
  if (c.beside > BORDER * p->spacing || c.distance > p->guard_distance || c.distance < -R(0.5) * p->spacing) return;
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

__kernel void shifts(__constant const parameters_t* p, int count, __global const int* slot_start, __global real* state, long stride, real reach,
                     WALL_ARGUMENTS, __global const real* images, __global const real* around, __global const real* time_step) {
  const int first = TILE_OWN * get_global_id(0);
  if (first >= count) return;
  walls_t walls = WALLS_OF_ARGUMENTS;
  sweep_t a = {0};
  neighbours_of(&a.near, state, stride, reach, &walls, first, count);
  a.around = around;
  a.nearest = (tile)(p->support_squared);
  sweep_particles(&a, p, slot_start, images);
  nearest_t nearest[TILE_OWN];
  own_nearest(&a, nearest);
  for (int k = 0; k < a.near.own; ++k) {
    const int i = first + k;
    shifted_t s;
    s.concentration = make_vector(around[AROUND_CONCENTRATION * stride + i], around[(AROUND_CONCENTRATION + 1) * stride + i],
                                  around[(AROUND_CONCENTRATION + 2) * stride + i]);
    s.velocity = velocity_of(state, stride, i);
    s.approach = around[AROUND_APPROACH * stride + i];
    s.depth = sqrt(nearest[k].r2) * p->inverse_support;
    s.step = time_step[0];
    vector_t shift = shift_by_law(p, &s);
    if (s.depth < R(1.0)) shift = under_surface(shift, around[AROUND_EIGENVALUE * stride + i], s.depth, nearest[k].normal);
    shift = limited(shift, SHIFT_MOST * p->spacing / s.step);
#if !GHOSTS
    stand_at(&walls, state, stride, i);
    LOOK_THROUGH(walls, a.near, k);
    wall_sweep_t b = {&walls, s.velocity, shift};
    sweep_walls(&b, p, &walls, images, a.near.places.x[k], a.near.places.y[k], a.near.places.z[k]);
    shift = b.shift;
#endif
    state[FIELD_SHIFT_X * stride + i] = shift.x;
    state[FIELD_SHIFT_Y * stride + i] = DIMENSIONS == 3 ? shift.y : R(0.0);
    state[FIELD_SHIFT_Z * stride + i] = shift.z;
  }
}

// The fluid at given points, in it or on a wall: the pressure of a probe, how full the kernel is there (for gauges and the free surface), and with
// VELOCITIES its velocity.
#include "walls.cl"
#define SWEEP_PARTICLES
#define SWEEP_WALLS

// How near a wall a point lies on it, and how far off an edge or corner γ is taken: as near as the kind of wall resolves it.
#if FACETS
#define HAIR R(3.0e-5)  // of the spacing
#elif SHEPARD_MONOLITHIC
#define HAIR R(0.0)     // at points off the wall it would be as wrong as it is
#else
#define HAIR LEAST_DISTANCE
#endif

typedef struct {
  neighbours_t near;
  vector_t gravity;  // as a point that rests in the tank feels it
  tile weight, pressure;
#if VELOCITIES
  tile u, v, w;  // Σ W V u
#if GHOSTS
  tile of_water;  // Σ W V without ghosts: what they have of velocity is turned round
#endif
#endif
} sweep_t;

typedef struct {
  const walls_t* walls;
  real shepard;
  bool finding_touched;                  // the walls' sweep looks for walls that the point lies on, instead of γ
  real inwards_x, inwards_y, inwards_z;  // Σ of their normals into the fluid
} wall_sweep_t;

INLINE void add_particle(sweep_t* a, __constant const parameters_t* p, int j, tile rx, tile ry, tile rz, tile r2) {
  const tile weight = kernel_values(p, sqrt(r2)) * near_volume(&a->near, j);
  const tile density = p->density * (R(1.0) + near_field(&a->near, FIELD_COMPRESSION, j));
  const tile head = a->gravity.x * rx + a->gravity.y * ry + a->gravity.z * rz;
  a->weight += weight;
  a->pressure += weight * (neighbour_pressure(&a->near, p, j, rx, ry, rz) - density * head);
#if VELOCITIES
#if GHOSTS
  if (a->near.mirrored) return;
  a->of_water += weight;
#endif
  const tile_vector_t velocity = neighbour_velocity(&a->near, j);
  a->u += weight * velocity.x;
  a->v += weight * velocity.y;
  a->w += weight * velocity.z;
#endif
}

INLINE void add_wall(wall_sweep_t* a, __constant const parameters_t* p, int s, real x, real y, real z) {
  const contact_t c = see_wall(p, a->walls, s, x, y, z);
  if (a->finding_touched) {
    const bool touched = c.beside <= BORDER * p->spacing && fabs(c.distance) < HAIR * p->spacing;
    a->inwards_x -= touched ? c.normal.x : R(0.0);
    a->inwards_y -= touched ? c.normal.y : R(0.0);
    a->inwards_z -= touched ? c.normal.z : R(0.0);
    return;
  }
  a->shepard += c.shepard;
}

#include "sweep.cl"

#define LEAST_FILLING R(0.5)

// γ at a point that may lie on walls: exactly in an edge or a corner it has no one value, so it is taken a hair off them, where a fluid's is.
INLINE real find_shepard(__constant const parameters_t* p, const walls_t* walls, __global const real* images, real x, real y, real z) {
#if GHOSTS
  return R(1.0);
#else
  wall_sweep_t a = {walls, R(1.0), true, R(0.0), R(0.0), R(0.0)};
  sweep_walls(&a, p, walls, images, x, y, z);
  // several elements of one wall may be touched: they count once
  const real size = fmax(fmax(fabs(a.inwards_x), fabs(a.inwards_y)), fmax(fabs(a.inwards_z), R(1.0)));
  const real hair = HAIR * p->spacing / size;
  a.finding_touched = false;
  sweep_walls(&a, p, walls, images, x + hair * a.inwards_x, y + hair * a.inwards_y, z + hair * a.inwards_z);
  return a.shepard;
#endif
}

#if TILE_OWN == 1
// points: x, y, z fields; results: pressure (Pa; 0 in the air), Σ W V, γ, and with VELOCITIES the mean velocity. Points need not lie together: tiles of one.
__kernel void points(__constant const parameters_t* p, int count, __global const int* slot_start, __global const real* state, long stride, real reach,
                     WALL_ARGUMENTS, __global const real* images, __global const real* points, __global real* results) {
  const int i = get_global_id(0);
  if (i >= count) return;
  walls_t walls = WALLS_OF_ARGUMENTS;
  const real x = points[i], y = points[count + i], z = points[2 * count + i];
  sweep_t a = {0};
  neighbours_at(&a.near, state, stride, reach, &walls, x, y, z);
  a.gravity = gravity_at(p, &walls, x, y, z, make_vector(R(0.0), R(0.0), R(0.0)));
  sweep_particles(&a, p, slot_start, images);
  LOOK_THROUGH(walls, a.near, 0);
  const real shepard = find_shepard(p, &walls, images, x, y, z);
  real weight, pressure;
  own_sums(a.weight, &weight);
  own_sums(a.pressure, &pressure);
  // where less than half of what the walls leave of the kernel is fluid, the air's zero pressure counts for the rest of that half: a droplet alone does
  // not tell the pressure around it
  results[i] = pressure / fmax(weight, LEAST_FILLING * bounded_shepard(shepard));
  results[count + i] = weight;
  results[2 * count + i] = shepard;
#if VELOCITIES
  real u, v, w;
  own_sums(a.u, &u);
  own_sums(a.v, &v);
  own_sums(a.w, &w);
  const real least = R(1.0e-6);
#if GHOSTS
  own_sums(a.of_water, &weight);
#endif
  results[3 * count + i] = u / fmax(weight, least);
  results[4 * count + i] = v / fmax(weight, least);
  results[5 * count + i] = w / fmax(weight, least);
#endif
}
#endif

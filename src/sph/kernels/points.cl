// The fluid at given points, in it or on a wall: the pressure of a probe, and how full the kernel is there (for gauges and the free surface).
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
  const walls_t* walls;
  vector_t gravity;  // as a point that rests in the tank feels it
  real weight, pressure;
  real shepard;
  bool finding_touched;             // the walls' sweep looks for walls that the point lies on, instead of γ
  real inwards_x, inwards_y, inwards_z;  // Σ of their normals into the fluid
} sweep_t;

INLINE void add_particle(sweep_t* a, __constant const parameters_t* p, int j, real rx, real ry, real rz, real r2) {
  const real weight = kernel_value(p, sqrt(r2)) * a->near.state[FIELD_VOLUME * a->near.stride + j];
  const real density = p->density * (R(1.0) + a->near.state[FIELD_COMPRESSION * a->near.stride + j]);
  const real head = a->gravity.x * rx + a->gravity.y * ry + a->gravity.z * rz;
  a->weight += weight;
  a->pressure += weight * (neighbour_pressure(&a->near, p, j, rx, ry, rz) - density * head);
}

INLINE void add_wall(sweep_t* a, __constant const parameters_t* p, int s, real x, real y, real z) {
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
INLINE void find_shepard(sweep_t* a, __constant const parameters_t* p, __global const real* images) {
  const real x = a->near.x, y = a->near.y, z = a->near.z;
  a->shepard = R(1.0);
#if !GHOSTS
  a->finding_touched = true;
  sweep_walls(a, p, a->walls, images, x, y, z);
  // several elements of one wall may be touched: they count once
  const real size = fmax(fmax(fabs(a->inwards_x), fabs(a->inwards_y)), fmax(fabs(a->inwards_z), R(1.0)));
  const real hair = HAIR * p->spacing / size;
  a->finding_touched = false;
  sweep_walls(a, p, a->walls, images, x + hair * a->inwards_x, y + hair * a->inwards_y, z + hair * a->inwards_z);
#endif
}

// points: x, y, z fields; results: pressure (Pa; 0 in the air), Σ W V, γ.
__kernel void points(__constant const parameters_t* p, int count, __global const int* cell_start, __global const real* state, int stride,
                     WALL_ARGUMENTS, __global const real* images, __global const real* points, __global real* results) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const walls_t walls = WALLS_OF_ARGUMENTS;
  sweep_t a = {0};
  a.near = neighbours_of(state, stride, &walls, points[i], points[count + i], points[2 * count + i]);
  a.walls = &walls;
  a.gravity = gravity_at(p, &walls, a.near.x, a.near.y, a.near.z, make_vector(R(0.0), R(0.0), R(0.0)));
  sweep_particles(&a, p, cell_start, images);
  find_shepard(&a, p, images);
  // where less than half of what the walls leave of the kernel is fluid, the air's zero pressure counts for the rest of that half: a droplet alone does
  // not tell the pressure around it
  results[i] = a.pressure / fmax(a.weight, LEAST_FILLING * bounded_shepard(a.shepard));
  results[count + i] = a.weight;
  results[2 * count + i] = a.shepard;
}

// Free surface: the particles whose kernel, beyond the walls' share, is not full. Written as 1 or 0, with γ beside it.
__kernel void surface(__constant const parameters_t* p, int count, __global const int* cell_start, __global const real* state, int stride,
                      WALL_ARGUMENTS, __global const real* images, __global real* results) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const walls_t walls = WALLS_OF_ARGUMENTS;
  sweep_t a = {0};
  a.near = neighbours_of(state, stride, &walls, state[FIELD_X * stride + i], DIMENSIONS == 3 ? state[FIELD_Y * stride + i] : R(0.0),
                         state[FIELD_Z * stride + i]);
  a.walls = &walls;
  a.shepard = R(1.0);
  sweep_particles(&a, p, cell_start, images);
#if !GHOSTS
  sweep_walls(&a, p, &walls, images, a.near.x, a.near.y, a.near.z);
#endif
  // a flat surface's first row has 0.75 of a full kernel, its second more than 0.95
  results[i] = a.weight < R(0.85) * bounded_shepard(a.shepard) ? R(1.0) : R(0.0);
  results[stride + i] = a.shepard;
}

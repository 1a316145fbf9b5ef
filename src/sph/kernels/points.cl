// The fluid at given points, in it or on a wall: the pressure of a probe, and how full the kernel is there (for gauges and the free surface).
#include "wall_element.cl"
#define SWEEP_PARTICLES
#define SWEEP_WALLS

typedef struct {
  __global const real* state;
  int stride;
  __global const real* walls;
  int wall_stride;
  real weight, pressure;
  real shepard;
  bool finding_touched;             // the walls' sweep looks for walls that the point lies on, instead of γ
  real inwards_x, inwards_y, inwards_z;  // Σ of their normals into the fluid
} sweep_t;

INLINE void add_particle(sweep_t* a, __constant const parameters_t* p, int j, real rx, real ry, real rz, real r2) {
  const real weight = kernel_value(p, sqrt(r2)) * a->state[FIELD_VOLUME * a->stride + j];
  const real density = p->density * (R(1.0) + a->state[FIELD_COMPRESSION * a->stride + j]);
  const real head = p->gravity_x * rx + p->gravity_y * ry + p->gravity_z * rz;
  a->weight += weight;
  a->pressure += weight * (a->state[FIELD_PRESSURE * a->stride + j] - density * head);
}

INLINE void add_wall(sweep_t* a, __constant const parameters_t* p, int s, real rx, real ry, real rz, real r2) {
  const wall_view_t view = view_wall(p, a->walls, a->wall_stride, s, rx, ry, rz);
  if (a->finding_touched) {
    const bool touched = view.over && fabs(view.distance) < LEAST_DISTANCE * p->spacing;
    a->inwards_x -= touched ? view.normal_x : R(0.0);
    a->inwards_y -= touched ? view.normal_y : R(0.0);
    a->inwards_z -= touched ? view.normal_z : R(0.0);
    return;
  }
  a->shepard += shepard_term(p, &view, r2);
}

#include "sweep.cl"

#define LEAST_FILLING R(0.5)

// γ at a point that may lie on walls: exactly in an edge or a corner it has no one value, so it is taken a hair off them, where a fluid's is.
INLINE void find_shepard(sweep_t* a, __constant const parameters_t* p, __global const int* wall_start, real x, real y, real z) {
  a->finding_touched = true;
  sweep_walls(a, p, wall_start, a->walls, a->wall_stride, x, y, z);
  // several elements of one wall may be touched: they count once
  const real size = fmax(fmax(fabs(a->inwards_x), fabs(a->inwards_y)), fmax(fabs(a->inwards_z), R(1.0)));
  const real hair = LEAST_DISTANCE * p->spacing / size;
  a->finding_touched = false;
  a->shepard = R(1.0);
  sweep_walls(a, p, wall_start, a->walls, a->wall_stride, x + hair * a->inwards_x, y + hair * a->inwards_y, z + hair * a->inwards_z);
}

// points: x, y, z fields; results: pressure (Pa; 0 in the air), Σ W V, γ.
__kernel void points(__constant const parameters_t* p, int count, __global const int* cell_start, __global const real* state, int stride,
                     __global const int* wall_start, __global const real* walls, int wall_stride, __global const real* points, __global real* results) {
  const int i = get_global_id(0);
  if (i >= count) return;
  sweep_t a = {0};
  a.state = state;
  a.stride = stride;
  a.walls = walls;
  a.wall_stride = wall_stride;
  const real x = points[i], y = points[count + i], z = points[2 * count + i];
  sweep_particles(&a, p, cell_start, state, stride, x, y, z);
  find_shepard(&a, p, wall_start, x, y, z);
  // where less than half of what the walls leave of the kernel is fluid, the air's zero pressure counts for the rest of that half: a droplet alone does
  // not tell the pressure around it
  results[i] = a.pressure / fmax(a.weight, LEAST_FILLING * bounded_shepard(a.shepard));
  results[count + i] = a.weight;
  results[2 * count + i] = a.shepard;
}

// Free surface: the particles whose kernel, beyond the walls' share, is not full. Written as 1 or 0, with γ beside it.
__kernel void surface(__constant const parameters_t* p, int count, __global const int* cell_start, __global const real* state, int stride,
                      __global const int* wall_start, __global const real* walls, int wall_stride, __global real* results) {
  const int i = get_global_id(0);
  if (i >= count) return;
  sweep_t a = {0};
  a.state = state;
  a.stride = stride;
  a.walls = walls;
  a.wall_stride = wall_stride;
  a.shepard = R(1.0);
  const real x = state[FIELD_X * stride + i];
  const real y = DIMENSIONS == 3 ? state[FIELD_Y * stride + i] : R(0.0);
  const real z = state[FIELD_Z * stride + i];
  sweep_particles(&a, p, cell_start, state, stride, x, y, z);
  sweep_walls(&a, p, wall_start, walls, wall_stride, x, y, z);
  // a flat surface's first row has 0.75 of a full kernel, its second more than 0.95
  results[i] = a.weight < R(0.85) * bounded_shepard(a.shepard) ? R(1.0) : R(0.0);
  results[stride + i] = a.shepard;
}

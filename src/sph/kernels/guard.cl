// Guard against penetration [G]: a particle nearer to a wall than the guard distance and approaching it loses its normal velocity relative to the wall;
// one that rounding or a violent step put behind the wall is set back onto it.
#include "wall_element.cl"
#define SWEEP_WALLS

typedef struct {
  __global const real* walls;
  int wall_stride;
  real x, y, z;  // how far it was set back
  real u, v, w;
  int hits;
} sweep_t;

INLINE void add_wall(sweep_t* a, __constant const parameters_t* p, int s, real rx, real ry, real rz, real r2) {
  // seen from where the elements before this one left the particle
  const wall_view_t view = view_wall(p, a->walls, a->wall_stride, s, rx - a->x, ry - a->y, rz - a->z);
  // behind a wall as far as half a spacing on the element itself, by no more than the guard distance beside it: there a body's own side may lie
  const real deepest = view.over ? -R(2.0) * BEHIND_TOLERANCE * p->spacing : -p->guard_distance;
  if (!view.near_over || view.distance > p->guard_distance || view.distance < deepest) return;
  const real approach = a->u * view.normal_x + a->v * view.normal_y + a->w * view.normal_z;
  if (approach > R(0.0)) {
    a->u -= approach * view.normal_x;
    a->v -= approach * view.normal_y;
    a->w -= approach * view.normal_z;
    a->hits += 1;
  }
  if (view.distance < R(0.0)) {
    a->x += view.distance * view.normal_x;
    a->y += view.distance * view.normal_y;
    a->z += view.distance * view.normal_z;
  }
}

#include "sweep.cl"

__kernel void guard(__constant const parameters_t* p, int count, __global const int* wall_start, __global const real* walls, int wall_stride,
                    __global const real* rates, __global real* state, int stride, __global int* hits) {
  const int i = get_global_id(0);
  if (i >= count) return;
  hits[i] = 0;
  // a step moves a particle by much less than a quarter of the spacing: who was further away than this cannot have come near
  if (rates[RATE_CLEARANCE * stride + i] > p->guard_distance + R(0.25) * p->spacing) return;
  sweep_t a = {0};
  a.walls = walls;
  a.wall_stride = wall_stride;
  a.u = state[FIELD_U * stride + i];
  a.v = DIMENSIONS == 3 ? state[FIELD_V * stride + i] : R(0.0);
  a.w = state[FIELD_W * stride + i];
  sweep_walls(&a, p, wall_start, walls, wall_stride, state[FIELD_X * stride + i], DIMENSIONS == 3 ? state[FIELD_Y * stride + i] : R(0.0),
              state[FIELD_Z * stride + i]);
  hits[i] = a.hits > 0 ? 1 : 0;
  state[FIELD_U * stride + i] = a.u;
  state[FIELD_W * stride + i] = a.w;
  state[FIELD_X * stride + i] += a.x;
  state[FIELD_Z * stride + i] += a.z;
#if DIMENSIONS == 3
  state[FIELD_V * stride + i] = a.v;
  state[FIELD_Y * stride + i] += a.y;
#endif
}

// What walls of different owners do to each other through water narrower than the support.
//
// A wall's own sum over the particles takes the water for all there is within the support. Behind the walls of another owner there is none, and that owner
// stands in for it: the wall has from it what water there would do, and it has the opposite from the wall. With p the pressure at a place s of the wall,
// n S its surface and b the part of the kernel at s that lies behind the other owner's walls (their part of 1 − γ), water behind them under this pressure
// would add 2 p b n S. Taken half from either side, so that what the one gets the other loses, it is p b n S from every place of both. In a gap of even
// width this makes the force on either wall the pressure's integral over it, however narrow the gap is: of the kernel at a wall what particles fill and
// what lies behind the other wall is one half together.
//
// A narrow gap may hold fewer particles than it has room for, or none: as far as that is so the water film acts (src/simulation/water_film.h), and less of
// this. Or a row more than fits, which Σ W V tells: then b is what the owner's own walls and the particles leave of the kernel.
#include "walls.cl"
#include "linear_fit.cl"
#define SWEEP_PARTICLES
#define SWEEP_WALLS

// As water_film.cpp has them: the filling of the room that walls leave where particles fill a gap; and of the spacing, up to the first the particles in a
// gap are counted, and from the second on it is filled as any water.
#define FULL_GAP R(0.85)
#define MOUTH_GAP R(0.65)
#define ROWS_GAP R(1.5)
#define NARROW_GAP R(2.0)
#define WIDE_GAP R(2.5)

typedef struct {
  neighbours_t near;
  vector_t gravity;
  tile_fit_t fit;
} sweep_t;

typedef struct {
  const walls_t* walls;
  int owner;
  vector_t normal;
  real own;                    // of the support, behind the owner's own walls
  real touched;                // ∫ W dS over them
  int others[FACING_OWNERS];
  bool seen[FACING_OWNERS];    // any of them
  real behind[FACING_OWNERS];  // of the support, behind each other owner's walls
  real gap[FACING_OWNERS];     // to those of them that face it
} wall_sweep_t;

INLINE void add_particle(sweep_t* a, __constant const parameters_t* p, int j, tile rx, tile ry, tile rz, tile r2) {
  const tile weight = kernel_values(p, sqrt(r2)) * near_volume(&a->near, j);
  const tile density = p->density * (R(1.0) + near_field(&a->near, FIELD_COMPRESSION, j));
  const tile head = a->gravity.x * rx + a->gravity.y * ry + a->gravity.z * rz;
  add_to_fit(&a->fit, weight, near_field(&a->near, FIELD_PRESSURE, j) - density * head, rx, ry, rz);
}

INLINE void add_wall(wall_sweep_t* a, __constant const parameters_t* p, int s, real x, real y, real z) {
  const int owner = (int)WALL_FIELD(a->walls, WALL_OWNER, s);
  const contact_t c = see_wall(p, a->walls, s, x, y, z);
  if (owner == a->owner) {
    a->own -= c.shepard;
    a->touched += c.weight;
    return;
  }
#if THIN_WALLS
  const contact_t all = touch_wall(p, a->walls, s, x, y, z);
#else
  const contact_t all = c;
#endif
  if (all.shepard == R(0.0)) return;
  // an owner beyond the last slot is left out on both sides
  int slot = 0;
  while (slot < FACING_OWNERS && a->others[slot] != NO_OWNER && a->others[slot] != owner) ++slot;
  if (slot == FACING_OWNERS) return;
  a->others[slot] = owner;
  // of an owner that is in sight, what the piece's own plate hides is behind it all the same
  a->seen[slot] = a->seen[slot] || c.weight > R(0.0);
  a->behind[slot] -= all.shepard;
  if (c.over && dot3(c.normal, a->normal) < FACING) a->gap[slot] = fmin(a->gap[slot], fabs(c.distance));
}

#include "sweep.cl"

// Of ∫ W dS in 1/h, which on a flat wall is about 3/4, and at an edge half of it.
#define LEAST_OWN R(0.15)

// As wall_loads.cl has it.
#define DRY R(0.01)

// Whether any other owner's walls may be within the support of a piece. `spheres`: about each owner at rest, centre and radius with the support and what a
// piece measures; a negative radius for what is everywhere.
INLINE bool may_face(__global const real* spheres, __global const real* poses, int owners, int owner, real x, real y, real z) {
  bool near = IMAGES;  // which bring walls to others far from them
  for (int o = 0; o < owners; ++o) {
    __global const real* sphere = spheres + 4 * o;
    __global const real* pose = poses + 12 * o;
    const vector_t centre = turned(pose, sphere[0], sphere[1], sphere[2]);
    const real dx = centre.x + pose[9] - x, dy = centre.y + pose[10] - y, dz = centre.z + pose[11] - z;
    near = near || (o != owner && (sphere[3] < R(0.0) || dx * dx + dy * dy + dz * dz < sphere[3] * sphere[3]));
  }
  return near;
}

// One piece of wall a work-item. `rest`: centre and area times normal, at rest; `poses`: of each owner, a rotation, row by row, and a shift. Results: where
// it is, and of each slot the force that the piece gets from another owner, or NO_OWNER.
__kernel void facing_walls(__constant const parameters_t* p, int count, __global const int* slot_start, __global const real* state, long stride, real reach,
                           WALL_ARGUMENTS, __global const real* images, __global const real* rest, __global const int* owners,
                           __global const real* poses, int owner_count, __global const real* spheres, __global real* places, __global int* others, __global real* forces) {
  const int s = get_global_id(0);
  if (s >= count) return;
  const int owner = owners[s];
  __global const real* pose = poses + 12 * owner;
  const vector_t moved = turned(pose, rest[s], rest[count + s], rest[2 * count + s]);
  const real x = moved.x + pose[9], y = moved.y + pose[10], z = moved.z + pose[11];
  for (int slot = 0; slot < FACING_OWNERS; ++slot) others[slot * count + s] = NO_OWNER;
#ifdef PARTED
  const int part_place = place_in_parts(p, x, y, z);
  if (part_place < p->own_begin || part_place >= p->own_end) return;
#endif
  if (!may_face(spheres, poses, owner_count, owner, x, y, z)) return;
  walls_t walls = WALLS_OF_ARGUMENTS;
  wall_sweep_t b = {0};
  b.walls = &walls;
  b.owner = owner;
  for (int slot = 0; slot < FACING_OWNERS; ++slot) {
    b.others[slot] = NO_OWNER;
    b.gap[slot] = p->support;
  }
  const vector_t surface = turned(pose, rest[3 * count + s], rest[4 * count + s], rest[5 * count + s]);
  const real inverse = R(1.0) / fmax(sqrt(dot3(surface, surface)), R(1.0e-30));
  b.normal = make_vector(inverse * surface.x, inverse * surface.y, inverse * surface.z);
  // off a thin wall, to its own side, or it would see both
  const real lift = THIN_WALLS ? -R(1.0e-3) * p->spacing : R(0.0);
  const real px = x + lift * b.normal.x, py = y + lift * b.normal.y, pz = z + lift * b.normal.z;
#if THIN_WALLS
  find_screen(p, &walls, px, py, pz);
#endif
  sweep_walls(&b, p, &walls, images, px, py, pz);
  // of a piece that lies inside another body the walls are not in the lists
  if (b.others[0] == NO_OWNER || b.touched * p->smoothing_length < LEAST_OWN) return;
  sweep_t a = {0};
  neighbours_at(&a.near, state, stride, reach, &walls, px, py, pz);
  a.gravity = gravity_at(p, &walls, px, py, pz, make_vector(R(0.0), R(0.0), R(0.0)));
  sweep_particles(&a, p, slot_start, images);
  linear_fit_t fit;
  own_fits(&a.fit, &fit);
  if (fit.weight <= DRY) return;
  real pressure = fitted_plane(p, &fit, make_vector(R(0.0), R(0.0), R(0.0))).value;
#if CLAMP_PRESSURE
  pressure = fmax(pressure, R(0.0));
#endif
  real gap = p->support, behind = R(0.0);
  for (int slot = 0; slot < FACING_OWNERS; ++slot) {
    gap = fmin(gap, b.gap[slot]);
    behind += b.seen[slot] ? b.behind[slot] : R(0.0);
  }
  gap /= p->spacing;
  const real room = fmax(R(1.0) - b.own - behind, R(0.05));
  const real closed = fmin(fmax((FILM_OPEN - gap) / (FILM_OPEN - FILM_CLOSED), R(0.0)), R(1.0));
  const real narrow = fmin(fmax((WIDE_GAP - gap) / (WIDE_GAP - NARROW_GAP), R(0.0)), R(1.0));
  const real at_mouth = MOUTH_GAP * fmin(fmax((ROWS_GAP - gap) / (ROWS_GAP - R(1.0)), R(0.0)), R(1.0));
  const real film = fmax(closed, narrow * fmin(fmax((FULL_GAP - fit.weight / room) / (FULL_GAP - at_mouth), R(0.0)), R(1.0)));
  const real crowded = narrow * fmax(fit.weight - room, R(0.0));
  const real open = (R(1.0) - film) * (behind > crowded ? R(1.0) - crowded / behind : R(0.0));
  places[s] = x;
  places[count + s] = y;
  places[2 * count + s] = z;
  for (int slot = 0; slot < FACING_OWNERS; ++slot) {
    if (b.others[slot] == NO_OWNER || !b.seen[slot]) continue;
    const real push = open * pressure * b.behind[slot];
    others[slot * count + s] = b.others[slot];
    forces[3 * slot * count + s] = push * surface.x;
    forces[(3 * slot + 1) * count + s] = push * surface.y;
    forces[(3 * slot + 2) * count + s] = push * surface.z;
  }
}

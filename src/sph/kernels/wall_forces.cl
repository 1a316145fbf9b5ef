// What the fluid does to one owner of walls, by the very sums of momentum_sums.cl: of each particle's force all that is not an exchange with other particles,
// V_i [(1/γ_i − 1) Σ_j … + 1/γ_i Σ_s …]. So the walls get exactly what the fluid loses, whatever the elements and the Shepard factor are.
// Where walls of several owners are near, each has its own Σ_s. The rest, (1/γ_i − 1) (Σ_j + Σ_s), is what is missing of the particle's exchange in the
// part of its support that lies behind walls; it is shared by how much of that part lies behind each. What the water missing behind one owner would do to
// another's walls is not here: facing_walls.cl.
#define WALL_FORCES 1
#define BOTH_RATES 0
#include "momentum_sums.cl"
#include "owner_region.cl"

// The owner's part of what is missing behind walls. Quadrature may make a part slightly negative.
INLINE real share_of_owner(const wall_sweep_t* b) {
#if SHEPARD_MONOLITHIC
  return b->touched / b->weight;  // its parts are no volumes close to a wall
#else
  if (b->touched == b->weight) return R(1.0);
  const real own = fmax(b->behind, R(0.0)), others = fmax(b->beyond - b->behind, R(0.0));
  return own + others > R(0.0) ? own / (own + others) : b->touched / b->weight;
#endif
}

// The owner's part of what a film between walls gets: it has no mass, and hands it on to the walls on either side alike.
INLINE real film_share_of_owner(const wall_sweep_t* b, __constant const parameters_t* p) {
  real own = R(0.0), all = R(0.0);
  for (int slot = 0; slot < NEAR_OWNERS && b->near_owners[slot] != NO_OWNER; ++slot) {
    const real weight = fmax(b->near_weights[slot], R(0.0)) * p->smoothing_length;
    const real part = weight / (weight + R(0.01));  // fades in where a wall comes near
    all += part;
    if (b->near_owners[slot] == b->owner) own = part;
  }
  return all > R(0.0) ? own / all : R(0.0);
}

INLINE vector_t mixed(real a, vector_t x, real b, vector_t y) { return make_vector(a * x.x + b * y.x, a * x.y + b * y.y, a * x.z + b * y.z); }

// Of ∫ W dS in 1/h, which is 3/4 on a flat wall: less is what rounding leaves of facets that end beyond the support.
#define LEAST_TOUCH R(5.0e-6)

// Whether particle i touches walls of the owner.
INLINE bool touches(__constant const parameters_t* p, int i, __global const real* state, long stride, const walls_t* walls, __global const real* images,
                    int owner) {
#if GHOSTS
  return true;
#else
  wall_sweep_t b = {0};
  start_wall_sums(&b, p, i, state, stride, walls, 0);
  b.owner = owner;
  b.looking = true;
  sweep_walls(&b, p, walls, images, b.x, b.y, b.z);
  return b.touched * p->smoothing_length > LEAST_TOUCH;
#endif
}

typedef struct {
  vector_t push, drag, place;  // pressure force, viscous force, and where they act
} owner_force_t;

// What particle i, the k-th of its tile, does to the walls of one owner, which it touches.
INLINE owner_force_t force_on_owner(__constant const parameters_t* p, int i, int k, const pair_sums_t* sums, __global const real* state, long stride,
                                    const walls_t* walls, __global const real* images, __global const real* wall_loads, __global const real* film,
                                    int owner) {
  owner_force_t f;
  wall_sweep_t b = {0};
  start_wall_sums(&b, p, i, state, stride, walls, wall_loads);
  b.owner = owner;
  for (int slot = 0; slot < NEAR_OWNERS; ++slot) b.near_owners[slot] = NO_OWNER;
  take_pair_sums(&b, p, sums, k);
#if GHOSTS
  repel(&b, p, images);
  f.push = make_vector(b.force_x, b.force_y, b.force_z);
  f.drag = make_vector(-b.viscous_x, -b.viscous_y, -b.viscous_z);
  f.place = make_vector(b.x, b.y, b.z);
#else
  const vector_t film_push = add_film(&b, p, film, images);  // goes through the film to the walls on either side of it
  sweep_walls(&b, p, walls, images, b.x, b.y, b.z);
  const real share = share_of_owner(&b);
  const real missing = (R(1.0) / bounded_shepard(b.shepard) - R(1.0)) * share;
  f.push = mixed(R(1.0), b.push, missing, make_vector(b.force_x, b.force_y, b.force_z));
  f.push = mixed(R(1.0), f.push, film_share_of_owner(&b, p), film_push);
#if THIN_WALLS
  f.push = mixed(R(1.0), f.push, p->slope_scale, make_vector(sums->across.x[k], sums->across.y[k], sums->across.z[k]));
#endif
#if FRICTION_LAWS
  f.drag = mixed(R(-1.0), b.drag, R(0.0), b.drag);
#else
  f.drag = mixed(R(-1.0), b.drag, missing, make_vector(-b.viscous_x, -b.viscous_y, -b.viscous_z));
#endif
  const real inverse = R(1.0) / b.touched;
  f.place = make_vector(b.touched_at.x * inverse, b.touched_at.y * inverse, b.touched_at.z * inverse);
#endif
  const real volume = state[FIELD_VOLUME * stride + i];
  f.push = mixed(volume, f.push, R(0.0), f.push);
  f.drag = mixed(volume, f.drag, R(0.0), f.drag);
  return f;
}

// Per run of slots of an owner's region: Σ of pressure force, viscous force and their torques about the owner's centre.
__kernel void wall_forces(__constant const parameters_t* p, int count, __global const int* slot_start, __global const real* state, long stride, real reach,
                          WALL_ARGUMENTS, __global const real* images, __global const real* gradient, __global const real* wall_loads, __global const real* film, int regions,
                          __global const int* region_values, __global real* wrenches) {
  const int item = get_global_id(0);
  if (item >= count) return;
  walls_t walls = WALLS_OF_ARGUMENTS;
  const owner_run_t run = run_of_owner(p, slot_start, item, regions, region_values);
  const int owner = run.owner, end = run.end;
  __global const real* centre = OWNER_MOTION(wall_motions, owner);
  wrench_t wrench = {{R(0.0)}};
  for (int first = run.begin; first < end; first += TILE_OWN) {
    bool touching[TILE_OWN];
    bool any = false;
    for (int own = 0; own < TILE_OWN; ++own) {
#if THIN_WALLS
      walls.share = R(0.0);
      if (first + own < end) find_screen(p, &walls, state[FIELD_X * stride + first + own], state[FIELD_Y * stride + first + own], state[FIELD_Z * stride + first + own]);
#endif
      if (first + own < end) stand_at(&walls, state, stride, first + own);
      touching[own] = first + own < end && touches(p, first + own, state, stride, &walls, images, owner);
      any = any || touching[own];
    }
    if (!any) continue;
    sweep_t a = {0};
    start_sums(&a, p, first, end, state, stride, reach, &walls, gradient);
#if THIN_WALLS
    a.near.watched = owner;
#endif
#if GHOSTS
    sweep_ghosts(&a, p, slot_start, images);
#else
    sweep_particles(&a, p, slot_start, images);
#endif
    pair_sums_t sums;
    finish_particles(&a, &sums);
    for (int own = 0; own < TILE_OWN; ++own) {
      if (!touching[own]) continue;
      stand_at(&walls, state, stride, first + own);
      LOOK_THROUGH(walls, a.near, own);
      const owner_force_t f = force_on_owner(p, first + own, own, &sums, state, stride, &walls, images, wall_loads, film, owner);
      const vector_t arm = make_vector(f.place.x - centre[0], f.place.y - centre[1], f.place.z - centre[2]);
      add_to_wrench(&wrench, f.push, f.drag, arm);
    }
  }
  write_wrench(&wrench, item, wrenches);
}

// Momentum of δ-SPH, eqs (35, its sign corrected) and (37) of the particle shifting paper, with the wall's share of the geometric Shepard paper:
//   du/dt = −1/(γ ρ_i) [Σ_j (p_i+p_j) ∇W V_j + Σ_s (p_i+p_s) n W S − viscosity] + g
// One pass over the neighbours, the Shepard factor γ included. On elements the wall's pressure p_s is the one found at their centre; facets have no
// place for it, so there it is the plane fitted about the particle itself, p̂ + ∇p̂·(y − x_i), with what hydrostatics explains added by gravity less the wall's
// acceleration: ∫ p W dS = p̂ ∫ W dS + [∇p̂ + ρ_i (g − a)]·∫ (y − x_i) W dS. Not p_i itself: in 3-D tanks at rest that lets pressures oscillate until they
// are a fifth of ρ g H.
//
// Built with WALL_FORCES, the same sums give what the fluid does to one owner of walls: of each particle's force all that is not an exchange with other
// particles, V_i [(1/γ_i − 1) Σ_j … + 1/γ_i Σ_s …]. So the walls get exactly what the fluid loses, whatever the elements and the Shepard factor are.
// Where walls of several owners are near, each has its own Σ_s. The rest, (1/γ_i − 1) (Σ_j + Σ_s), is what is missing of the particle's exchange in the
// part of its support that lies behind walls; it is shared by how much of that part lies behind each. What the water missing behind one owner would do to
// another's walls is not here: facing_walls.cl.
#include "walls.cl"
#include "film.cl"
#include "linear_fit.cl"
#define SWEEP_PARTICLES
#define SWEEP_WALLS
#define NEAR_OWNERS (FACING_OWNERS + 2)
#define NEEDS_FIT (FACETS || THIN_WALLS)

typedef struct {
  neighbours_t near;
  tile u, v, w, pressure;
#if NEEDS_FIT
  bool fitting;  // there are walls to fit a plane for
  tile_fit_t fit;
#if MOVING_FRAME
  tile_vector_t gravity;
#endif
#endif
  tile force_x, force_y, force_z;  // Σ (p_i+p_j) ∇W V, less the viscosity along the line of centres, which WALL_FORCES keeps apart
#if WALL_FORCES && THIN_WALLS
  tile across_x, across_y, across_z;  // of that the part of neighbours that thin walls hide: it goes through the wall, which has it
#endif
#if WALL_FORCES || VISCOSITY_MORRIS
  tile viscous_x, viscous_y, viscous_z;
#endif
#if SHEPARD_VOLUMETRIC
  tile shepard;
#endif
} sweep_t;

typedef struct {
  const walls_t* walls;
  __global const real* wall_loads;
  real x, y, z, u, v, w, pressure, density;
  vector_t gravity;
  real force_x, force_y, force_z;
  real viscous_x, viscous_y, viscous_z;
  real shepard, clearance;
#if NEEDS_FIT
  bool fitting;
  linear_fit_t fit;
  plane_t fitted;  // once all particles are in the fit
#endif
#if WALL_FORCES
  int owner;
  bool looking;          // only for whether the owner's walls are near
  real weight, touched;  // Σ ∫ W dS over all walls and over the owner's
  real beyond, behind;   // of the support, what lies beyond all walls and what behind the owner's
  vector_t touched_at;   // Σ ∫ y W dS over the owner's
  vector_t push, drag;   // of the owner's walls
  int near_owners[NEAR_OWNERS];  // whose walls are near, and Σ ∫ W dS over them
  real near_weights[NEAR_OWNERS];
#endif
} wall_sweep_t;

INLINE void add_particle(sweep_t* a, __constant const parameters_t* p, int j, tile rx, tile ry, tile rz, tile r2) {
  const tile volume = near_volume(&a->near, j);
  const tile distance = sqrt(r2);
  const tile slope_volume = kernel_slopes(p, distance) * volume;
#if SHEPARD_VOLUMETRIC
  a->shepard += kernel_values(p, distance) * volume;
#endif
  const tile pressure = neighbour_pressure(&a->near, p, j, rx, ry, rz);
#if NEEDS_FIT
  if (a->fitting) {
#if MOVING_FRAME
    const tile head = tile_dot(a->gravity, make_tile_vector(rx, ry, rz));
#elif DIMENSIONS == 3
    const tile head = p->gravity_x * rx + p->gravity_y * ry + p->gravity_z * rz;
#else
    const tile head = p->gravity_x * rx + p->gravity_z * rz;
#endif
    add_to_fit(&a->fit, kernel_values(p, distance) * volume, pressure - p->density * head, rx, ry, rz);
  }
#endif
  const tile_vector_t velocity = neighbour_velocity(&a->near, j);
  const tile du = velocity.x - a->u;
  const tile dw = velocity.z - a->w;
#if DIMENSIONS == 3
  const tile dv = velocity.y - a->v;
  const tile approach = du * rx + dv * ry + dw * rz;
#else
  const tile approach = du * rx + dw * rz;
#endif
  // only against a division by zero: the 0.01 h² of the papers makes the viscosity 2 to 5 % too small
  const tile inverse = R(1.0) / (r2 + R(1.0e-4) * p->smoothing_length * p->smoothing_length);
#if VISCOSITY_MORRIS
  // isotropic for the physical viscosity (MLS paper, eq 14); the artificial one acts along the line of centres all the same
  const tile shear = R(2.0) * p->viscosity * slope_volume;
  a->viscous_x += shear * du;
  a->viscous_z += shear * dw;
#if DIMENSIONS == 3
  a->viscous_y += shear * dv;
#endif
#endif
#if WALL_FORCES
  const tile friction = slope_volume * p->pair_viscosity * approach * inverse;
  a->viscous_x += friction * rx;
  a->viscous_y += friction * ry;
  a->viscous_z += friction * rz;
  const tile central = slope_volume * (a->pressure + pressure);
#else
  const tile central = slope_volume * (a->pressure + pressure - p->pair_viscosity * approach * inverse);
#endif
  a->force_x += central * rx;
  a->force_z += central * rz;
#if DIMENSIONS == 3
  a->force_y += central * ry;
#endif
#if WALL_FORCES && THIN_WALLS
  if (a->near.hiding) {
    a->across_x += central * rx;
    a->across_y += central * ry;
    a->across_z += central * rz;
  }
#endif
}

#if NEEDS_FIT
INLINE plane_t plane_of_fit(const wall_sweep_t* a, __constant const parameters_t* p, vector_t added_slope) {
  plane_t plane = fitted_plane(p, &a->fit, added_slope);
#if CLAMP_PRESSURE
  plane.value = fmax(plane.value, R(0.0));
#endif
  return plane;
}

INLINE void finish_fit(wall_sweep_t* a, __constant const parameters_t* p) { a->fitted = plane_of_fit(a, p, make_vector(R(0.0), R(0.0), R(0.0))); }

// ∫ (p_i + p) W dS with the fitted plane for p. Where the wall accelerates, what is taken out before the fit and added after it is hydrostatics in its frame.
INLINE real fitted_push(const wall_sweep_t* a, __constant const parameters_t* p, const contact_t* c, vector_t gravity) {
#if MOVING_WALLS
  if (!a->fitting || c->weight == R(0.0)) return R(0.0);  // no wall is near, and there may be no fit
  const plane_t plane = plane_of_fit(a, p, make_vector(p->density * (a->gravity.x - gravity.x), p->density * (a->gravity.y - gravity.y),
                                                       p->density * (a->gravity.z - gravity.z)));
#else
  const plane_t plane = a->fitted;
#endif
  const vector_t slope = make_vector(plane.slope_x + a->density * gravity.x, plane.slope_y + a->density * gravity.y, plane.slope_z + a->density * gravity.z);
  return (a->pressure + plane.value) * c->weight + dot3(slope, c->moment);
}
#endif

#if VISCOSITY_MORRIS
#define WALL_DRAG R(1.0)
#else
#define WALL_DRAG ((DIMENSIONS + R(2.0)) / (DIMENSIONS + R(1.0)))
#endif

#if WALL_FORCES
// An owner beyond the last slot is left out of a film's forces, whichever owner's forces are looked for.
INLINE void count_owner(wall_sweep_t* a, int owner, real weight) {
  if (weight == R(0.0)) return;
  int slot = 0;
  while (slot < NEAR_OWNERS && a->near_owners[slot] != NO_OWNER && a->near_owners[slot] != owner) ++slot;
  if (slot == NEAR_OWNERS) return;
  a->near_owners[slot] = owner;
  a->near_weights[slot] += weight;
}
#endif

INLINE void add_wall(wall_sweep_t* a, __constant const parameters_t* p, int s, real x, real y, real z) {
  const contact_t c = see_wall(p, a->walls, s, x, y, z);
#if WALL_FORCES
  const bool own = a->owner == (int)WALL_FIELD(a->walls, WALL_OWNER, s);
  if (own) a->touched += c.weight;
  if (a->looking) return;
  a->weight += c.weight;
  a->beyond -= c.shepard;
  if (own) a->behind -= c.shepard;
  count_owner(a, (int)WALL_FIELD(a->walls, WALL_OWNER, s), c.weight);
#endif
#if SHEPARD_GEOMETRIC
  a->shepard += c.shepard;
#endif
  const real clearance = wall_clearance(p, &c);
  a->clearance = clearance < a->clearance ? clearance : a->clearance;
  const real foot_x = x + c.distance * c.normal.x, foot_y = y + c.distance * c.normal.y, foot_z = z + c.distance * c.normal.z;
#if FACETS
  const real push = fitted_push(a, p, &c, gravity_at_wall(p, a->walls, s, foot_x, foot_y, foot_z, make_vector(a->u, a->v, a->w)));
#else
  const real push = (a->pressure + a->wall_loads[s]) * c.weight;
#endif
  a->force_x += push * c.normal.x;
  a->force_y += push * c.normal.y;
  a->force_z += push * c.normal.z;
#if WALL_FORCES
  if (own) {
    a->push = make_vector(a->push.x + push * c.normal.x, a->push.y + push * c.normal.y, a->push.z + push * c.normal.z);
    // from where the particle is, also if the wall is an image's
    a->touched_at = make_vector(a->touched_at.x + c.weight * a->x + c.moment.x, a->touched_at.y + c.weight * a->y + c.moment.y,
                                a->touched_at.z + c.weight * a->z + c.moment.z);
  }
#endif
#if NO_SLIP
  // the velocity falls to the wall's over the distance from it; nearer than half a spacing that is taken as half a spacing. In a uniform shear this balances
  // what the particles on the other side exert, which for Monaghan and Gingold's sum is (d+2)/(d+1) times as much as for an isotropic one.
  const vector_t wall = wall_velocity(a->walls, s, c.normal, foot_x, foot_y, foot_z);
  const vector_t relative = make_vector(a->u - wall.x, a->v - wall.y, a->w - wall.z);
  const real normal_speed = dot3(relative, c.normal);
  const real drag = R(2.0) * WALL_DRAG * p->viscosity * c.weight / fmax(fabs(c.distance), R(0.5) * p->spacing);
  a->viscous_x -= drag * (relative.x - normal_speed * c.normal.x);
  a->viscous_y -= drag * (relative.y - normal_speed * c.normal.y);
  a->viscous_z -= drag * (relative.z - normal_speed * c.normal.z);
#if WALL_FORCES
  if (own)
    a->drag = make_vector(a->drag.x - drag * (relative.x - normal_speed * c.normal.x), a->drag.y - drag * (relative.y - normal_speed * c.normal.y),
                          a->drag.z - drag * (relative.z - normal_speed * c.normal.z));
#endif
#endif
}

#if GHOSTS
// Short-range repulsion by the foot of the particle on each plane ([B] of docs/numerics.md, §4): Lennard–Jones with exponents 4 and 2, from half a spacing on, and no harder than
// at a tenth of it.
INLINE void add_repulsion(wall_sweep_t* a, __constant const parameters_t* p, __global const real* images) {
  for (int k = 0; k < p->images; ++k) {
    __global const real* image = images + k * IMAGE_COUNT;
    if (image[IMAGE_MIRRORED] < R(0.5) || image[IMAGE_NEAR + 4] != R(0.0) || image[IMAGE_NEAR + 5] != R(0.0) || image[IMAGE_NEAR + 6] != R(0.0)) continue;
    __global const real* plane = image + IMAGE_NEAR;
    const real distance = plane[0] * a->x + plane[1] * a->y + plane[2] * a->z + plane[3];
    const real reach = R(0.5) * p->spacing;
    if (distance >= reach) continue;
    const real d = fmax(distance, R(0.2) * reach);
    const real ratio2 = reach * reach / (d * d);
    const real force = p->repulsion * a->density * (ratio2 * ratio2 - ratio2) / d;
    // n·x + o is the distance: n points into the fluid
    a->viscous_x += force * plane[0];
    a->viscous_y += force * plane[1];
    a->viscous_z += force * plane[2];
  }
}
#endif

#include "sweep.cl"

#if NEEDS_FIT
// Whether (x, y, z) may be within the support of a wall.
INLINE bool near_walls(__constant const parameters_t* p, const walls_t* walls, real x, real y, real z) {
#if FACETS && !IMAGES && !THIN_WALLS
  const int cell = cell_index(p, x, y, z);
  bool near = false;
  for (int k = walls->start[cell]; k < walls->start[cell + 1]; ++k) {
    __global const real* fields = walls->fields + walls->list[k] * walls->stride;
    near = near || fabs(plane_distance(fields, x, y, z)) < p->support;
  }
  return near;
#else
  return true;
#endif
}
#endif

// The sums of the tile that begins with particle `first`.
INLINE void start_sums(sweep_t* a, __constant const parameters_t* p, int first, int end, __global const real* state, int stride, real reach,
                       const walls_t* walls) {
  neighbours_of(&a->near, state, stride, reach, walls, first, end);
  a->u = own_values(state + FIELD_U * stride, first);
  a->v = own_values(state + FIELD_V * stride, first);
  a->w = own_values(state + FIELD_W * stride, first);
  a->pressure = own_values(state + FIELD_PRESSURE * stride, first);
#if NEEDS_FIT
  a->fitting = true;
#if MOVING_FRAME
  places_t gravity;
  for (int k = 0; k < TILE_OWN; ++k) {
    const vector_t own = gravity_at(p, walls, a->near.places.x[k], a->near.places.y[k], a->near.places.z[k], velocity_of(state, stride, first + k));
    gravity.x[k] = own.x;
    gravity.y[k] = own.y;
    gravity.z[k] = own.z;
  }
  a->gravity = make_tile_vector(spread_own(gravity.x), spread_own(gravity.y), spread_own(gravity.z));
#endif
#endif
}

INLINE void start_wall_sums(wall_sweep_t* b, __constant const parameters_t* p, int i, __global const real* state, int stride, const walls_t* walls,
                            __global const real* wall_loads) {
  b->walls = walls;
  b->wall_loads = wall_loads;
  b->x = state[FIELD_X * stride + i];
  b->y = DIMENSIONS == 3 ? state[FIELD_Y * stride + i] : R(0.0);
  b->z = state[FIELD_Z * stride + i];
  const vector_t own = velocity_of(state, stride, i);
  b->u = own.x;
  b->v = own.y;
  b->w = own.z;
  b->pressure = state[FIELD_PRESSURE * stride + i];
  b->density = p->density * (R(1.0) + state[FIELD_COMPRESSION * stride + i]);
  b->gravity = gravity_at(p, walls, b->x, b->y, b->z, own);
  b->shepard = SHEPARD_START;
  b->clearance = p->support;
}

// What the sweep over the particles has found for each of the tile's own.
typedef struct {
  places_t force;
#if WALL_FORCES && THIN_WALLS
  places_t across;
#endif
#if WALL_FORCES || VISCOSITY_MORRIS
  places_t viscous;
#endif
#if SHEPARD_VOLUMETRIC
  real shepard[TILE_OWN];
#endif
#if NEEDS_FIT
  bool fitting;
  linear_fit_t fit[TILE_OWN];
#endif
} pair_sums_t;

INLINE void finish_particles(const sweep_t* a, pair_sums_t* s) {
  own_sums(a->force_x, s->force.x);
  own_sums(a->force_y, s->force.y);
  own_sums(a->force_z, s->force.z);
#if WALL_FORCES && THIN_WALLS
  own_sums(a->across_x, s->across.x);
  own_sums(a->across_y, s->across.y);
  own_sums(a->across_z, s->across.z);
#endif
#if WALL_FORCES || VISCOSITY_MORRIS
  own_sums(a->viscous_x, s->viscous.x);
  own_sums(a->viscous_y, s->viscous.y);
  own_sums(a->viscous_z, s->viscous.z);
#endif
#if SHEPARD_VOLUMETRIC
  own_sums(a->shepard, s->shepard);
#endif
#if NEEDS_FIT
  s->fitting = a->fitting;
  if (a->fitting) own_fits(&a->fit, s->fit);
#endif
}

INLINE void take_pair_sums(wall_sweep_t* b, __constant const parameters_t* p, const pair_sums_t* s, int k) {
  b->force_x = p->slope_scale * s->force.x[k];
  b->force_y = p->slope_scale * s->force.y[k];
  b->force_z = p->slope_scale * s->force.z[k];
#if WALL_FORCES || VISCOSITY_MORRIS
  b->viscous_x = p->slope_scale * s->viscous.x[k];
  b->viscous_y = p->slope_scale * s->viscous.y[k];
  b->viscous_z = p->slope_scale * s->viscous.z[k];
#endif
#if SHEPARD_VOLUMETRIC
  b->shepard = s->shepard[k];
#endif
#if NEEDS_FIT
  b->fitting = s->fitting;
  b->fit = s->fit[k];
  if (b->fitting) finish_fit(b, p);
#endif
}

// What the film presses on particle i with, once its pressure is known; added to the other sums.
INLINE vector_t add_film(wall_sweep_t* b, __constant const parameters_t* p, __global const real* film, __global const real* images) {
  const vector_t push = film_sum(p, b->walls, film, images, b->pressure, R(1.0), b->x, b->y, b->z);
  b->force_x += push.x;
  b->force_y += push.y;
  b->force_z += push.z;
  return push;
}

#if WALL_FORCES
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
INLINE bool touches(__constant const parameters_t* p, int i, __global const real* state, int stride, const walls_t* walls, __global const real* images,
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
INLINE owner_force_t force_on_owner(__constant const parameters_t* p, int i, int k, const pair_sums_t* sums, __global const real* state, int stride,
                                    const walls_t* walls, __global const real* images, __global const real* wall_loads, __global const real* film,
                                    int owner) {
  owner_force_t f;
  wall_sweep_t b = {0};
  start_wall_sums(&b, p, i, state, stride, walls, wall_loads);
  b.owner = owner;
  for (int slot = 0; slot < NEAR_OWNERS; ++slot) b.near_owners[slot] = NO_OWNER;
  take_pair_sums(&b, p, sums, k);
#if GHOSTS
  add_repulsion(&b, p, images);
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
  const real through = share * p->slope_scale;
  f.push = mixed(R(1.0), f.push, through, make_vector(sums->across.x[k], sums->across.y[k], sums->across.z[k]));
#endif
  f.drag = mixed(R(-1.0), b.drag, missing, make_vector(-b.viscous_x, -b.viscous_y, -b.viscous_z));
  const real inverse = R(1.0) / b.touched;
  f.place = make_vector(b.touched_at.x * inverse, b.touched_at.y * inverse, b.touched_at.z * inverse);
#endif
  const real volume = state[FIELD_VOLUME * stride + i];
  f.push = mixed(volume, f.push, R(0.0), f.push);
  f.drag = mixed(volume, f.drag, R(0.0), f.drag);
  return f;
}

// Per run of slots of an owner's region: Σ of pressure force, viscous force and their torques about the owner's centre.
__kernel void wall_forces(__constant const parameters_t* p, int count, __global const int* slot_start, __global const real* state, int stride, real reach,
                          WALL_ARGUMENTS, __global const real* images, __global const real* wall_loads, __global const real* film, int regions,
                          __global const int* region_values, __global real* wrenches) {
  const int item = get_global_id(0);
  if (item >= count) return;
  walls_t walls = WALLS_OF_ARGUMENTS;
  int k = 0;
  while (k + 1 < regions && item >= region_values[(k + 1) * REGION_COUNT + REGION_ITEM]) ++k;
  __global const int* region = region_values + k * REGION_COUNT;
  const int owner = region[REGION_OWNER];
  __global const real* centre = OWNER_MOTION(wall_motions, owner);
  const int in_region = item - region[REGION_ITEM];
  const int run = in_region % region[REGION_RUNS], row = in_region / region[REGION_RUNS];
  const int first_slot = region[REGION_SLOT_X] + run * REGION_RUN;
  const int end_slot = min(first_slot + REGION_RUN, region[REGION_END_X]);
  const int line = p->slots_x * row_index(p, region[REGION_ROW_Y] + row % region[REGION_ROWS], region[REGION_ROW_Z] + row / region[REGION_ROWS]);
  const int end = slot_start[line + end_slot];
  const vector_t nothing = make_vector(R(0.0), R(0.0), R(0.0));
  vector_t push = nothing, drag = nothing, push_torque = nothing, drag_torque = nothing;
  for (int first = slot_start[line + first_slot]; first < end; first += TILE_OWN) {
    bool touching[TILE_OWN];
    bool any = false;
    for (int own = 0; own < TILE_OWN; ++own) {
#if THIN_WALLS
      walls.share = R(0.0);
      if (first + own < end) find_screen(p, &walls, state[FIELD_X * stride + first + own], state[FIELD_Y * stride + first + own], state[FIELD_Z * stride + first + own]);
#endif
      touching[own] = first + own < end && touches(p, first + own, state, stride, &walls, images, owner);
      any = any || touching[own];
    }
    if (!any) continue;
    sweep_t a = {0};
    start_sums(&a, p, first, end, state, stride, reach, &walls);
#if GHOSTS
    sweep_ghosts(&a, p, slot_start, images);
#else
    sweep_particles(&a, p, slot_start, images);
#endif
    pair_sums_t sums;
    finish_particles(&a, &sums);
    for (int own = 0; own < TILE_OWN; ++own) {
      if (!touching[own]) continue;
      LOOK_THROUGH(walls, a.near, a.near.places.x[own], a.near.places.y[own], a.near.places.z[own]);
      const owner_force_t f = force_on_owner(p, first + own, own, &sums, state, stride, &walls, images, wall_loads, film, owner);
      const vector_t arm = make_vector(f.place.x - centre[0], f.place.y - centre[1], f.place.z - centre[2]);
      push = mixed(R(1.0), push, R(1.0), f.push);
      drag = mixed(R(1.0), drag, R(1.0), f.drag);
      push_torque = mixed(R(1.0), push_torque, R(1.0), cross3(arm, f.push));
      drag_torque = mixed(R(1.0), drag_torque, R(1.0), cross3(arm, f.drag));
    }
  }
  const vector_t sums[4] = {push, drag, push_torque, drag_torque};
  for (int part = 0; part < 4; ++part) {
    wrenches[WRENCH_COUNT * item + 3 * part] = sums[part].x;
    wrenches[WRENCH_COUNT * item + 3 * part + 1] = sums[part].y;
    wrenches[WRENCH_COUNT * item + 3 * part + 2] = sums[part].z;
  }
}
#else
__kernel void momentum(__constant const parameters_t* p, int count, __global const int* slot_start, __global const real* state, int stride, real reach,
                       WALL_ARGUMENTS, __global const real* images, __global const real* wall_loads, __global const real* film, __global real* rates) {
  const int first = TILE_OWN * get_global_id(0);
  if (first >= count) return;
  walls_t walls = WALLS_OF_ARGUMENTS;
  sweep_t a = {0};
  start_sums(&a, p, first, count, state, stride, reach, &walls);
#if NEEDS_FIT
  bool near = false;
  for (int k = 0; k < a.near.own; ++k) near = near || near_walls(p, &walls, a.near.places.x[k], a.near.places.y[k], a.near.places.z[k]);
  // the fit costs as much as all else in the loop over the particles: two loops, so that the compiler leaves it out of one
  if (near) {
    sweep_particles(&a, p, slot_start, images);
  } else {
    a.fitting = false;
    sweep_particles(&a, p, slot_start, images);
  }
#else
  sweep_particles(&a, p, slot_start, images);
#endif
  pair_sums_t sums;
  finish_particles(&a, &sums);
  for (int k = 0; k < a.near.own; ++k) {
    const int i = first + k;
    wall_sweep_t b = {0};
    start_wall_sums(&b, p, i, state, stride, &walls, wall_loads);
    take_pair_sums(&b, p, &sums, k);
#if GHOSTS
    b.clearance = R(0.0);  // the guard looks for itself
    add_repulsion(&b, p, images);
#else
    add_film(&b, p, film, images);
    LOOK_THROUGH(walls, a.near, b.x, b.y, b.z);
    sweep_walls(&b, p, &walls, images, b.x, b.y, b.z);
#endif
    const real per_mass = R(1.0) / (bounded_shepard(b.shepard) * b.density);
    rates[RATE_U * stride + i] = (b.viscous_x - b.force_x) * per_mass + b.gravity.x;
    rates[RATE_V * stride + i] = DIMENSIONS == 3 ? (b.viscous_y - b.force_y) * per_mass + b.gravity.y : R(0.0);
    rates[RATE_W * stride + i] = (b.viscous_z - b.force_z) * per_mass + b.gravity.z;
    rates[RATE_CLEARANCE * stride + i] = b.clearance;
  }
}
#endif

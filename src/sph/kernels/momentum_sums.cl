// Momentum, eqs (35, its sign corrected) and (37) of the particle shifting paper, with the wall's share of the geometric Shepard paper:
//   du/dt = −1/(γ ρ_i) [Σ_j (p_i+p_j) ∇W V_j + Σ_s (p_i+p_s) n W S − viscosity] + g
// The scheme (scheme/) says what a pair has for p_i + p_j, and the viscosity (viscosity/) what it adds.
// One pass over the neighbours, the Shepard factor γ included. On elements the wall's pressure p_s is the one found at their centre; facets have no
// place for it, so there it is the plane fitted about the particle itself, p̂ + ∇p̂·(y − x_i), with what hydrostatics explains added by gravity less the wall's
// acceleration: ∫ p W dS = p̂ ∫ W dS + [∇p̂ + ρ_i (g − a)]·∫ (y − x_i) W dS. Not p_i itself: in 3-D tanks at rest that lets pressures oscillate until they
// are a fifth of ρ g H.
// For momentum.cl, for rates.cl, which finds the other rates in the same sweep (BOTH_RATES), and for wall_forces.cl, which defines WALL_FORCES.
#include "walls.cl"
#include "film.cl"
#include "linear_fit.cl"
#include "pair.cl"
#include "equation_of_state.cl"
#include "scheme.cl"
#include "viscosity.cl"
#include "turbulence.cl"
#include "friction.cl"
#include "repulsion.cl"
#if BOTH_RATES
#include "continuity_sums.cl"
#endif
#define SWEEP_PARTICLES
#define SWEEP_WALLS
#define NEAR_OWNERS (FACING_OWNERS + 2)
// what one particle gives another walls have no part in
#define CARRIES_MOMENTUM (EXCHANGES_MASS && !WALL_FORCES)
#define NEEDS_FIT (FACETS || THIN_WALLS)
// The viscosity along the line of centres is summed apart: for forces on walls, and where a law of friction says what walls take, so that 1/γ, which
// makes up for the neighbours that walls have in the place of water, makes no shear of its own there.
#define VISCOSITY_APART (WALL_FORCES || FRICTION_LAWS)

typedef struct {
  neighbours_t near;
  __global const real* gradient;
  tile u, v, w;
  scheme_own_t own;
#if NEEDS_FIT
  bool fitting;  // there are walls to fit a plane for
  tile_fit_t fit;
#if MOVING_FRAME
  tile_vector_t gravity;
#endif
#endif
  tile force_x, force_y, force_z;  // Σ (p_i+p_j) ∇W V, less the viscosity along the line of centres unless it is apart
#if WALL_FORCES && THIN_WALLS
  tile across_x, across_y, across_z;  // of that the part of neighbours that the watched owner's thin walls hide: it goes through them, who have it
#endif
#if VISCOSITY_APART || VISCOSITY_SHEARS
  tile viscous_x, viscous_y, viscous_z;
#endif
#if EDDIES
  tile eddies;
#endif
#if CARRIES_MOMENTUM
  tile own_shepard;
  tile carried_x, carried_y, carried_z;  // what the mass that is exchanged brings, by the mean of both ends' γ
#endif
#if BOTH_RATES
  continuity_t continuity;
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
#if BOTH_RATES
  vector_t motion;
  real divergence;
#endif
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
#if NEEDS_FIT
  if (a->fitting) {
    const tile pressure = neighbour_pressure(&a->near, p, j, rx, ry, rz);
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
  const pair_t pair = pair_of(&a->near, j, rx, ry, rz, r2, distance, slope_volume, a->u, a->v, a->w);
  const exchange_t exchange = pair_exchange(&a->own, p, &a->near, a->gradient, &pair);
  // only against a division by zero: the 0.01 h² of the papers makes the viscosity 2 to 5 % too small
  const tile inverse = R(1.0) / (r2 + R(1.0e-4) * p->smoothing_length * p->smoothing_length);
#if VISCOSITY_SHEARS
  const tile shear = pair_shear(p, &pair);
  a->viscous_x += shear * pair.relative.x;
  a->viscous_z += shear * pair.relative.z;
#if DIMENSIONS == 3
  a->viscous_y += shear * pair.relative.y;
#endif
#endif
#if EDDIES
  const tile pair_viscosity = p->pair_viscosity + a->eddies + near_values(a->gradient + GRADIENT_EDDIES * a->near.stride, j);
#else
  const real pair_viscosity = p->pair_viscosity;
#endif
#if VISCOSITY_APART
  const tile friction = slope_volume * pair_viscosity * pair.approach * inverse;
  a->viscous_x += friction * rx;
  a->viscous_y += friction * ry;
  a->viscous_z += friction * rz;
  const tile central = slope_volume * exchange.pressure;
#else
  const tile central = slope_volume * (exchange.pressure - pair_viscosity * pair.approach * inverse);
#endif
  a->force_x += central * rx;
  a->force_z += central * rz;
#if DIMENSIONS == 3
  a->force_y += central * ry;
#endif
#if CARRIES_MOMENTUM
  const tile shared = shared_shepard(&a->near, a->gradient, a->own_shepard, j);
  const tile mass = slope_volume * exchange.mass * shared;
  a->carried_x += mass * exchange.carried.x;
  a->carried_z += mass * exchange.carried.z;
#if DIMENSIONS == 3
  a->carried_y += mass * exchange.carried.y;
#endif
#endif
#if BOTH_RATES
#if !CARRIES_MOMENTUM
  const tile shared = (tile)(R(1.0));
#endif
  add_to_continuity(&a->continuity, p, &a->near, a->gradient, &pair, &exchange, shared);
#endif
#if WALL_FORCES && THIN_WALLS
  const tile across = a->near.through * central;
  a->across_x += across * rx;
  a->across_y += across * ry;
  a->across_z += across * rz;
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
#if BOTH_RATES
  a->divergence += wall_divergence(a->walls, s, &c, a->motion, x, y, z);
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
  const vector_t along = make_vector(relative.x - normal_speed * c.normal.x, relative.y - normal_speed * c.normal.y, relative.z - normal_speed * c.normal.z);
  const real from_wall = fmax(fabs(c.distance), R(0.5) * p->spacing);
#if FRICTION_LAWS
  // not on what stands behind the wall's plane, beside it
  const bool touches = c.weight != R(0.0) && c.distance > -BEHIND_TOLERANCE * p->spacing;
  const real drag = touches ? R(2.0) * c.weight * friction_by_law(p, MOTION_OF(a->walls, s) + MOTION_FRICTION, from_wall, along) : R(0.0);
#else
  const real drag = R(2.0) * WALL_DRAG * p->viscosity * c.weight / from_wall;
#endif
  a->viscous_x -= drag * along.x;
  a->viscous_y -= drag * along.y;
  a->viscous_z -= drag * along.z;
#if WALL_FORCES
  if (own) a->drag = make_vector(a->drag.x - drag * along.x, a->drag.y - drag * along.y, a->drag.z - drag * along.z);
#endif
#endif
}

#if GHOSTS
INLINE void repel(wall_sweep_t* a, __constant const parameters_t* p, __global const real* images) {
  vector_t force = make_vector(a->viscous_x, a->viscous_y, a->viscous_z);
  add_repulsion(&force, p, images, a->x, a->y, a->z, a->density);
  a->viscous_x = force.x;
  a->viscous_y = force.y;
  a->viscous_z = force.z;
}
#endif

#include "sweep.cl"

#if NEEDS_FIT
// Whether (x, y, z) may be within the support of a wall.
INLINE bool near_walls(__constant const parameters_t* p, const walls_t* walls, real x, real y, real z) {
#if FACETS && !IMAGES
  const int cell = cell_index(p, x, y, z);
  bool near = false;
  for (int k = walls->start[cell]; k < walls->start[cell + 1]; ++k) {
    __global const real* fields = walls->fields + walls->list[k] * walls->wall_stride;
    near = near || fabs(plane_distance(walls, fields, x, y, z)) < p->support;
  }
  return near;
#else
  return true;
#endif
}
#endif

// The sums of the tile that begins with particle `first`.
INLINE void start_sums(sweep_t* a, __constant const parameters_t* p, int first, int end, __global const real* state, long stride, real reach,
                       const walls_t* walls, __global const real* gradient) {
  neighbours_of(&a->near, state, stride, reach, walls, first, end);
  a->u = own_values(state + FIELD_U * stride, first);
  a->v = own_values(state + FIELD_V * stride, first);
  a->w = own_values(state + FIELD_W * stride, first);
  a->gradient = gradient;
  a->own = scheme_own(p, &a->near, gradient, first);
#if EDDIES
  a->eddies = own_values(gradient + GRADIENT_EDDIES * stride, first);
#endif
#if CARRIES_MOMENTUM
  a->own_shepard = own_values(gradient + GRADIENT_SHEPARD * stride, first);
#endif
#if BOTH_RATES && DENSITY_DIFFUSION
  start_diffusion(&a->continuity.diffusion, p, &a->near, gradient, first);
#endif
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

INLINE void start_wall_sums(wall_sweep_t* b, __constant const parameters_t* p, int i, __global const real* state, long stride, const walls_t* walls,
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
#if VISCOSITY_APART || VISCOSITY_SHEARS
  places_t viscous;
#endif
#if CARRIES_MOMENTUM
  places_t carried;
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
#if VISCOSITY_APART || VISCOSITY_SHEARS
  own_sums(a->viscous_x, s->viscous.x);
  own_sums(a->viscous_y, s->viscous.y);
  own_sums(a->viscous_z, s->viscous.z);
#endif
#if CARRIES_MOMENTUM
  own_sums(a->carried_x, s->carried.x);
  own_sums(a->carried_y, s->carried.y);
  own_sums(a->carried_z, s->carried.z);
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
#if VISCOSITY_APART || VISCOSITY_SHEARS
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
  const vector_t push = film_push(p, b->walls, film, images, b->pressure, R(1.0), b->x, b->y, b->z);
  b->force_x += push.x;
  b->force_y += push.y;
  b->force_z += push.z;
  return push;
}

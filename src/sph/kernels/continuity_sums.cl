// Continuity of δ-SPH, eqs (33) and (36) of the particle shifting paper, with the wall's share of the geometric Shepard paper:
//   ds/dt = −(1+s)/√γ [Σ_j (u_j−u_i)·∇W V_j + Σ_s (u_s−u_i)·n W S] + diffusion/γ,   s = ρ/ρ₀ − 1
// One pass over the neighbours, the Shepard factor γ included. The scheme (scheme/) says what a pair has for (u_j−u_i)·r, and the density diffusion
// (density_diffusion/) what it adds.
//
// The paper has 1/γ before the bracket and 1 before the diffusion. With it sound gains from every wall that it meets, and water eight rows deep rings by
// itself: the walls' part of the divergence is not the transpose of that of the pressure's gradient, (p_i + p_s) n W S, and cannot be while both are right
// for linear fields. Twice the walls' part would be it, and is calm, but the bracket then no longer vanishes where water turns along a wall: impacts get a
// quarter more. √γ and the diffusion's 1/γ leave what has no divergence as it is, and let each sound in a tank decay (docs/numerics.md).
//
// What the diffusion does steadily is taken out of it. At rest the sums of the momentum want some excess of pressure in the uppermost row; the diffusion
// would carry it downwards, the row sink and be compressed again, and so pump pressure into the whole depth.
//
// For continuity.cl, and for rates.cl, which finds accelerations in the same sweep.
#include "density_diffusion.cl"

typedef struct {
  tile divergence;
#if EXCHANGES_MASS
  tile mass;
#endif
#if DENSITY_DIFFUSION
  diffusion_t diffusion;
#endif
} continuity_t;

// `shared`: shared_shepard() of the pair, of which only an exchange of mass needs to know.
INLINE void add_to_continuity(continuity_t* c, __constant const parameters_t* p, const neighbours_t* n, __global const real* gradient, const pair_t* pair,
                              const exchange_t* exchange, tile shared) {
  c->divergence += exchange->divergence * pair->slope_volume;
#if EXCHANGES_MASS
  c->mass += exchange->mass * pair->slope_volume * shared;
#endif
#if DENSITY_DIFFUSION
  add_diffusion(&c->diffusion, p, n, gradient, pair);
#endif
}

// What a wall adds to the divergence, by the velocity that the particle moves with.
INLINE real wall_divergence(const walls_t* walls, int s, const contact_t* c, vector_t motion, real x, real y, real z) {
  const vector_t wall = wall_velocity(walls, s, c->normal, x + c->distance * c->normal.x, y + c->distance * c->normal.y, z + c->distance * c->normal.z);
  return dot3(make_vector(wall.x - motion.x, wall.y - motion.y, wall.z - motion.z), c->normal) * c->weight;
}

// Of each of the tile's own particles.
typedef struct {
  real divergence[TILE_OWN];
#if EXCHANGES_MASS
  real mass[TILE_OWN];
#endif
#if DENSITY_DIFFUSION
  real diffusion[TILE_OWN];
#endif
} continuity_sums_t;

INLINE void finish_continuity(const continuity_t* c, continuity_sums_t* sums) {
  own_sums(c->divergence, sums->divergence);
#if EXCHANGES_MASS
  own_sums(c->mass, sums->mass);
#endif
#if DENSITY_DIFFUSION
  own_sums(c->diffusion.sum, sums->diffusion);
#endif
}

// Volumes follow the velocity that the particle moves with, where the scheme lets that be another than the water's.
INLINE vector_t motion_of(__global const real* state, long stride, int i) {
  vector_t own = velocity_of(state, stride, i);
#if EXCHANGES_MASS && defined(FIELD_SHIFT_X)
  own.x += state[FIELD_SHIFT_X * stride + i];
  own.y += DIMENSIONS == 3 ? state[FIELD_SHIFT_Y * stride + i] : R(0.0);
  own.z += state[FIELD_SHIFT_Z * stride + i];
#endif
  return own;
}

// The rates of particle i, the k-th of its tile; `divergence` with the walls' part.
INLINE void write_continuity(__constant const parameters_t* p, __global const real* state, long stride, int i, const continuity_sums_t* sums, int k,
                             real divergence, real shepard, __global real* rates) {
  const real renormalise = RENORMALISE_DIVERGENCE && DIVERGENCE_RENORMALISED ? rsqrt(bounded_shepard(shepard)) : R(1.0);
#if DENSITY_DIFFUSION
  const real spread = renormalise * renormalise * R(2.0) * p->density_diffusion * p->slope_scale * sums->diffusion[k];
  const real steady = state[FIELD_STEADY * stride + i];
  rates[RATE_COMPRESSION * stride + i] = spread - steady - renormalise * (R(1.0) + state[FIELD_COMPRESSION * stride + i]) * divergence;
  rates[RATE_STEADY * stride + i] = p->steady_rate * (clamp(spread, -p->steady_limit, p->steady_limit) - steady);
#else
  rates[RATE_COMPRESSION * stride + i] = -renormalise * (R(1.0) + state[FIELD_COMPRESSION * stride + i]) * divergence;
#endif
#if EXCHANGES_MASS
  rates[RATE_COMPRESSION * stride + i] -= p->slope_scale * sums->mass[k] / p->density;
  rates[RATE_VOLUME * stride + i] = state[FIELD_VOLUME * stride + i] * renormalise * divergence;
#endif
  rates[RATE_SHEPARD * stride + i] = shepard;
}

// Continuity of δ-SPH, eqs (33) and (36) of the particle shifting paper, with the wall's share of the geometric Shepard paper:
//   ds/dt = −(1+s)/√γ [Σ_j (u_j−u_i)·∇W V_j + Σ_s (u_s−u_i)·n W S] + diffusion/γ,   s = ρ/ρ₀ − 1
// One pass over the neighbours, the Shepard factor γ included.
//
// The paper has 1/γ before the bracket and 1 before the diffusion. With it sound gains from every wall that it meets, and water eight rows deep rings by
// itself: the walls' part of the divergence is not the transpose of that of the pressure's gradient, (p_i + p_s) n W S, and cannot be while both are right
// for linear fields. Twice the walls' part would be it, and is calm, but the bracket then no longer vanishes where water turns along a wall: impacts get a
// quarter more. √γ and the diffusion's 1/γ leave what has no divergence as it is, and let each sound in a tank decay (docs/numerics.md).
//
// What the diffusion does steadily is taken out of it. At rest the sums of the momentum want some excess of pressure in the uppermost row; the diffusion
// would carry it downwards, the row sink and be compressed again, and so pump pressure into the whole depth.
#include "walls.cl"
#define SWEEP_PARTICLES
#define SWEEP_WALLS

typedef struct {
  neighbours_t near;
#if DIFFUSION_ANTUONO
  __global const real* gradient;
  tile_vector_t own_gradient;
#endif
  tile u, v, w, compression;
#if DIFFUSION_FOURTAKAS && MOVING_FRAME
  tile_vector_t hydrostatic;  // gradient of the compression
  vector_t spin;
  real half_inverse;  // ρ/(2K)
#endif
  tile divergence, diffusion;
#if SHEPARD_VOLUMETRIC
  tile shepard;
#endif
} sweep_t;

typedef struct {
  const walls_t* walls;
  real u, v, w;
  real divergence, shepard;
} wall_sweep_t;

#if DIFFUSION_FOURTAKAS
// The difference in compression that hydrostatics explains, linearised.
INLINE tile explained_difference(const sweep_t* a, __constant const parameters_t* p, tile_vector_t relative, tile rx, tile ry, tile rz) {
#if MOVING_FRAME
  // by the mean of gravity at either end, so that what one gains the other loses: centrifugal and Coriolis' forces differ between them
  const tile_vector_t apart = make_tile_vector(rx, ry, rz);
  const tile_vector_t around = tile_cross(a->spin, apart);
  const tile_vector_t carried = tile_cross(a->spin, relative);
  return tile_dot(a->hydrostatic, apart) + a->half_inverse * (tile_dot(around, around) - R(2.0) * tile_dot(carried, apart));
#elif DIMENSIONS == 3
  return p->hydrostatic_x * rx + p->hydrostatic_y * ry + p->hydrostatic_z * rz;
#else
  return p->hydrostatic_x * rx + p->hydrostatic_z * rz;
#endif
}
#endif

INLINE void add_particle(sweep_t* a, __constant const parameters_t* p, int j, tile rx, tile ry, tile rz, tile r2) {
  const tile volume = near_volume(&a->near, j);
  const tile distance = sqrt(r2);
  const tile slope_volume = kernel_slopes(p, distance) * volume;
  const tile_vector_t velocity = neighbour_velocity(&a->near, j);
  const tile_vector_t relative = make_tile_vector(velocity.x - a->u, DIMENSIONS == 3 ? velocity.y - a->v : (tile)(R(0.0)), velocity.z - a->w);
  tile approach = relative.x * rx + relative.z * rz;
#if DIMENSIONS == 3
  approach += relative.y * ry;
#endif
  a->divergence += approach * slope_volume;
#if SHEPARD_VOLUMETRIC
  a->shepard += kernel_values(p, distance) * volume;
#endif

#if DIFFUSION_FOURTAKAS || DIFFUSION_ANTUONO
  const tile difference = neighbour_compression(&a->near, p, j, rx, ry, rz) - a->compression;
#endif
#if DIFFUSION_FOURTAKAS
  // of the dynamic density only: what hydrostatics explains is not diffused; twice this, once all is summed
  a->diffusion += slope_volume * (difference - explained_difference(a, p, relative, rx, ry, rz));
#elif DIFFUSION_ANTUONO
  const long stride = a->near.stride;
  tile_vector_t gradient = make_tile_vector(near_values(a->gradient, j), DIMENSIONS == 3 ? near_values(a->gradient + stride, j) : (tile)(R(0.0)),
                                            near_values(a->gradient + 2 * stride, j));
#if GHOSTS
  if (a->near.mirrored) gradient = turned(a->near.image + IMAGE_MATRIX, gradient.x, gradient.y, gradient.z);
#endif
  tile explained = (a->own_gradient.x + gradient.x) * rx + (a->own_gradient.z + gradient.z) * rz;
#if DIMENSIONS == 3
  explained += (a->own_gradient.y + gradient.y) * ry;
#endif
  a->diffusion += slope_volume * (difference - R(0.5) * explained);
#endif
}

INLINE void add_wall(wall_sweep_t* a, __constant const parameters_t* p, int s, real x, real y, real z) {
  const contact_t c = see_wall(p, a->walls, s, x, y, z);
#if SHEPARD_GEOMETRIC
  a->shepard += c.shepard;
#endif
  const vector_t wall = wall_velocity(a->walls, s, c.normal, x + c.distance * c.normal.x, y + c.distance * c.normal.y, z + c.distance * c.normal.z);
  a->divergence += dot3(make_vector(wall.x - a->u, wall.y - a->v, wall.z - a->w), c.normal) * c.weight;
}

#include "sweep.cl"

__kernel void continuity(__constant const parameters_t* p, int count, __global const int* slot_start, __global const real* state, long stride,
                         real reach, WALL_ARGUMENTS, __global const real* images, __global const real* gradient, __global real* rates) {
  const int first = TILE_OWN * get_global_id(0);
  if (first >= count) return;
  walls_t walls = WALLS_OF_ARGUMENTS;
  sweep_t a = {0};
  neighbours_of(&a.near, state, stride, reach, &walls, first, count);
#if DIFFUSION_ANTUONO
  a.gradient = gradient;
  a.own_gradient = make_tile_vector(own_values(gradient, first), own_values(gradient + stride, first), own_values(gradient + 2 * stride, first));
#endif
  a.u = own_values(state + FIELD_U * stride, first);
  a.v = own_values(state + FIELD_V * stride, first);
  a.w = own_values(state + FIELD_W * stride, first);
  a.compression = own_values(state + FIELD_COMPRESSION * stride, first);
#if DIFFUSION_FOURTAKAS && MOVING_FRAME
  const real inverse = p->density / p->bulk_modulus;
  places_t hydrostatic;
  for (int k = 0; k < TILE_OWN; ++k) {
    const vector_t gravity = gravity_at(p, &walls, a.near.places.x[k], a.near.places.y[k], a.near.places.z[k], velocity_of(state, stride, first + k));
    hydrostatic.x[k] = gravity.x * inverse;
    hydrostatic.y[k] = gravity.y * inverse;
    hydrostatic.z[k] = gravity.z * inverse;
  }
  a.hydrostatic = make_tile_vector(spread_own(hydrostatic.x), spread_own(hydrostatic.y), spread_own(hydrostatic.z));
  a.spin = motion_vector(walls.motions, 1);
  a.half_inverse = R(0.5) * inverse;
#endif
  sweep_particles(&a, p, slot_start, images);
  real divergence[TILE_OWN], diffusion[TILE_OWN];
  own_sums(a.divergence, divergence);
  own_sums(a.diffusion, diffusion);
#if SHEPARD_VOLUMETRIC
  real shepard[TILE_OWN];
  own_sums(a.shepard, shepard);
#endif

  for (int k = 0; k < TILE_OWN; ++k) {
    const int i = first + k;
    if (i >= count) return;
    const vector_t own = velocity_of(state, stride, i);
#if SHEPARD_VOLUMETRIC
    wall_sweep_t b = {&walls, own.x, own.y, own.z, p->slope_scale * divergence[k], shepard[k]};
#else
    wall_sweep_t b = {&walls, own.x, own.y, own.z, p->slope_scale * divergence[k], SHEPARD_START};
#endif
#if !GHOSTS
    stand_at(&walls, state, stride, i);
    LOOK_THROUGH(walls, a.near, k);
    sweep_walls(&b, p, &walls, images, a.near.places.x[k], a.near.places.y[k], a.near.places.z[k]);
#endif
    // Antuono's diffusion hardly sees the slowest sound, and needs more
#if RENORMALISE_DIVERGENCE && !DIFFUSION_ANTUONO
    const real renormalise = rsqrt(bounded_shepard(b.shepard));
#else
    const real renormalise = R(1.0);
#endif
    const real spread = renormalise * renormalise * R(2.0) * p->density_diffusion * p->slope_scale * diffusion[k];
    const real steady = state[FIELD_STEADY * stride + i];
    rates[RATE_COMPRESSION * stride + i] = spread - steady - renormalise * (R(1.0) + state[FIELD_COMPRESSION * stride + i]) * b.divergence;
    rates[RATE_STEADY * stride + i] = p->steady_rate * (clamp(spread, -p->steady_limit, p->steady_limit) - steady);
    rates[RATE_SHEPARD * stride + i] = b.shepard;
  }
}

// Continuity of δ-SPH, eqs (33) and (36) of the particle shifting paper, with the wall's share of the geometric Shepard paper:
//   ds/dt = −(1+s)/γ [Σ_j (u_j−u_i)·∇W V_j + Σ_s (u_s−u_i)·n W S] + diffusion,   s = ρ/ρ₀ − 1
// One pass over the neighbours, the Shepard factor γ included.
#include "walls.cl"
#define SWEEP_PARTICLES
#define SWEEP_WALLS

typedef struct {
  neighbours_t near;
  const walls_t* walls;
#if DIFFUSION_ANTUONO
  __global const real* gradient;
  real gradient_x, gradient_y, gradient_z;
#endif
  real u, v, w, compression;
#if DIFFUSION_FOURTAKAS
  vector_t hydrostatic;  // gradient of the compression
#if MOVING_FRAME
  vector_t spin;
  real half_inverse;  // ρ/(2K)
#endif
#endif
  real divergence, diffusion;
  real shepard;
} sweep_t;

INLINE void add_particle(sweep_t* a, __constant const parameters_t* p, int j, real rx, real ry, real rz, real r2) {
  const real volume = a->near.state[FIELD_VOLUME * a->near.stride + j];
  const real distance = sqrt(r2);
  const real slope_volume = kernel_slope(p, distance) * volume;
  const vector_t velocity = neighbour_velocity(&a->near, j);
  real approach = (velocity.x - a->u) * rx + (velocity.z - a->w) * rz;
#if DIMENSIONS == 3
  approach += (velocity.y - a->v) * ry;
#endif
  a->divergence += approach * slope_volume;
#if SHEPARD_VOLUMETRIC
  a->shepard += kernel_value(p, distance) * volume;
#endif

#if DIFFUSION_FOURTAKAS || DIFFUSION_ANTUONO
  const real difference = neighbour_compression(&a->near, p, j, rx, ry, rz) - a->compression;
#endif
#if DIFFUSION_FOURTAKAS
  // of the dynamic density only: what hydrostatics explains, linearised, is not diffused
  real explained = a->hydrostatic.x * rx + a->hydrostatic.z * rz;
#if DIMENSIONS == 3
  explained += a->hydrostatic.y * ry;
#endif
#if MOVING_FRAME
  // up to the mean of gravity at either end, so that what one gains the other loses: centrifugal and Coriolis' forces differ between them
  const vector_t apart = make_vector(rx, ry, rz);
  const vector_t around = cross3(a->spin, apart);
  const vector_t carried = cross3(a->spin, make_vector(velocity.x - a->u, DIMENSIONS == 3 ? velocity.y - a->v : R(0.0), velocity.z - a->w));
  explained += a->half_inverse * (dot3(around, around) - R(2.0) * dot3(carried, apart));
#endif
  a->diffusion += R(2.0) * slope_volume * (difference - explained);
#elif DIFFUSION_ANTUONO
  vector_t gradient = make_vector(a->gradient[j], a->gradient[a->near.stride + j], a->gradient[2 * a->near.stride + j]);
#if GHOSTS
  if (a->near.mirrored) gradient = turned(a->near.image + IMAGE_MATRIX, gradient.x, gradient.y, gradient.z);
#endif
  real explained = (a->gradient_x + gradient.x) * rx + (a->gradient_z + gradient.z) * rz;
#if DIMENSIONS == 3
  explained += (a->gradient_y + gradient.y) * ry;
#endif
  a->diffusion += slope_volume * (R(2.0) * difference - explained);
#endif
}

INLINE void add_wall(sweep_t* a, __constant const parameters_t* p, int s, real x, real y, real z) {
  const contact_t c = see_wall(p, a->walls, s, x, y, z);
#if SHEPARD_GEOMETRIC
  a->shepard += c.shepard;
#endif
  const vector_t wall = wall_velocity(a->walls, s, c.normal, x + c.distance * c.normal.x, y + c.distance * c.normal.y, z + c.distance * c.normal.z);
  a->divergence += dot3(make_vector(wall.x - a->u, wall.y - a->v, wall.z - a->w), c.normal) * c.weight;
}

#include "sweep.cl"

__kernel void continuity(__constant const parameters_t* p, int count, __global const int* cell_start, __global const real* state, int stride,
                         WALL_ARGUMENTS, __global const real* images, __global const real* gradient, __global real* rates) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const walls_t walls = WALLS_OF_ARGUMENTS;
  sweep_t a = {0};
  a.near = neighbours_of(state, stride, &walls, state[FIELD_X * stride + i], DIMENSIONS == 3 ? state[FIELD_Y * stride + i] : R(0.0),
                         state[FIELD_Z * stride + i]);
  a.walls = &walls;
#if DIFFUSION_ANTUONO
  a.gradient = gradient;
  a.gradient_x = gradient[i];
  a.gradient_y = DIMENSIONS == 3 ? gradient[stride + i] : R(0.0);
  a.gradient_z = gradient[2 * stride + i];
#endif
  a.u = state[FIELD_U * stride + i];
  a.v = DIMENSIONS == 3 ? state[FIELD_V * stride + i] : R(0.0);
  a.w = state[FIELD_W * stride + i];
  a.compression = state[FIELD_COMPRESSION * stride + i];
  a.shepard = SHEPARD_START;
#if DIFFUSION_FOURTAKAS
#if MOVING_FRAME
  const vector_t gravity = gravity_at(p, &walls, a.near.x, a.near.y, a.near.z, make_vector(a.u, a.v, a.w));
  const real inverse = p->density / p->bulk_modulus;
  a.hydrostatic = make_vector(gravity.x * inverse, gravity.y * inverse, gravity.z * inverse);
  a.spin = motion_vector(walls.motions, 1);
  a.half_inverse = R(0.5) * inverse;
#else
  a.hydrostatic = make_vector(p->hydrostatic_x, p->hydrostatic_y, p->hydrostatic_z);
#endif
#endif
  sweep_particles(&a, p, cell_start, images);
#if !GHOSTS
  sweep_walls(&a, p, &walls, images, a.near.x, a.near.y, a.near.z);
#endif
  const real renormalise = RENORMALISE_DIVERGENCE ? R(1.0) / bounded_shepard(a.shepard) : R(1.0);
  rates[RATE_COMPRESSION * stride + i] = -(R(1.0) + a.compression) * a.divergence * renormalise + p->density_diffusion * a.diffusion;
  rates[RATE_SHEPARD * stride + i] = a.shepard;
}

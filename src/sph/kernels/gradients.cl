// Renormalised gradients ⟨∇f⟩ = L Σ_j (f_j − f_i) ∇W V_j with L = (Σ_j r ⊗ ∇W V_j)⁻¹ over the fluid: of the compression, for Antuono's density diffusion and
// Riemann problems, and of the velocity (GRADIENT_OF_VELOCITY), or the rate of strain that follows from that (GRADIENT_OF_STRAIN); where
// particles exchange mass, γ beside them, and the eddy viscosity by the rate of strain. As pair.cl has them in the array.
#define KEEPS_BLOCKS
#include "walls.cl"
#include "pair.cl"
#include "turbulence.cl"
#define SWEEP_PARTICLES
#define ASKS_WALLS (GRADIENTS_AND_SHEPARD || EDDIES)
#if ASKS_WALLS
#define SWEEP_WALLS
#endif
#define VELOCITIES (GRADIENT_OF_VELOCITY || GRADIENT_OF_STRAIN)
#define QUANTITIES (VELOCITIES ? 4 : 1)

typedef struct {
  neighbours_t near;
  tile own[QUANTITIES];
  tile sum_x[QUANTITIES], sum_y[QUANTITIES], sum_z[QUANTITIES];
  tile xx, xy, xz, yy, yz, zz;
#if GRADIENTS_AND_SHEPARD && SHEPARD_VOLUMETRIC
  tile shepard;
#endif
} sweep_t;

#if ASKS_WALLS
typedef struct {
  const walls_t* walls;
  real shepard;
  real clearance;
} wall_sweep_t;

INLINE void add_wall(wall_sweep_t* a, __constant const parameters_t* p, int s, real x, real y, real z) {
  const contact_t c = see_wall(p, a->walls, s, x, y, z);
#if SHEPARD_GEOMETRIC
  a->shepard += c.shepard;
#endif
#if EDDIES
  a->clearance = fmin(a->clearance, wall_clearance(p, &c));
#endif
}
#endif

#if PIERCED && EDDIES
// From what there is of the image's one plane, `above` which the point is: before a gap, from the nearest of its edges.
INLINE real distance_past_gaps(__constant const parameters_t* p, __global const real* images, int image, real above, real x, real y, real z) {
  __global const real* gap;
  real distance = above;
  for (int left = gaps_of_image(p, images, image, &gap); left > 0; --left, gap = next_gap(gap)) {
    const real beside = way_beside_gap(gap, above, x, y, z);
    if (beside < R(0.0)) distance = sqrt(above * above + beside * beside);
  }
  return distance;
}
#endif

#if GHOSTS && EDDIES
// From the nearest of the planes that mirror; of an image in two or three planes each has one of its own, unless it is an end that repeats itself.
INLINE real distance_from_planes(__constant const parameters_t* p, __global const real* images, real x, real y, real z) {
  real nearest = p->support;
  for (int k = 0; k < p->images; ++k) {
    __global const real* image = images + k * IMAGE_COUNT;
    if (image[IMAGE_MIRRORED] < R(0.5)) continue;
    __global const real* plane = image + IMAGE_NEAR;
    if (plane[4] != R(0.0) || plane[5] != R(0.0) || plane[6] != R(0.0)) continue;
#if PIERCED
    nearest = fmin(nearest, distance_past_gaps(p, images, k, plane[0] * x + plane[1] * y + plane[2] * z + plane[3], x, y, z));
#else
    nearest = fmin(nearest, plane[0] * x + plane[1] * y + plane[2] * z + plane[3]);
#endif
  }
  return nearest;
}
#endif

#if VELOCITIES
// S:S of the velocity's gradients.
INLINE real strain_squared(real gradients[QUANTITIES][TILE_OWN][3], int k) {
  real sum = R(0.0);
  for (int of = 0; of < 3; ++of)
    for (int axis = 0; axis < 3; ++axis) {
      const real strain = R(0.5) * (gradients[1 + of][k][axis] + gradients[1 + axis][k][of]);
      sum += strain * strain;
    }
  return sum;
}
#endif

// Σ of a difference times ∇W V, of which (wx, wy, wz) is V ∇W. δ-SPH keeps the order of products that it has always had.
INLINE void add_difference(sweep_t* a, int of, tile slope_volume, tile difference, tile rx, tile ry, tile rz, tile wx, tile wy, tile wz) {
#if HAS_BLOCK_LIST
  a->sum_x[of] += difference * wx;
  a->sum_z[of] += difference * wz;
#if DIMENSIONS == 3
  a->sum_y[of] += difference * wy;
#endif
#else
  const tile weighted = slope_volume * difference;
  a->sum_x[of] += weighted * rx;
  a->sum_z[of] += weighted * rz;
#if DIMENSIONS == 3
  a->sum_y[of] += weighted * ry;
#endif
#endif
}

INLINE void add_particle(sweep_t* a, __constant const parameters_t* p, int j, tile rx, tile ry, tile rz, tile r2) {
  const tile slope_volume = kernel_slopes(p, sqrt(r2)) * near_volume(&a->near, j);
  const tile wx = slope_volume * rx, wy = slope_volume * ry, wz = slope_volume * rz;
#if GRADIENTS_AND_SHEPARD && SHEPARD_VOLUMETRIC
  a->shepard += kernel_values(p, sqrt(r2)) * near_volume(&a->near, j);
#endif
  add_difference(a, 0, slope_volume, neighbour_compression(&a->near, p, j, rx, ry, rz) - a->own[0], rx, ry, rz, wx, wy, wz);
#if VELOCITIES
  const tile_vector_t velocity = neighbour_velocity(&a->near, j);
  add_difference(a, 1, slope_volume, velocity.x - a->own[1], rx, ry, rz, wx, wy, wz);
#if DIMENSIONS == 3
  add_difference(a, 2, slope_volume, velocity.y - a->own[2], rx, ry, rz, wx, wy, wz);
#endif
  add_difference(a, 3, slope_volume, velocity.z - a->own[3], rx, ry, rz, wx, wy, wz);
#endif
  a->xx += wx * rx;
  a->xz += wx * rz;
  a->zz += wz * rz;
#if DIMENSIONS == 3
  a->xy += wx * ry;
  a->yy += wy * ry;
  a->yz += wy * rz;
#endif
}

#include "sweep.cl"

// L as a scale and the cofactors of its inverse. A matrix that is nearly singular (a particle of a thin jet) gives no gradient to trust: zero is taken.
typedef struct {
  real scale, xx, xy, xz, yy, yz, zz;
} renormalisation_t;

INLINE renormalisation_t renormalisation_of(real xx, real xy, real xz, real yy, real yz, real zz) {
  const real least = R(1.0e-3);
#if DIMENSIONS == 3
  renormalisation_t l = {R(0.0), yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy, xx * zz - xz * xz, xy * xz - xx * yz, xx * yy - xy * xy};
  const real determinant = xx * l.xx + xy * l.xy + xz * l.xz;
#else
  renormalisation_t l = {R(0.0), zz, R(0.0), -xz, R(0.0), R(0.0), xx};
  const real determinant = xx * zz - xz * xz;
#endif
  l.scale = determinant > least ? R(1.0) / determinant : R(0.0);
  return l;
}

INLINE void renormalise(const renormalisation_t* l, real x, real y, real z, real* gradient) {
#if DIMENSIONS == 3
  gradient[0] = l->scale * (l->xx * x + l->xy * y + l->xz * z);
  gradient[1] = l->scale * (l->xy * x + l->yy * y + l->yz * z);
  gradient[2] = l->scale * (l->xz * x + l->yz * y + l->zz * z);
#else
  gradient[0] = l->scale * (l->xx * x + l->xz * z);
  gradient[1] = R(0.0);
  gradient[2] = l->scale * (l->xz * x + l->zz * z);
#endif
}

__kernel void gradients(__constant const parameters_t* p, int count, __global const int* slot_start, __global const real* state, long stride, real reach,
                        WALL_ARGUMENTS, __global const real* images, __global real* gradient, __global int* blocks) {
  TAKE_TILE(first, count)
  walls_t walls = WALLS_OF_ARGUMENTS;
  sweep_t a = {0};
  neighbours_of(&a.near, state, stride, reach, &walls, first, count);
  USE_BLOCK_LIST(a.near)
  a.own[0] = own_values(state + FIELD_COMPRESSION * stride, first);
#if VELOCITIES
  for (int axis = 0; axis < 3; ++axis) a.own[1 + axis] = own_values(state + (FIELD_U + axis) * stride, first);
#endif
  sweep_particles(&a, p, slot_start, images);
  real xx[TILE_OWN], xy[TILE_OWN], xz[TILE_OWN], yy[TILE_OWN], yz[TILE_OWN], zz[TILE_OWN];
  own_sums(a.xx, xx);
  own_sums(a.xy, xy);
  own_sums(a.xz, xz);
  own_sums(a.yy, yy);
  own_sums(a.yz, yz);
  own_sums(a.zz, zz);
  const real f = p->slope_scale;
  renormalisation_t l[TILE_OWN];
  for (int k = 0; k < TILE_OWN; ++k) l[k] = renormalisation_of(f * xx[k], f * xy[k], f * xz[k], f * yy[k], f * yz[k], f * zz[k]);
#if ASKS_WALLS
#if GRADIENTS_AND_SHEPARD && SHEPARD_VOLUMETRIC
  real shepard[TILE_OWN];
  own_sums(a.shepard, shepard);
#endif
  real clearance[TILE_OWN];
  for (int k = 0; k < a.near.own; ++k) {
#if GRADIENTS_AND_SHEPARD && SHEPARD_VOLUMETRIC
    wall_sweep_t b = {&walls, shepard[k], p->support};
#else
    wall_sweep_t b = {&walls, SHEPARD_START, p->support};
#endif
#if GHOSTS
#if EDDIES
    b.clearance = distance_from_planes(p, images, a.near.places.x[k], a.near.places.y[k], a.near.places.z[k]);
#endif
#else
    stand_at(&walls, state, stride, first + k);
    LOOK_THROUGH(walls, a.near, k);
    sweep_walls(&b, p, &walls, images, a.near.places.x[k], a.near.places.y[k], a.near.places.z[k]);
#endif
#if GRADIENTS_AND_SHEPARD
    gradient[GRADIENT_SHEPARD * stride + first + k] = bounded_shepard(b.shepard);
#endif
    clearance[k] = b.clearance;
  }
#endif
  real found[QUANTITIES][TILE_OWN][3];
  for (int of = 0; of < QUANTITIES; ++of) {
    places_t sum;
    own_sums(a.sum_x[of], sum.x);
    own_sums(a.sum_y[of], sum.y);
    own_sums(a.sum_z[of], sum.z);
    for (int k = 0; k < TILE_OWN; ++k) renormalise(&l[k], f * sum.x[k], f * sum.y[k], f * sum.z[k], found[of][k]);
  }
  for (int k = 0; k < a.near.own; ++k) {
    __global real* to = gradient + first + k;
    for (int axis = 0; axis < 3; ++axis) to[(GRADIENT_COMPRESSION + axis) * stride] = found[0][k][axis];
#if GRADIENT_OF_VELOCITY
    for (int of = 0; of < 3; ++of)
      for (int axis = 0; axis < 3; ++axis) to[(GRADIENT_U + 3 * of + axis) * stride] = found[1 + of][k][axis];
#elif GRADIENT_OF_STRAIN
    int at = GRADIENT_U;
    for (int of = 0; of < 3; ++of)
      for (int axis = of; axis < 3; ++axis) to[at++ * stride] = of == axis ? found[1 + of][k][axis] : found[1 + of][k][axis] + found[1 + axis][k][of];
#endif
#if EDDIES
    to[GRADIENT_EDDIES * stride] = (DIMENSIONS + R(2.0)) * p->density * eddy_viscosity(p, strain_squared(found, k), clearance[k]);
#endif
  }
}

// Renormalised gradients ⟨∇f⟩ = L Σ_j (f_j − f_i) ∇W V_j with L = (Σ_j r ⊗ ∇W V_j)⁻¹ over the fluid: of the compression, for Antuono's density diffusion and
// Riemann problems, and of the velocity (GRADIENT_OF_VELOCITY), or the rate of strain that follows from that (GRADIENT_OF_STRAIN); where
// particles exchange mass, γ beside them, and the eddy viscosity by the rate of strain. As pair.cl has them in the array. For gradients.cl and surroundings.cl.
#include "turbulence.cl"
#define GRADIENTS_ASK_WALLS (GRADIENTS_AND_SHEPARD || EDDIES)
#define VELOCITIES (GRADIENT_OF_VELOCITY || GRADIENT_OF_STRAIN)
#define QUANTITIES (VELOCITIES ? 4 : 1)

typedef struct {
  tile own[QUANTITIES];
  tile sum_x[QUANTITIES], sum_y[QUANTITIES], sum_z[QUANTITIES];
#if GRADIENTS_AND_SHEPARD && SHEPARD_VOLUMETRIC
  tile shepard;
#endif
} gradient_sums_t;

// Of sums that are 0.
INLINE void start_gradients(gradient_sums_t* a, __global const real* state, long stride, int first) {
  a->own[0] = own_values(state + FIELD_COMPRESSION * stride, first);
#if VELOCITIES
  for (int axis = 0; axis < 3; ++axis) a->own[1 + axis] = own_values(state + (FIELD_U + axis) * stride, first);
#endif
}

// Σ of a difference times V ∇W. δ-SPH keeps the order of products that it has always had.
INLINE void add_difference(gradient_sums_t* a, int of, const slope_t* s, tile difference) {
#if HAS_BLOCK_LIST
  a->sum_x[of] += difference * s->x;
  a->sum_z[of] += difference * s->z;
#if DIMENSIONS == 3
  a->sum_y[of] += difference * s->y;
#endif
#else
  const tile weighted = s->over_distance * difference;
  a->sum_x[of] += weighted * s->rx;
  a->sum_z[of] += weighted * s->rz;
#if DIMENSIONS == 3
  a->sum_y[of] += weighted * s->ry;
#endif
#endif
}

INLINE void add_to_gradients(gradient_sums_t* a, __constant const parameters_t* p, const neighbours_t* n, const slope_t* s) {
#if GRADIENTS_AND_SHEPARD && SHEPARD_VOLUMETRIC
  a->shepard += kernel_values(p, s->distance) * s->volume;
#endif
  add_difference(a, 0, s, neighbour_compression(n, p, s->j, s->rx, s->ry, s->rz) - a->own[0]);
#if VELOCITIES
  const tile_vector_t velocity = neighbour_velocity(n, s->j);
  add_difference(a, 1, s, velocity.x - a->own[1]);
#if DIMENSIONS == 3
  add_difference(a, 2, s, velocity.y - a->own[2]);
#endif
  add_difference(a, 3, s, velocity.z - a->own[3]);
#endif
}

// Of each particle.
typedef struct {
  real shepard, clearance;
} gradient_walls_t;

INLINE void add_wall_to_gradients(gradient_walls_t* a, __constant const parameters_t* p, const contact_t* c) {
#if SHEPARD_GEOMETRIC
  a->shepard += c->shepard;
#endif
#if EDDIES
  a->clearance = fmin(a->clearance, wall_clearance(p, c));
#endif
}

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
INLINE real strain_squared(const real gradients[QUANTITIES][TILE_OWN][3], int k) {
  real sum = R(0.0);
  for (int of = 0; of < 3; ++of)
    for (int axis = 0; axis < 3; ++axis) {
      const real strain = R(0.5) * (gradients[1 + of][k][axis] + gradients[1 + axis][k][of]);
      sum += strain * strain;
    }
  return sum;
}
#endif

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

// Of each of the tile's own particles.
typedef struct {
  real found[QUANTITIES][TILE_OWN][3];
#if GRADIENTS_AND_SHEPARD && SHEPARD_VOLUMETRIC
  real shepard[TILE_OWN];
#endif
} gradient_own_t;

// `water`: Σ r ⊗ ∇W V, but for its factor, as the sums are.
INLINE void finish_gradients(__constant const parameters_t* p, const gradient_sums_t* a, const symmetric_t* water, gradient_own_t* own) {
  const real f = p->slope_scale;
  renormalisation_t l[TILE_OWN];
  for (int k = 0; k < TILE_OWN; ++k)
    l[k] = renormalisation_of(f * water[k].xx, f * water[k].xy, f * water[k].xz, f * water[k].yy, f * water[k].yz, f * water[k].zz);
  for (int of = 0; of < QUANTITIES; ++of) {
    places_t sum;
    own_sums(a->sum_x[of], sum.x);
    own_sums(a->sum_y[of], sum.y);
    own_sums(a->sum_z[of], sum.z);
    for (int k = 0; k < TILE_OWN; ++k) renormalise(&l[k], f * sum.x[k], f * sum.y[k], f * sum.z[k], own->found[of][k]);
  }
#if GRADIENTS_AND_SHEPARD && SHEPARD_VOLUMETRIC
  own_sums(a->shepard, own->shepard);
#endif
}

// With what there is of walls where it is swept for, and far from any.
INLINE void start_walls_of_gradients(gradient_walls_t* b, __constant const parameters_t* p, const gradient_own_t* own, __global const real* images, int k,
                                     real x, real y, real z) {
#if GRADIENTS_AND_SHEPARD && SHEPARD_VOLUMETRIC
  b->shepard = own->shepard[k];
#else
  b->shepard = SHEPARD_START;
#endif
#if GHOSTS && EDDIES
  b->clearance = distance_from_planes(p, images, x, y, z);
#else
  b->clearance = p->support;
#endif
}

// Of particle i, the k-th of its tile.
INLINE void write_gradients(__constant const parameters_t* p, const gradient_own_t* own, const gradient_walls_t* b, int k, __global real* gradient,
                            long stride, int i) {
  __global real* to = gradient + i;
  for (int axis = 0; axis < 3; ++axis) to[(GRADIENT_COMPRESSION + axis) * stride] = own->found[0][k][axis];
#if GRADIENT_OF_VELOCITY
  for (int of = 0; of < 3; ++of)
    for (int axis = 0; axis < 3; ++axis) to[(GRADIENT_U + 3 * of + axis) * stride] = own->found[1 + of][k][axis];
#elif GRADIENT_OF_STRAIN
  int at = GRADIENT_U;
  for (int of = 0; of < 3; ++of)
    for (int axis = of; axis < 3; ++axis)
      to[at++ * stride] = of == axis ? own->found[1 + of][k][axis] : own->found[1 + of][k][axis] + own->found[1 + axis][k][of];
#endif
#if GRADIENTS_AND_SHEPARD
  to[GRADIENT_SHEPARD * stride] = bounded_shepard(b->shepard);
#endif
#if EDDIES
  to[GRADIENT_EDDIES * stride] = (DIMENSIONS + R(2.0)) * p->density * eddy_viscosity(p, strain_squared(own->found, k), b->clearance);
#endif
}

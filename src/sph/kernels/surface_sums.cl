// What tells where the water has a free surface: the least eigenvalue λ of Σ_j r ⊗ ∇W V_j (eq (42) of the particle shifting paper with M, not its inverse), with
// walls by eq (55), and the normal there. And, of the same neighbours, what a shifting law goes by (shifts.cl). For surface.cl, and for surroundings.cl, which
// finds gradients in the same sweep.
#include "around.cl"
#include "shifting.cl"

typedef struct {
  tile sum_x, sum_y, sum_z;  // ∇C
#if SHEPARD_VOLUMETRIC
  tile shepard;
#endif
#if SHIFT_BY_APPROACH || SHIFT_SMOOTHS
  tile u, v, w;
#endif
#if SHIFT_BY_APPROACH
  tile approach;  // the greatest square of (u_j − u_i)·e
#endif
#if SHIFT_TENSILE || SHIFT_SMOOTHS
  tile law_x, law_y, law_z;  // Σ (W/W(Δx))⁴ ∇W V, or Σ V ρ_j (u_j − u_i)/(ρ_i + ρ_j) W
#endif
#if SHIFT_SMOOTHS
  tile compression;
#endif
} surface_sums_t;

// Of sums that are 0.
INLINE void start_surface(surface_sums_t* a, __global const real* state, long stride, int first) {
#if SHIFT_BY_APPROACH || SHIFT_SMOOTHS
  a->u = own_values(state + FIELD_U * stride, first);
  a->v = own_values(state + FIELD_V * stride, first);
  a->w = own_values(state + FIELD_W * stride, first);
#endif
#if SHIFT_SMOOTHS
  a->compression = own_values(state + FIELD_COMPRESSION * stride, first);
#endif
}

INLINE void add_to_surface(surface_sums_t* a, __constant const parameters_t* p, const neighbours_t* n, const slope_t* s) {
  a->sum_x += s->x;
  a->sum_z += s->z;
#if DIMENSIONS == 3
  a->sum_y += s->y;
#endif
#if SHEPARD_VOLUMETRIC
  a->shepard += kernel_values(p, s->distance) * s->volume;
#endif
#if SHIFT_BY_APPROACH || SHIFT_SMOOTHS
  const pair_t pair = pair_of(n, s->j, s->rx, s->ry, s->rz, s->r2, s->distance, s->over_distance, a->u, a->v, a->w);
#endif
#if SHIFT_BY_APPROACH
#if GHOSTS
  if (!n->mirrored)
#endif
  {
    // of the water within the support alone; nothing is at r = 0 but the particle itself
    const tile within = one_above(s->over_distance, (tile)(R(0.0)));
    a->approach = fmax(a->approach, within * pair.approach * pair.approach / (s->r2 + R(1.0e-12) * p->smoothing_length * p->smoothing_length));
  }
#endif
#if SHIFT_TENSILE
  // bounded: numbers too small for the processor's normal arithmetic would take a hundred times as long
  const tile ratio = fmax(kernel_values(p, s->distance) * p->inverse_kernel_at_spacing, (tile)(R(1.0e-3)));
  const tile tensile = s->over_distance * (ratio * ratio) * (ratio * ratio);
  a->law_x += tensile * s->rx;
  a->law_z += tensile * s->rz;
#if DIMENSIONS == 3
  a->law_y += tensile * s->ry;
#endif
#endif
#if SHIFT_SMOOTHS
  const tile near_density = R(1.0) + neighbour_compression(n, p, s->j, s->rx, s->ry, s->rz);
  const tile weight = kernel_values(p, s->distance) * s->volume * near_density / (R(1.0) + a->compression + near_density);
  a->law_x += weight * pair.relative.x;
  a->law_y += weight * pair.relative.y;
  a->law_z += weight * pair.relative.z;
#endif
}

// Of each particle.
typedef struct {
  real x, y, z;                 // ∇C's part
  real xx, xy, xz, yy, yz, zz;  // of ∫ (y − x) ⊗ n W dS, its symmetric part
  real weight, shepard;
} surface_walls_t;

INLINE void add_wall_to_surface(surface_walls_t* a, const contact_t* c) {
  a->shepard += c->shepard;  // whatever factor the case has: of λ this is a part
  a->weight += c->weight;
  a->x += c->weight * c->normal.x;
  a->y += c->weight * c->normal.y;
  a->z += c->weight * c->normal.z;
  a->xx += c->moment.x * c->normal.x;
  a->zz += c->moment.z * c->normal.z;
  a->xz += R(0.5) * (c->moment.x * c->normal.z + c->moment.z * c->normal.x);
#if DIMENSIONS == 3
  a->yy += c->moment.y * c->normal.y;
  a->xy += R(0.5) * (c->moment.x * c->normal.y + c->moment.y * c->normal.x);
  a->yz += R(0.5) * (c->moment.y * c->normal.z + c->moment.z * c->normal.y);
#endif
}

#if DIMENSIONS == 3
// The least x of 4x³ − 3x = cosine, cos((acos(cosine) + 2π)/3), to 2e-7: smooth in the sine of half the angle, and two functions of the library less.
INLINE real least_root(real cosine) {
  const real u = sqrt(fmax(R(0.5) - R(0.5) * cosine, R(0.0)));
  return R(-0.5000001632) +
         u * (R(-0.57733346) +
              u * (R(0.11082304) + u * (R(-0.05154791) + u * (R(0.026538218) + u * (R(-0.01062305) + u * R(0.0021434482))))));
}
#endif

INLINE real least_eigenvalue(const symmetric_t* m) {
#if DIMENSIONS == 2
  const real mean = R(0.5) * (m->xx + m->zz), apart = R(0.5) * (m->xx - m->zz);
  return mean - sqrt(apart * apart + m->xz * m->xz);
#else
  const real mean = (m->xx + m->yy + m->zz) / R(3.0);
  const real a = m->xx - mean, b = m->yy - mean, c = m->zz - mean;
  const real size2 = (a * a + b * b + c * c + R(2.0) * (m->xy * m->xy + m->xz * m->xz + m->yz * m->yz)) / R(6.0);
  const real size = sqrt(size2);
  const real determinant = a * (b * c - m->yz * m->yz) - m->xy * (m->xy * c - m->yz * m->xz) + m->xz * (m->xy * m->yz - b * m->xz);
  const real cosine = fmin(fmax(R(0.5) * determinant / fmax(size2 * size, R(1.0e-30)), R(-1.0)), R(1.0));
  return mean + R(2.0) * size * least_root(cosine);
#endif
}

// Out of the water: M⁻¹ by the sum, or the sum itself where M is nearly singular.
INLINE vector_t outward(const symmetric_t* m, vector_t sum) {
#if DIMENSIONS == 3
  const real c_xx = m->yy * m->zz - m->yz * m->yz, c_xy = m->xz * m->yz - m->xy * m->zz, c_xz = m->xy * m->yz - m->xz * m->yy;
  const real c_yy = m->xx * m->zz - m->xz * m->xz, c_yz = m->xy * m->xz - m->xx * m->yz, c_zz = m->xx * m->yy - m->xy * m->xy;
  const real determinant = m->xx * c_xx + m->xy * c_xy + m->xz * c_xz;
  vector_t n = make_vector(c_xx * sum.x + c_xy * sum.y + c_xz * sum.z, c_xy * sum.x + c_yy * sum.y + c_yz * sum.z,
                           c_xz * sum.x + c_yz * sum.y + c_zz * sum.z);
#else
  const real determinant = m->xx * m->zz - m->xz * m->xz;
  vector_t n = make_vector(m->zz * sum.x - m->xz * sum.z, R(0.0), m->xx * sum.z - m->xz * sum.x);
#endif
  if (determinant < R(1.0e-6)) n = sum;
  const real scale = R(-1.0) / sqrt(fmax(dot3(n, n), R(1.0e-30)));
  return make_vector(scale * n.x, scale * n.y, scale * n.z);
}

// From `around` on, of each of the tile's own.
INLINE void write_sums_of_law(const surface_sums_t* a, __global real* around, long stride, int own) {
#if SHIFT_BY_APPROACH
  real approach[TILE_OWN];
  own_greatest(a->approach, approach);
  for (int k = 0; k < own; ++k) around[AROUND_APPROACH * stride + k] = sqrt(approach[k]);
#endif
#if SHIFT_TENSILE || SHIFT_SMOOTHS
  places_t law;
  own_sums(a->law_x, law.x);
  own_sums(a->law_y, law.y);
  own_sums(a->law_z, law.z);
  for (int k = 0; k < own; ++k) {
    around[AROUND_LAW * stride + k] = law.x[k];
    around[(AROUND_LAW + 1) * stride + k] = law.y[k];
    around[(AROUND_LAW + 2) * stride + k] = law.z[k];
  }
#endif
}

// Of each of the tile's own particles.
typedef struct {
  places_t sum;
#if SHEPARD_VOLUMETRIC
  real shepard[TILE_OWN];
#endif
} surface_own_t;

INLINE void finish_surface(const surface_sums_t* a, surface_own_t* own) {
  own_sums(a->sum_x, own->sum.x);
  own_sums(a->sum_y, own->sum.y);
  own_sums(a->sum_z, own->sum.z);
#if SHEPARD_VOLUMETRIC
  own_sums(a->shepard, own->shepard);
#endif
}

// Of particle i, the k-th of its tile; `water`: Σ r ⊗ ∇W V of it, but for its factor.
INLINE void write_surface(__constant const parameters_t* p, const surface_own_t* own, const symmetric_t* water, const surface_walls_t* b, int k,
                          __global real* around, long stride, int i) {
  const real f = p->slope_scale;
  const real inverse = R(1.0) / fmin(fmax(b->shepard, R(0.05)), R(1.0));
  const symmetric_t m = {inverse * (f * water->xx + b->xx), inverse * (f * water->xy + b->xy), inverse * (f * water->xz + b->xz),
                         inverse * (f * water->yy + b->yy), inverse * (f * water->yz + b->yz), inverse * (f * water->zz + b->zz)};
  const vector_t concentration = make_vector(f * own->sum.x[k] + b->x, f * own->sum.y[k] + b->y, f * own->sum.z[k] + b->z);
  const vector_t n = outward(&m, concentration);
  around[AROUND_EIGENVALUE * stride + i] = least_eigenvalue(&m);
  around[AROUND_NORMAL * stride + i] = n.x;
  around[(AROUND_NORMAL + 1) * stride + i] = n.y;
  around[(AROUND_NORMAL + 2) * stride + i] = n.z;
#if SHEPARD_VOLUMETRIC
  around[AROUND_SHEPARD * stride + i] = own->shepard[k];
#else
  around[AROUND_SHEPARD * stride + i] = SHEPARD_GEOMETRIC ? b->shepard : R(1.0);
#endif
  around[AROUND_CONCENTRATION * stride + i] = concentration.x;
  around[(AROUND_CONCENTRATION + 1) * stride + i] = concentration.y;
  around[(AROUND_CONCENTRATION + 2) * stride + i] = concentration.z;
  around[AROUND_WALLS * stride + i] = b->weight;
}

// Where the water has a free surface: the least eigenvalue λ of Σ_j r ⊗ ∇W V_j (eq (42) of the particle shifting paper with M, not its inverse), with walls by
// eq (55); between its bounds Marrone's cone test (cone.cl). And, in the same sweep, what a shifting law goes by (shifts.cl).
#define TAKES_BLOCKS
#include "walls.cl"
#include "around.cl"
#include "pair.cl"
#include "shifting.cl"
#define SWEEP_PARTICLES
#define SWEEP_WALLS

typedef struct {
  neighbours_t near;
  tile sum_x, sum_y, sum_z;      // ∇C
  tile xx, xy, xz, yy, yz, zz;
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
} sweep_t;

typedef struct {
  const walls_t* walls;
  real x, y, z;                  // ∇C's part
  real xx, xy, xz, yy, yz, zz;   // of ∫ (y − x) ⊗ n W dS, its symmetric part
  real weight, shepard;
} wall_sweep_t;

INLINE void add_particle(sweep_t* a, __constant const parameters_t* p, int j, tile rx, tile ry, tile rz, tile r2) {
  const tile distance = sqrt(r2);
  const tile volume = near_volume(&a->near, j);
  const tile slope_volume = kernel_slopes(p, distance) * volume;
  a->sum_x += slope_volume * rx;
  a->sum_z += slope_volume * rz;
  a->xx += slope_volume * rx * rx;
  a->xz += slope_volume * rx * rz;
  a->zz += slope_volume * rz * rz;
#if DIMENSIONS == 3
  a->sum_y += slope_volume * ry;
  a->xy += slope_volume * rx * ry;
  a->yy += slope_volume * ry * ry;
  a->yz += slope_volume * ry * rz;
#endif
#if SHEPARD_VOLUMETRIC
  a->shepard += kernel_values(p, distance) * volume;
#endif
#if SHIFT_BY_APPROACH || SHIFT_SMOOTHS
  const pair_t pair = pair_of(&a->near, j, rx, ry, rz, r2, distance, slope_volume, a->u, a->v, a->w);
#endif
#if SHIFT_BY_APPROACH
#if GHOSTS
  if (!a->near.mirrored)
#endif
  {
    // of the water within the support alone; nothing is at r = 0 but the particle itself
    const tile within = one_above(slope_volume, (tile)(R(0.0)));
    a->approach = fmax(a->approach, within * pair.approach * pair.approach / (r2 + R(1.0e-12) * p->smoothing_length * p->smoothing_length));
  }
#endif
#if SHIFT_TENSILE
  // bounded: numbers too small for the processor's normal arithmetic would take a hundred times as long
  const tile ratio = fmax(kernel_values(p, distance) * p->inverse_kernel_at_spacing, (tile)(R(1.0e-3)));
  const tile tensile = slope_volume * (ratio * ratio) * (ratio * ratio);
  a->law_x += tensile * rx;
  a->law_z += tensile * rz;
#if DIMENSIONS == 3
  a->law_y += tensile * ry;
#endif
#endif
#if SHIFT_SMOOTHS
  const tile near_density = R(1.0) + neighbour_compression(&a->near, p, j, rx, ry, rz);
  const tile weight = kernel_values(p, distance) * volume * near_density / (R(1.0) + a->compression + near_density);
  a->law_x += weight * pair.relative.x;
  a->law_y += weight * pair.relative.y;
  a->law_z += weight * pair.relative.z;
#endif
}

INLINE void add_wall(wall_sweep_t* a, __constant const parameters_t* p, int s, real x, real y, real z) {
  const contact_t c = see_wall(p, a->walls, s, x, y, z);
  a->shepard += c.shepard;  // whatever factor the case has: of λ this is a part
  a->weight += c.weight;
  a->x += c.weight * c.normal.x;
  a->y += c.weight * c.normal.y;
  a->z += c.weight * c.normal.z;
  a->xx += c.moment.x * c.normal.x;
  a->zz += c.moment.z * c.normal.z;
  a->xz += R(0.5) * (c.moment.x * c.normal.z + c.moment.z * c.normal.x);
#if DIMENSIONS == 3
  a->yy += c.moment.y * c.normal.y;
  a->xy += R(0.5) * (c.moment.x * c.normal.y + c.moment.y * c.normal.x);
  a->yz += R(0.5) * (c.moment.y * c.normal.z + c.moment.z * c.normal.y);
#endif
}

#include "sweep.cl"

typedef struct {
  real xx, xy, xz, yy, yz, zz;
} symmetric_t;

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
INLINE void write_sums_of_law(const sweep_t* a, __global real* around, long stride) {
#if SHIFT_BY_APPROACH
  real approach[TILE_OWN];
  own_greatest(a->approach, approach);
  for (int k = 0; k < a->near.own; ++k) around[AROUND_APPROACH * stride + k] = sqrt(approach[k]);
#endif
#if SHIFT_TENSILE || SHIFT_SMOOTHS
  places_t law;
  own_sums(a->law_x, law.x);
  own_sums(a->law_y, law.y);
  own_sums(a->law_z, law.z);
  for (int k = 0; k < a->near.own; ++k) {
    around[AROUND_LAW * stride + k] = law.x[k];
    around[(AROUND_LAW + 1) * stride + k] = law.y[k];
    around[(AROUND_LAW + 2) * stride + k] = law.z[k];
  }
#endif
}

__kernel void surface_normals(__constant const parameters_t* p, int count, __global const int* slot_start, __global const real* state, long stride,
                              real reach, WALL_ARGUMENTS, __global const real* images, __global const int* blocks, __global real* around) {
  TAKE_TILE(first, count)
  walls_t walls = WALLS_OF_ARGUMENTS;
  sweep_t a = {0};
  neighbours_of(&a.near, state, stride, reach, &walls, first, count);
  USE_BLOCK_LIST(a.near)
#if SHIFT_BY_APPROACH || SHIFT_SMOOTHS
  a.u = own_values(state + FIELD_U * stride, first);
  a.v = own_values(state + FIELD_V * stride, first);
  a.w = own_values(state + FIELD_W * stride, first);
#endif
#if SHIFT_SMOOTHS
  a.compression = own_values(state + FIELD_COMPRESSION * stride, first);
#endif
  sweep_particles(&a, p, slot_start, images);
  write_sums_of_law(&a, around + first, stride);
  places_t sum;
  real xx[TILE_OWN], xy[TILE_OWN], xz[TILE_OWN], yy[TILE_OWN], yz[TILE_OWN], zz[TILE_OWN];
  own_sums(a.sum_x, sum.x);
  own_sums(a.sum_y, sum.y);
  own_sums(a.sum_z, sum.z);
  own_sums(a.xx, xx);
  own_sums(a.xy, xy);
  own_sums(a.xz, xz);
  own_sums(a.yy, yy);
  own_sums(a.yz, yz);
  own_sums(a.zz, zz);
  const real f = p->slope_scale;
  for (int k = 0; k < a.near.own; ++k) {
    const int i = first + k;
    wall_sweep_t b = {0};
    b.walls = &walls;
    b.shepard = R(1.0);
#if !GHOSTS
    stand_at(&walls, state, stride, i);
    LOOK_THROUGH(walls, a.near, k);
    sweep_walls(&b, p, &walls, images, a.near.places.x[k], a.near.places.y[k], a.near.places.z[k]);
#endif
    const real inverse = R(1.0) / fmin(fmax(b.shepard, R(0.05)), R(1.0));
    const symmetric_t m = {inverse * (f * xx[k] + b.xx), inverse * (f * xy[k] + b.xy), inverse * (f * xz[k] + b.xz),
                           inverse * (f * yy[k] + b.yy), inverse * (f * yz[k] + b.yz), inverse * (f * zz[k] + b.zz)};
    const vector_t concentration = make_vector(f * sum.x[k] + b.x, f * sum.y[k] + b.y, f * sum.z[k] + b.z);
    const vector_t n = outward(&m, concentration);
    around[AROUND_EIGENVALUE * stride + i] = least_eigenvalue(&m);
    around[AROUND_NORMAL * stride + i] = n.x;
    around[(AROUND_NORMAL + 1) * stride + i] = n.y;
    around[(AROUND_NORMAL + 2) * stride + i] = n.z;
#if SHEPARD_VOLUMETRIC
    real shepard[TILE_OWN];
    own_sums(a.shepard, shepard);
    around[AROUND_SHEPARD * stride + i] = shepard[k];
#else
    around[AROUND_SHEPARD * stride + i] = SHEPARD_GEOMETRIC ? b.shepard : R(1.0);
#endif
    around[AROUND_CONCENTRATION * stride + i] = concentration.x;
    around[(AROUND_CONCENTRATION + 1) * stride + i] = concentration.y;
    around[(AROUND_CONCENTRATION + 2) * stride + i] = concentration.z;
    around[AROUND_WALLS * stride + i] = b.weight;
  }
}

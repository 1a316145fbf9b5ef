// The renormalised gradient of the compression, ⟨∇s⟩ = L Σ_j (s_j − s_i) ∇W V_j with L = (Σ_j r ⊗ ∇W V_j)⁻¹, for Antuono's density diffusion.
#include "walls.cl"
#define SWEEP_PARTICLES

typedef struct {
  neighbours_t near;
  tile compression;
  tile sum_x, sum_y, sum_z;
  tile xx, xy, xz, yy, yz, zz;
} sweep_t;

INLINE void add_particle(sweep_t* a, __constant const parameters_t* p, int j, tile rx, tile ry, tile rz, tile r2) {
  const tile slope_volume = kernel_slopes(p, sqrt(r2)) * near_volume(&a->near, j);
  const tile weighted = slope_volume * (neighbour_compression(&a->near, p, j, rx, ry, rz) - a->compression);
  a->sum_x += weighted * rx;
  a->sum_z += weighted * rz;
  a->xx += slope_volume * rx * rx;
  a->xz += slope_volume * rx * rz;
  a->zz += slope_volume * rz * rz;
#if DIMENSIONS == 3
  a->sum_y += weighted * ry;
  a->xy += slope_volume * rx * ry;
  a->yy += slope_volume * ry * ry;
  a->yz += slope_volume * ry * rz;
#endif
}

#include "sweep.cl"

// Written for particle i, from its own sums. A matrix that is nearly singular (a particle of a thin jet) has no gradient to trust: taken as zero.
INLINE void write_gradient(__global real* gradient, long stride, int i, vector_t sum, real xx, real xy, real xz, real yy, real yz, real zz) {
  const real least = R(1.0e-3);
#if DIMENSIONS == 3
  const real c_xx = yy * zz - yz * yz, c_xy = xz * yz - xy * zz, c_xz = xy * yz - xz * yy;
  const real c_yy = xx * zz - xz * xz, c_yz = xy * xz - xx * yz, c_zz = xx * yy - xy * xy;
  const real determinant = xx * c_xx + xy * c_xy + xz * c_xz;
  const real scale = determinant > least ? R(1.0) / determinant : R(0.0);
  gradient[i] = scale * (c_xx * sum.x + c_xy * sum.y + c_xz * sum.z);
  gradient[stride + i] = scale * (c_xy * sum.x + c_yy * sum.y + c_yz * sum.z);
  gradient[2 * stride + i] = scale * (c_xz * sum.x + c_yz * sum.y + c_zz * sum.z);
#else
  const real determinant = xx * zz - xz * xz;
  const real scale = determinant > least ? R(1.0) / determinant : R(0.0);
  gradient[i] = scale * (zz * sum.x - xz * sum.z);
  gradient[stride + i] = R(0.0);
  gradient[2 * stride + i] = scale * (xx * sum.z - xz * sum.x);
#endif
}

__kernel void density_gradient(__constant const parameters_t* p, int count, __global const int* slot_start, __global const real* state, long stride,
                               real reach, WALL_ARGUMENTS, __global const real* images, __global real* gradient) {
  const int first = TILE_OWN * get_global_id(0);
  if (first >= count) return;
  walls_t walls = WALLS_OF_ARGUMENTS;
  sweep_t a = {0};
  neighbours_of(&a.near, state, stride, reach, &walls, first, count);
  a.compression = own_values(state + FIELD_COMPRESSION * stride, first);
  sweep_particles(&a, p, slot_start, images);
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
  for (int k = 0; k < a.near.own; ++k)
    write_gradient(gradient, stride, first + k, make_vector(f * sum.x[k], f * sum.y[k], f * sum.z[k]), f * xx[k], f * xy[k], f * xz[k], f * yy[k],
                   f * yz[k], f * zz[k]);
}

// The renormalised gradient of the compression, ⟨∇s⟩ = L Σ_j (s_j − s_i) ∇W V_j with L = (Σ_j r ⊗ ∇W V_j)⁻¹, for Antuono's density diffusion.
#include "walls.cl"
#define SWEEP_PARTICLES

typedef struct {
  neighbours_t near;
  real compression;
  real sum_x, sum_y, sum_z;
  real xx, xy, xz, yy, yz, zz;
} sweep_t;

INLINE void add_particle(sweep_t* a, __constant const parameters_t* p, int j, real rx, real ry, real rz, real r2) {
  const real slope_volume = kernel_slope(p, sqrt(r2)) * a->near.state[FIELD_VOLUME * a->near.stride + j];
  const real weighted = slope_volume * (neighbour_compression(&a->near, p, j, rx, ry, rz) - a->compression);
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

__kernel void density_gradient(__constant const parameters_t* p, int count, __global const int* cell_start, __global const real* state, int stride,
                               WALL_ARGUMENTS, __global const real* images, __global real* gradient) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const walls_t walls = WALLS_OF_ARGUMENTS;
  sweep_t a = {0};
  a.near = neighbours_of(state, stride, &walls, state[FIELD_X * stride + i], DIMENSIONS == 3 ? state[FIELD_Y * stride + i] : R(0.0),
                         state[FIELD_Z * stride + i]);
  a.compression = state[FIELD_COMPRESSION * stride + i];
  sweep_particles(&a, p, cell_start, images);

  // a matrix that is nearly singular (a particle of a thin jet) has no gradient to trust: taken as zero
  const real least = R(1.0e-3);
#if DIMENSIONS == 3
  const real c_xx = a.yy * a.zz - a.yz * a.yz, c_xy = a.xz * a.yz - a.xy * a.zz, c_xz = a.xy * a.yz - a.xz * a.yy;
  const real c_yy = a.xx * a.zz - a.xz * a.xz, c_yz = a.xy * a.xz - a.xx * a.yz, c_zz = a.xx * a.yy - a.xy * a.xy;
  const real determinant = a.xx * c_xx + a.xy * c_xy + a.xz * c_xz;
  const real scale = determinant > least ? R(1.0) / determinant : R(0.0);
  gradient[i] = scale * (c_xx * a.sum_x + c_xy * a.sum_y + c_xz * a.sum_z);
  gradient[stride + i] = scale * (c_xy * a.sum_x + c_yy * a.sum_y + c_yz * a.sum_z);
  gradient[2 * stride + i] = scale * (c_xz * a.sum_x + c_yz * a.sum_y + c_zz * a.sum_z);
#else
  const real determinant = a.xx * a.zz - a.xz * a.xz;
  const real scale = determinant > least ? R(1.0) / determinant : R(0.0);
  gradient[i] = scale * (a.zz * a.sum_x - a.xz * a.sum_z);
  gradient[stride + i] = R(0.0);
  gradient[2 * stride + i] = scale * (a.xx * a.sum_z - a.xz * a.sum_x);
#endif
}

// Second-order moving least squares about a particle ([M], docs/least_squares.md). With ξ = (x_j − x_i)/h_m the differences from the particle are fitted by
//   b(ξ) = (ξ, ζ, ξ²/2, ζ²/2, ξζ) in 2-D, (ξ, η, ζ, ξ²/2, η²/2, ζ²/2, ξη, ξζ, ηζ) in 3-D,
// with the weights w_j = V_j W(r_ij, h_m). M = Σ w b bᵀ; coefficients y = M⁻¹ Σ w (f_j − f_i) b: ∂_a f = y_a/h_m, ∇²f = Σ y_aa/h_m². The particle itself
// drops out: its basis is zero. Scaled by h_m, M has no units and is no worse than its neighbourhood.
#if DIMENSIONS == 3
#define BASIS 9
#define MOMENTS 31
#else
#define BASIS 5
#define MOMENTS 12
#endif
#define ROWS (DIMENSIONS + 1)  // of M⁻¹ that are wanted: one a derivative, and that of the Laplacian

// One value of each of a tile's own particles.
#if TILE_OWN == 1
typedef real own_t;
#elif TILE_OWN == 2
#if USE_DOUBLE
typedef double2 own_t;
#else
typedef float2 own_t;
#endif
#else
#if USE_DOUBLE
typedef double4 own_t;
#else
typedef float4 own_t;
#endif
#endif

INLINE own_t own_from(const real* lanes) {
#if TILE_OWN == 1
  return lanes[0];
#elif TILE_OWN == 2
  return vload2(0, lanes);
#else
  return vload4(0, lanes);
#endif
}

INLINE void own_lanes(own_t v, real* lanes) {
#if TILE_OWN == 1
  lanes[0] = v;
#elif TILE_OWN == 2
  vstore2(v, 0, lanes);
#else
  vstore4(v, 0, lanes);
#endif
}

INLINE own_t own_total(tile sum) {
  real sums[TILE_OWN];
  own_sums(sum, sums);
  return own_from(sums);
}

// Of candidates at that distance, but for their volumes.
INLINE tile mls_weights(__constant const parameters_t* p, tile distance) {
  const tile t = fmax(R(1.0) - distance * p->mls_inverse_support, R(0.0));
  const tile tt = t * t;
  return p->mls_weight_scale * tt * tt * (R(5.0) - R(4.0) * t);
}

// F with the weights' support, but for its factor p->mls_slope_scale.
INLINE tile mls_slopes(__constant const parameters_t* p, tile distance) {
  const tile t = fmax(R(1.0) - distance * p->mls_inverse_support, R(0.0));
  return t * t * t;
}

// b at r.
INLINE void basis_at(__constant const parameters_t* p, tile rx, tile ry, tile rz, tile* b) {
  const tile x = rx * p->mls_inverse, z = rz * p->mls_inverse;
#if DIMENSIONS == 3
  const tile y = ry * p->mls_inverse;
  b[0] = x;
  b[1] = y;
  b[2] = z;
  b[3] = R(0.5) * x * x;
  b[4] = R(0.5) * y * y;
  b[5] = R(0.5) * z * z;
  b[6] = x * y;
  b[7] = x * z;
  b[8] = y * z;
#else
  b[0] = x;
  b[1] = z;
  b[2] = R(0.5) * x * x;
  b[3] = R(0.5) * z * z;
  b[4] = x * z;
#endif
}

typedef struct {
  tile moment[MOMENTS];    // Σ w of the products of two, three and four coordinates of ξ
  tile first[DIMENSIONS];  // Σ w ξ
} moments_t;

INLINE void add_to_moments(moments_t* m, tile weight, const tile* b) {
#if DIMENSIONS == 3
  const tile x = b[0], y = b[1], z = b[2];
  const tile wx = weight * x, wy = weight * y, wz = weight * z;
  const tile xx = wx * x, xy = wx * y, xz = wx * z, yy = wy * y, yz = wy * z, zz = wz * z;
  const tile xxx = xx * x, xxy = xx * y, xxz = xx * z, xyy = yy * x, xyz = xy * z, xzz = zz * x, yyy = yy * y, yyz = yy * z, yzz = zz * y, zzz = zz * z;
  m->first[0] += wx;
  m->first[1] += wy;
  m->first[2] += wz;
  m->moment[0] += xx;
  m->moment[1] += xy;
  m->moment[2] += xz;
  m->moment[3] += yy;
  m->moment[4] += yz;
  m->moment[5] += zz;
  m->moment[6] += xxx;
  m->moment[7] += xxy;
  m->moment[8] += xxz;
  m->moment[9] += xyy;
  m->moment[10] += xyz;
  m->moment[11] += xzz;
  m->moment[12] += yyy;
  m->moment[13] += yyz;
  m->moment[14] += yzz;
  m->moment[15] += zzz;
  m->moment[16] += xxx * x;
  m->moment[17] += xxx * y;
  m->moment[18] += xxx * z;
  m->moment[19] += xxy * y;
  m->moment[20] += xxy * z;
  m->moment[21] += xxz * z;
  m->moment[22] += yyy * x;
  m->moment[23] += yyz * x;
  m->moment[24] += yzz * x;
  m->moment[25] += zzz * x;
  m->moment[26] += yyy * y;
  m->moment[27] += yyy * z;
  m->moment[28] += yyz * z;
  m->moment[29] += yzz * z;
  m->moment[30] += zzz * z;
#else
  const tile x = b[0], z = b[1];
  const tile wx = weight * x, wz = weight * z;
  const tile xx = wx * x, xz = wx * z, zz = wz * z;
  const tile xxx = xx * x, xxz = xx * z, xzz = zz * x, zzz = zz * z;
  m->first[0] += wx;
  m->first[1] += wz;
  m->moment[0] += xx;
  m->moment[1] += xz;
  m->moment[2] += zz;
  m->moment[3] += xxx;
  m->moment[4] += xxz;
  m->moment[5] += xzz;
  m->moment[6] += zzz;
  m->moment[7] += xxx * x;
  m->moment[8] += xxx * z;
  m->moment[9] += xxz * z;
  m->moment[10] += zzz * x;
  m->moment[11] += zzz * z;
#endif
}

// Of M_kl with l ≤ k, row by row, which moment it is a multiple of; a square of the basis has a factor of ½.
#if DIMENSIONS == 3
__constant int moment_of[BASIS * (BASIS + 1) / 2] = {0, 1,  3,  2,  4,  5,  6, 7, 8,  16, 9,  12, 13, 19, 26, 11, 14, 15, 21, 28, 30, 7,  9,
                                                     10, 17, 22, 24, 19, 8, 10, 11, 18, 23, 25, 20, 21, 10, 13, 14, 20, 27, 29, 23, 24, 28};
#else
__constant int moment_of[BASIS * (BASIS + 1) / 2] = {0, 1, 2, 3, 4, 7, 5, 6, 9, 11, 4, 5, 8, 10, 9};
#endif

INLINE bool is_square(int k) { return k >= DIMENSIONS && k < 2 * DIMENSIONS; }

// M on and below its diagonal.
INLINE void matrix_of(const moments_t* m, own_t matrix[BASIS][BASIS]) {
  own_t total[MOMENTS];
#pragma unroll
  for (int k = 0; k < MOMENTS; ++k) total[k] = own_total(m->moment[k]);
#pragma unroll
  for (int k = 0; k < BASIS; ++k)
#pragma unroll
    for (int l = 0; l <= k; ++l)
      matrix[k][l] = (is_square(k) ? R(0.5) : R(1.0)) * (is_square(l) ? R(0.5) : R(1.0)) * total[moment_of[k * (k + 1) / 2 + l]];
}

// Σ w b.
INLINE void weighted_basis(const moments_t* m, own_t* sum) {
#pragma unroll
  for (int a = 0; a < DIMENSIONS; ++a) sum[a] = own_total(m->first[a]);
#if DIMENSIONS == 3
  sum[3] = R(0.5) * own_total(m->moment[0]);
  sum[4] = R(0.5) * own_total(m->moment[3]);
  sum[5] = R(0.5) * own_total(m->moment[5]);
  sum[6] = own_total(m->moment[1]);
  sum[7] = own_total(m->moment[2]);
  sum[8] = own_total(m->moment[4]);
#else
  sum[2] = R(0.5) * own_total(m->moment[0]);
  sum[3] = R(0.5) * own_total(m->moment[2]);
  sum[4] = own_total(m->moment[1]);
#endif
}

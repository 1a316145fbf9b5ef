// The solution of the fit: rows of M⁻¹, by M = L D Lᵀ for all of a tile's own particles at once; where their neighbours do not hold a second order, one by one.
// D_k/M_kk, from 0 to 1, is the part of basis function k that those before it do not explain; it has no units and does not know how weights are scaled. Where
// it falls below the pivot the fit is of first order, and of what a pseudo-inverse leaves of that: along a line of neighbours, or of one, the slope along
// it; of none, nothing.
#define FIT_WHOLE R(0.0)
#define FIT_WITHOUT_LAPLACIAN R(1.0)
#define FIT_OF_FIRST_ORDER R(2.0)
#define FIT_BELOW R(3.0)

// Least Σ_j of the Laplacian's coefficients, which is minus the particle's own: where that is not negative, viscosity lets velocities grow. With the artificial
// viscosity in it the Laplacian has more to hold.
#define LEAST_OWN_COEFFICIENT (MLS_DIRECT ? R(0.5) : R(0.0))

typedef struct {
  own_t row[ROWS][BASIS];  // of ∂_a, 1/m; of ∇², 1/m²
  real level[TILE_OWN];    // FIT_…
} fit_t;

// L below the diagonal, 1/D on it. The least D_k/M_kk.
INLINE own_t decompose(own_t m[BASIS][BASIS], real pivot) {
  own_t least = (own_t)(R(1.0));
#pragma unroll
  for (int k = 0; k < BASIS; ++k) {
    own_t scaled[BASIS];  // L_kl D_l
    own_t d = m[k][k];
#pragma unroll
    for (int l = 0; l < k; ++l) {
      scaled[l] = m[k][l];
      m[k][l] *= m[l][l];
      d -= scaled[l] * m[k][l];
    }
    const own_t all = m[k][k] + R(1.0e-30);
    least = fmin(least, d / all);
    m[k][k] = R(1.0) / fmax(d, R(0.5) * pivot * all + R(1.0e-30));
#pragma unroll
    for (int i = k + 1; i < BASIS; ++i) {
#pragma unroll
      for (int l = 0; l < k; ++l) m[i][k] -= m[i][l] * m[k][l];
    }
  }
  return least;
}

// M⁻¹ y in the place of y.
INLINE void solve(own_t m[BASIS][BASIS], own_t* y) {
#pragma unroll
  for (int k = 1; k < BASIS; ++k)
#pragma unroll
    for (int l = 0; l < k; ++l) y[k] -= m[k][l] * y[l];
#pragma unroll
  for (int k = 0; k < BASIS; ++k) y[k] *= m[k][k];
#pragma unroll
  for (int k = BASIS - 2; k >= 0; --k)
#pragma unroll
    for (int l = k + 1; l < BASIS; ++l) y[k] -= m[l][k] * y[l];
}

// A pseudo-inverse of the symmetric a, in its place, by Jacobi's rotations: of its eigenvalues only those above the pivot's part of the greatest count.
// Whether all did.
INLINE bool pseudo_invert(real a[DIMENSIONS][DIMENSIONS], real pivot) {
  real v[DIMENSIONS][DIMENSIONS];
  for (int i = 0; i < DIMENSIONS; ++i)
    for (int j = 0; j < DIMENSIONS; ++j) v[i][j] = i == j ? R(1.0) : R(0.0);
  for (int sweep = 0; sweep < (DIMENSIONS == 2 ? 1 : 8); ++sweep)
    for (int i = 0; i < DIMENSIONS; ++i)
      for (int j = i + 1; j < DIMENSIONS; ++j) {
        if (a[i][j] == R(0.0)) continue;
        const real theta = (a[j][j] - a[i][i]) / (R(2.0) * a[i][j]);
        const real size = fmin(fabs(theta), R(1.0e15));
        const real t = (theta < R(0.0) ? R(-1.0) : R(1.0)) / (size + sqrt(size * size + R(1.0)));
        const real c = R(1.0) / sqrt(t * t + R(1.0)), s = t * c;
        const real off = a[i][j];
        a[i][i] -= t * off;
        a[j][j] += t * off;
        a[i][j] = a[j][i] = R(0.0);
        for (int k = 0; k < DIMENSIONS; ++k) {
          const real vi = v[k][i], vj = v[k][j];
          v[k][i] = c * vi - s * vj;
          v[k][j] = s * vi + c * vj;
          if (k == i || k == j) continue;
          const real ki = a[k][i], kj = a[k][j];
          a[k][i] = a[i][k] = c * ki - s * kj;
          a[k][j] = a[j][k] = s * ki + c * kj;
        }
      }
  real greatest = R(0.0);
  for (int k = 0; k < DIMENSIONS; ++k) greatest = fmax(greatest, a[k][k]);
  bool whole = true;
  real inverse[DIMENSIONS];
  for (int k = 0; k < DIMENSIONS; ++k) {
    const bool counts = a[k][k] > pivot * greatest && a[k][k] > R(1.0e-30);
    inverse[k] = counts ? R(1.0) / a[k][k] : R(0.0);
    whole = whole && counts;
  }
  for (int i = 0; i < DIMENSIONS; ++i)
    for (int j = 0; j < DIMENSIONS; ++j) {
      a[i][j] = R(0.0);
      for (int k = 0; k < DIMENSIONS; ++k) a[i][j] += v[i][k] * inverse[k] * v[j][k];
    }
  return whole;
}

// Of own particle k, by its linear part.
INLINE void fall_back(fit_t* fit, own_t linear[DIMENSIONS][DIMENSIONS], real pivot, real per_length, int k) {
  real a[DIMENSIONS][DIMENSIONS], lanes[TILE_OWN];
  for (int i = 0; i < DIMENSIONS; ++i)
    for (int j = 0; j <= i; ++j) {
      own_lanes(linear[i][j], lanes);
      a[i][j] = a[j][i] = lanes[k];
    }
  fit->level[k] = pseudo_invert(a, pivot) ? FIT_OF_FIRST_ORDER : FIT_BELOW;
  for (int r = 0; r < ROWS; ++r)
    for (int l = 0; l < BASIS; ++l) {
      own_lanes(fit->row[r][l], lanes);
      lanes[k] = r < DIMENSIONS && l < DIMENSIONS ? per_length * a[r][l] : R(0.0);
      fit->row[r][l] = own_from(lanes);
    }
}

// Of own particle k: no Laplacian.
INLINE void drop_laplacian(fit_t* fit, int k) {
  real lanes[TILE_OWN];
  fit->level[k] = FIT_WITHOUT_LAPLACIAN;
  for (int l = 0; l < BASIS; ++l) {
    own_lanes(fit->row[DIMENSIONS][l], lanes);
    lanes[k] = R(0.0);
    fit->row[DIMENSIONS][l] = own_from(lanes);
  }
}

INLINE own_t row_times(const own_t* row, const own_t* sum) {
  own_t product = row[0] * sum[0];
#pragma unroll
  for (int l = 1; l < BASIS; ++l) product += row[l] * sum[l];
  return product;
}

INLINE void solve_fit(__constant const parameters_t* p, const moments_t* moments, fit_t* fit) {
  own_t matrix[BASIS][BASIS], linear[DIMENSIONS][DIMENSIONS], own_basis[BASIS];
  matrix_of(moments, matrix);
#pragma unroll
  for (int i = 0; i < DIMENSIONS; ++i)
#pragma unroll
    for (int j = 0; j <= i; ++j) linear[i][j] = matrix[i][j];
  real least[TILE_OWN];
  own_lanes(decompose(matrix, p->mls_pivot), least);
#pragma unroll
  for (int r = 0; r < ROWS; ++r) {
#pragma unroll
    for (int l = 0; l < BASIS; ++l) fit->row[r][l] = (own_t)(r < DIMENSIONS ? (l == r ? p->mls_inverse : R(0.0)) : is_square(l) ? p->mls_inverse * p->mls_inverse : R(0.0));
    solve(matrix, fit->row[r]);
  }
  weighted_basis(moments, own_basis);
  real coefficient[TILE_OWN];
  own_lanes(row_times(fit->row[DIMENSIONS], own_basis), coefficient);
  const real least_coefficient = LEAST_OWN_COEFFICIENT * p->mls_inverse * p->mls_inverse;
  for (int k = 0; k < TILE_OWN; ++k) {
    fit->level[k] = FIT_WHOLE;
    if (least[k] < p->mls_pivot || least[k] <= R(0.0)) {
      fall_back(fit, linear, p->mls_pivot, p->mls_inverse, k);
    } else if (coefficient[k] <= least_coefficient) {
      drop_laplacian(fit, k);
    }
  }
}

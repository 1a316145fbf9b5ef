// δ-SPH: eqs (33) and (35), its sign corrected, of the particle shifting paper.

typedef struct {
  tile pressure;
} scheme_own_t;

INLINE scheme_own_t scheme_own(__constant const parameters_t* p, const neighbours_t* n, __global const real* gradient, int first) {
  const scheme_own_t own = {own_values(n->state + FIELD_PRESSURE * n->stride, first)};
  return own;
}

// Of a pair, what takes the place of p_i + p_j in the force, Pa, and of (u_j − u_i)·(x_j − x_i) in the divergence, m²/s.
typedef struct {
  tile pressure, divergence;
} exchange_t;

INLINE exchange_t pair_exchange(const scheme_own_t* own, __constant const parameters_t* p, const neighbours_t* n, __global const real* gradient,
                                const pair_t* pair) {
  const exchange_t exchange = {own->pressure + neighbour_pressure(n, p, pair->j, pair->rx, pair->ry, pair->rz), pair->approach};
  return exchange;
}

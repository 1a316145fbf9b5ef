// Parshikov and Medin's scheme, eqs (28)–(31) of the particle shifting paper: pairs have the pressure and the velocity between the two sound waves of their
// Riemann problem, and particles keep their mass.
#include "riemann.cl"

typedef struct {
  tile pressure, divergence;
} exchange_t;

INLINE exchange_t pair_exchange(const scheme_own_t* own, __constant const parameters_t* p, const neighbours_t* n, __global const real* gradient,
                                const pair_t* pair) {
  const star_t star = riemann_of(own, p, n, gradient, pair);
  const exchange_t exchange = {R(2.0) * star.pressure, R(2.0) * star.advance};
  return exchange;
}

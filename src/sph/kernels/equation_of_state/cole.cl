// p = ρ₀ c₀²/7 ((1+s)⁷ − 1), for a type of values. Sound has the speed c₀ (1+s)³. The seventh root by Padé's approximant and two of Halley's steps, each of which
// cubes the error: to 1e-10 between s = −0.2 and 0.2, to 1e-5 down to −0.35. A Riemann problem of riemann_ale wants one for each pair, and the library's takes
// as long as all else of the pair twice over.
#define EQUATION_OF_STATE(value, prefix)                                                        \
  INLINE value prefix##_pressure(__constant const parameters_t* p, value s) {                   \
    const value ratio = R(1.0) + s;                                                             \
    const value cubed = ratio * ratio * ratio;                                                  \
    return p->bulk_modulus / R(7.0) * (cubed * cubed * ratio - R(1.0));                         \
  }                                                                                             \
  INLINE value prefix##_impedance(__constant const parameters_t* p, value s) {                  \
    const value ratio = R(1.0) + s;                                                             \
    return p->density * p->sound_speed * (ratio * ratio) * (ratio * ratio);                     \
  }                                                                                             \
  INLINE value prefix##_compression(__constant const parameters_t* p, value pressure) {         \
    const value x = fmax(R(1.0) + R(7.0) * pressure / p->bulk_modulus, R(1.0e-6));              \
    value root = (R(3.0) + R(4.0) * x) / (R(4.0) + R(3.0) * x);                                 \
    for (int k = 0; k < 2; ++k) {                                                               \
      const value cubed = root * root * root, seventh = cubed * cubed * root;                   \
      root *= (R(3.0) * seventh + R(4.0) * x) / (R(4.0) * seventh + R(3.0) * x);                \
    }                                                                                           \
    return root - R(1.0);                                                                       \
  }

// ∫ p/ρ² dρ/c₀² from rest to the compression s: what a unit of mass stores.
INLINE real stored_energy_of(real s) {
  const bool small = fabs(s) < R(0.03);  // there the closed form is a small difference of large terms
  const real r = R(1.0) + s;
  const real series = s * s * (R(0.5) + s * (R(0.333333333333) + R(0.5) * s));
  return small ? series : ((r * r * r * r * r * r - R(1.0)) / R(6.0) - s / r) / R(7.0);
}

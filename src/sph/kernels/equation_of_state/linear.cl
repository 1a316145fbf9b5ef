// p = ρ₀ c₀² s, for a type of values. Sound has the speed c₀ at any density.
#define EQUATION_OF_STATE(value, prefix)                                                                                        \
  INLINE value prefix##_pressure(__constant const parameters_t* p, value s) { return p->bulk_modulus * s; }                     \
  INLINE value prefix##_impedance(__constant const parameters_t* p, value s) { return p->density * p->sound_speed * (R(1.0) + s); } \
  INLINE value prefix##_compression(__constant const parameters_t* p, value pressure) { return fmax(pressure / p->bulk_modulus, R(-0.99)); }

// ∫ p/ρ² dρ/c₀² from rest to the compression s: what a unit of mass stores.
INLINE real stored_energy_of(real s) {
  const bool small = fabs(s) < R(0.03);  // there the closed form is a small difference of large terms
  const real series = s * s * (R(0.5) + s * (R(-0.666666666667) + s * (R(0.75) + s * (R(-0.8) + s * R(0.833333333333)))));
  return small ? series : log(fmax(R(1.0) + s, R(1.0e-6))) - s / (R(1.0) + s);
}

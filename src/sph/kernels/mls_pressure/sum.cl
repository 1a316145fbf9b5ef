// Of p_i + p_j, as SPH has it: Σ_j V_j (p_i + p_j) G_ij holds particles apart, and lets a free surface be one of no pressure, since Σ_j V_j G_ij is not zero there.
#define ADJOINT_PRESSURE 0

INLINE tile pair_pressure(tile own, tile near) { return own + near; }

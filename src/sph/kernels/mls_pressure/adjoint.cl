// Σ_j V_j (p_i G_ij − p_j G_ji), minus the adjoint of the divergence Σ_j V_j (u_j − u_i)·G_ij: what pairs do to each other is opposite and equal, and the
// pressure's work is what the compression takes up. G_ji needs the neighbours' own fits, which mls_gradients.cl has found before.
#define ADJOINT_PRESSURE 1

// What goes with G_ij.
INLINE tile pair_pressure(tile own, tile near) { return own; }

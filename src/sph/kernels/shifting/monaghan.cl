// Monaghan's law, eq (1) of the particle shifting paper: velocities are smoothed in what moves the particles.
#define SHIFT_TENSILE 0
#define SHIFT_BY_APPROACH 0
#define SHIFT_SMOOTHS 1  // `concentration` holds Σ_j V_j ρ_j (u_j − u_i)/(ρ_i + ρ_j) W instead

INLINE vector_t shift_by_law(__constant const parameters_t* p, const shifted_t* s) { return s->concentration; }

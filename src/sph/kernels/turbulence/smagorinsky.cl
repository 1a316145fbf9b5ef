// Smagorinsky's eddy viscosity ν_t = l² |S|, |S|² = 2 S:S, with l = C_s Δx, but no more than κ times the distance of a wall (Prandtl's mixing length).
#define EDDIES 1
#define KARMAN R(0.41)

// m²/s; `squares`: S:S, 1/s².
INLINE real eddy_viscosity(__constant const parameters_t* p, real squares, real wall_distance) {
  const real length = fmin(p->eddy_length, KARMAN * fmax(wall_distance, R(0.0)));
  return length * length * sqrt(R(2.0) * squares);
}

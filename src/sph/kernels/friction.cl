// Friction on walls by a law that each owner of walls has: the shear stress by what a particle at a distance from the wall does along it. Of a flat wall
// Σ 2 ∫ W dS V over the particles is its area, so that this is what the stress is shared out by.
#if FRICTION_LAWS
#define FRICTION_NONE 0
#define FRICTION_VISCOUS 1
#define FRICTION_OF_THE_WALL 2
#define FRICTION_COEFFICIENT 3
#define WALL_KARMAN R(0.41)
#define WALL_CONSTANT R(5.2)     // B of a smooth wall: u/u_τ = ln(d u_τ/ν)/κ + B
#define ROUGHNESS_SHARE R(0.26)  // ν + 0.26 k_s u_τ in the place of ν: Nikuradse's B = 8.5 of rough walls, and Colebrook's way between
#define LEAST_PROFILE R(2.5)     // of u/u_τ: within the grains there is no law

// u_τ, by three of Newton's steps: to 1e-4 from u/15.
INLINE real friction_velocity(real speed, real distance, real viscosity, real roughness) {
  real found = speed / R(15.0);
  for (int k = 0; k < 3; ++k) {
    const real lengths = distance * found / fmax(viscosity + ROUGHNESS_SHARE * roughness * found, R(1.0e-30));
    const real profile = fmax(log(fmax(lengths, R(1.0e-3))) / WALL_KARMAN + WALL_CONSTANT, LEAST_PROFILE);
    found = (speed + found / WALL_KARMAN) / (profile + R(1.0) / WALL_KARMAN);
  }
  return found;
}

// Stress over speed, Pa·s/m; `law`: of MOTION_FRICTION.
SELDOM real friction_by_law(__constant const parameters_t* p, __global const real* law, real distance, vector_t along) {
  const int which = (int)law[0];
  if (which == FRICTION_NONE) return R(0.0);
  if (which == FRICTION_VISCOUS) return WALL_DRAG * p->viscosity / distance;
  const real speed = fmax(sqrt(dot3(along, along)), R(1.0e-9) * p->sound_speed);
  if (which == FRICTION_COEFFICIENT) return R(0.5) * law[1] * p->density * speed;
  const real of_layer = friction_velocity(speed, distance, p->viscosity / p->density, law[1]);
  return fmax(p->viscosity / distance, p->density * of_layer * of_layer / speed);
}
#endif

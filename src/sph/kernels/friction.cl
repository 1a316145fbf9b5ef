// Friction on walls by a law that each owner of walls has: the shear stress by what a particle at a distance from the wall does along it. Of a flat wall
// Σ 2 ∫ W dS V over the particles is its area, so that this is what the stress is shared out by.
#if FRICTION_LAWS
#define WALL_KARMAN R(0.41)
#define WALL_CONSTANT R(5.2)     // B of a smooth wall: u/u_τ = ln(d u_τ/ν)/κ + B
#define ROUGHNESS_SHARE R(0.26)  // ν + 0.26 k_s u_τ in the place of ν: Nikuradse's B = 8.5 of rough walls, and Colebrook's way between
#define LEAST_PROFILE R(2.5)     // of u/u_τ: within the grains there is no law

// u_τ, by four of Newton's steps from u/15: to 1e-4 on smooth and rough walls.
INLINE real friction_velocity(real speed, real distance, real viscosity, real roughness) {
  real found = speed / R(15.0);
  for (int k = 0; k < 4; ++k) {
    const real of_grains = viscosity + ROUGHNESS_SHARE * roughness * found;
    const real law = log(fmax(distance * found / fmax(of_grains, R(1.0e-30)), R(1.0e-3))) / WALL_KARMAN + WALL_CONSTANT;
    const real profile = fmax(law, LEAST_PROFILE);
    // by how much it changes with ln u_τ
    const real slope = law > LEAST_PROFILE ? viscosity / (WALL_KARMAN * fmax(of_grains, R(1.0e-30))) : R(0.0);
    found = (speed + found * slope) / (profile + slope);
  }
  return found;
}

// Stress over speed, Pa·s/m; `law`: of MOTION_FRICTION.
SELDOM real friction_by_law(__constant const parameters_t* p, __global const real* law, real distance, vector_t along) {
  const int which = (int)law[0];
  if (which == FRICTION_VISCOUS) return p->viscosity / distance;
  const real speed = fmax(sqrt(dot3(along, along)), R(1.0e-9) * p->sound_speed);
  if (which == FRICTION_COEFFICIENT) return R(0.5) * law[1] * p->density * speed;
  if (which != FRICTION_OF_THE_WALL) return R(0.0);
  const real of_layer = friction_velocity(speed, distance, p->viscosity / p->density, law[1]);
  return fmax(p->viscosity / distance, p->density * of_layer * of_layer / speed);
}
#endif

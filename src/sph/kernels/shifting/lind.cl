// Lind's law, eq (5) of the particle shifting paper: down the gradient of the concentration, by the time step.
#define SHIFT_TENSILE 1
#define SHIFT_BY_APPROACH 0
#define SHIFT_SMOOTHS 0

INLINE vector_t shift_by_law(__constant const parameters_t* p, const shifted_t* s) {
  const real h = p->smoothing_length;
  return limited(times(-R(0.5) * h * h / s->step, s->concentration), R(0.2) * h / s->step);
}

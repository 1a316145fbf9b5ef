// Oger's law, eq (6) of the particle shifting paper: by the greatest speed that is expected, no faster than a quarter of the particle's own.
#define SHIFT_TENSILE 0
#define SHIFT_BY_APPROACH 0
#define SHIFT_SMOOTHS 0

INLINE vector_t shift_by_law(__constant const parameters_t* p, const shifted_t* s) {
  return limited(times(-p->expected_speed * p->support, s->concentration), R(0.25) * sqrt(dot3(s->velocity, s->velocity)));
}

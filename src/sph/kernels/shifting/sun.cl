// Sun's law, eq (7) of the particle shifting paper: by the greatest speed that is expected, no faster than half of it.
#define SHIFT_TENSILE 1
#define SHIFT_BY_APPROACH 0
#define SHIFT_SMOOTHS 0

INLINE vector_t shift_by_law(__constant const parameters_t* p, const shifted_t* s) {
  return limited(times(-p->expected_speed * p->support, s->concentration), R(0.5) * p->expected_speed);
}

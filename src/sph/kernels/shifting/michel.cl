// Michel's law, eq (22) of the particle shifting paper: by the greatest speed at which a neighbour comes nearer or goes away, so that it vanishes where water
// moves as a solid, and with the resolution. Under a free surface its factor goes over to 1.
#define SHIFT_TENSILE 1
#define SHIFT_BY_APPROACH 1
#define SHIFT_SMOOTHS 0

INLINE vector_t shift_by_law(__constant const parameters_t* p, const shifted_t* s) {
  const real ratio = p->support / p->spacing;
  const real factor = R(1.0) + (ratio * ratio * ratio - R(1.0)) * s->depth;
  const vector_t wanted = limited(times(-s->approach * factor * p->support, s->concentration), R(0.5) * ratio * s->approach);
  return times(R(0.5), wanted);
}

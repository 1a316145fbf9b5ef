// The rate at which a zone damps a particle's velocity, 1/s; 0 outside of it.
INLINE real damping_rate(__global const real* zone, __global const real* state, long stride, int i) {
  real way = -zone[DAMPING_SLOPE + 3];
  for (int axis = 0; axis < 3; ++axis) {
    const real x = state[(FIELD_X + axis) * stride + i];
    if (x < zone[DAMPING_LOWER + axis] || x > zone[DAMPING_UPPER + axis]) return R(0.0);
    way += zone[DAMPING_SLOPE + axis] * x;
  }
  way = fmin(fmax(way, R(0.0)), R(1.0));
  return zone[DAMPING_STRENGTH] * way * way;
}

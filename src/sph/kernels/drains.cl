// Whether a place is in a drain: DRAIN_COUNT values each, its centre and three vectors along which its faces are at −1 and 1.
INLINE bool drained(real x, real y, real z, int drain_count, __global const real* drains) {
  for (int k = 0; k < drain_count; ++k) {
    __global const real* drain = drains + k * DRAIN_COUNT;
    const real dx = x - drain[0], dy = y - drain[1], dz = z - drain[2];
    bool inside = true;  // of which a place that is not finite never is: the watchdog has to see it
    for (int side = 3; side < DRAIN_COUNT; side += 3) inside = inside && fabs(dx * drain[side] + dy * drain[side + 1] + dz * drain[side + 2]) <= R(1.0);
    if (inside) return true;
  }
  return false;
}

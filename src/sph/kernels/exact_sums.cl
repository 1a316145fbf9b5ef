// Sums that no order of theirs and no cut through them changes by a bit, as whole numbers: each value, in quanta, is a whole number and rests of it, of which
// 2^REST_BITS are one. A row of `count` such sums has all whole numbers, then all rests, and last how many values were not finite, or beyond reason.
#define RESTS ((real)(1L << REST_BITS))
#define BEYOND_REASON R(1.0e15)
#define EXACT(count) (2 * (count) + 1)

// To sum k of a row a value less what rounding has added to it. (Built without fast-math: of what is not a number no comparison holds.)
INLINE void add_exact_less(long* sums, int k, int count, real value, real rounding) {
  const bool sound = fabs(value) <= BEYOND_REASON;
  const real given = sound ? value : R(0.0);
  const real whole = rint(given);
  sums[k] += (long)whole;
  sums[count + k] += (long)rint(((given - whole) - (sound ? rounding : R(0.0))) * RESTS);
  sums[2 * count] += sound ? 0 : 1;
}

INLINE void add_exact(long* sums, int k, int count, real value) { add_exact_less(sums, k, count, value, R(0.0)); }

// To the first six sums of a row a force and its moment about a point from which it acts at (rx, ry, rz); or an impulse.
INLINE void add_exact_force(long* sums, int count, real per_force, real per_moment, real fx, real fy, real fz, real rx, real ry, real rz) {
  add_exact(sums, 0, count, per_force * fx);
  add_exact(sums, 1, count, per_force * fy);
  add_exact(sums, 2, count, per_force * fz);
  add_exact(sums, 3, count, per_moment * (ry * fz - rz * fy));
  add_exact(sums, 4, count, per_moment * (rz * fx - rx * fz));
  add_exact(sums, 5, count, per_moment * (rx * fy - ry * fx));
}

// The same sums, with rests of less than one: so many chunks of values may be added.
INLINE void carry_rests(long* sums, int count) {
  for (int k = 0; k < count; ++k) {
    const long carried = sums[count + k] >> REST_BITS;
    sums[k] += carried;
    sums[count + k] -= carried << REST_BITS;
  }
}

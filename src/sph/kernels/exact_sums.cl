// Sums that no order of theirs and no cut through them changes by a bit, as whole numbers: each value, in quanta, is a whole number and rests of it, of which
// 2³⁸ are one. A row of `count` such sums has all whole numbers, then all rests, and last how many values were not finite, or beyond reason.
#define REST_BITS 38
#define RESTS R(274877906944.0)
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

// The same sums, with rests of less than one: so many chunks of values may be added.
INLINE void carry_rests(long* sums, int count) {
  for (int k = 0; k < count; ++k) {
    const long carried = sums[count + k] >> REST_BITS;
    sums[k] += carried;
    sums[count + k] -= carried << REST_BITS;
  }
}

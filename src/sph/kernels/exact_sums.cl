// Sums that no order of theirs and no cut through them changes by a bit, as whole numbers: each value, in quanta, is a whole number and rests of it, of which
// 2³⁸ are one. In a row of such sums each has two places, and the last place of the row counts values that are not finite, or beyond reason.
#define REST_BITS 38
#define RESTS R(274877906944.0)
#define BEYOND_REASON R(1.0e15)

INLINE void add_exact(long* sums, int k, int places, real value) {
  if (not_finite(value) || fabs(value) > BEYOND_REASON) {
    ++sums[places - 1];
    return;
  }
  const real whole = rint(value);
  sums[2 * k] += (long)whole;
  sums[2 * k + 1] += (long)rint((value - whole) * RESTS);
}

// The same sums, with rests of less than one: so many chunks of values may be added.
INLINE void carry_rests(long* sums, int places) {
  for (int k = 0; k + 1 < places; k += 2) {
    const long carried = sums[k + 1] >> REST_BITS;
    sums[k] += carried;
    sums[k + 1] -= carried << REST_BITS;
  }
}

#define EXACT(values) (2 * (values) + 1)

// The neighbour loop goes through tiles: TILE_OWN particles that lie together, each with TILE_NEAR candidates at a time, as one vector. On a CPU that fills
// its vector registers: candidates alone in them would have to be summed across at the end of every short run of cells, and particles alone would be too
// many to lie together. Elsewhere a tile is one particle and one candidate.
#include "common.cl"

#ifndef TILE_OWN
#define TILE_OWN 1
#define TILE_NEAR 1
#endif
#define TILE_LANES (TILE_OWN * TILE_NEAR)

// The first particle of the work-item's tile; `count` becomes that after its last, or stays that after the last of all. In a part of the water a tile has
// particles of one segment of a row alone, so that tiles are the same whatever the parts are.
#ifdef PARTED
#define TAKE_TILE(first, count)                                                    \
  __global const int* tile_of_item = slot_start + TILE_LIST(p);                    \
  if ((int)get_global_id(0) >= tile_of_item[0]) return;                            \
  const int first = tile_of_item[1 + 2 * get_global_id(0)];                        \
  count = tile_of_item[2 + 2 * get_global_id(0)];
#else
#define TAKE_TILE(first, count)                    \
  const int first = TILE_OWN * get_global_id(0);   \
  if (first >= count) return;
#endif

// A function for few tiles. Where others would have its code in the midst of theirs, they are slower and all takes twice as long to compile.
#if TILE_LANES > 1
#define SELDOM static __attribute__((noinline))
#else
#define SELDOM INLINE
#endif

#if TILE_LANES == 1
typedef real tile;
#elif USE_DOUBLE && TILE_LANES == 4
typedef double4 tile;
#elif USE_DOUBLE && TILE_LANES == 8
typedef double8 tile;
#elif TILE_LANES == 4
typedef float4 tile;
#elif TILE_LANES == 8
typedef float8 tile;
#elif TILE_LANES == 16
typedef float16 tile;
#endif

// spread_own(v): the value of each own particle, once for each candidate; near_values(v, j): of the candidates from j on, once for each own particle;
// beyond_end(left): nothing for each candidate but those after the first `left`, which it puts far away. OWN_LANES: which own particle each lane has.
// own_sums: over the candidates, of each own particle. Lane l is that of own particle l / TILE_NEAR and candidate l % TILE_NEAR: lanes_of and tile_of have
// each by itself.
#define FAR_AWAY R(1.0e12)
#if TILE_NEAR > 1
__constant real after_end[2 * TILE_NEAR] = {
    R(0.0), R(0.0),
#if TILE_NEAR >= 4
    R(0.0), R(0.0),
#endif
#if TILE_NEAR >= 8
    R(0.0), R(0.0), R(0.0), R(0.0),
#endif
#if TILE_NEAR >= 16
    R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0),
#endif
    FAR_AWAY, FAR_AWAY,
#if TILE_NEAR >= 4
    FAR_AWAY, FAR_AWAY,
#endif
#if TILE_NEAR >= 8
    FAR_AWAY, FAR_AWAY, FAR_AWAY, FAR_AWAY,
#endif
#if TILE_NEAR >= 16
    FAR_AWAY, FAR_AWAY, FAR_AWAY, FAR_AWAY, FAR_AWAY, FAR_AWAY, FAR_AWAY, FAR_AWAY,
#endif
};
#define AFTER_END(left) (after_end + TILE_NEAR - min(left, TILE_NEAR))
#endif

#if TILE_LANES == 1
INLINE tile spread_own(const real* v) { return v[0]; }
INLINE tile own_values(__global const real* v, int i) { return v[i]; }
INLINE tile near_values(__global const real* v, int j) { return v[j]; }
INLINE void own_sums(tile a, real* sums) { sums[0] = a; }
#define OWN_LANES R(0.0)

#elif TILE_OWN == 4 && TILE_NEAR == 4
INLINE tile spread_own(const real* v) { return vload4(0, v).s0000111122223333; }
INLINE tile own_values(__global const real* v, int i) { return vload4(0, v + i).s0000111122223333; }
INLINE tile near_values(__global const real* v, int j) { return vload4(0, v + j).s0123012301230123; }
INLINE void own_sums(tile a, real* sums) { vstore4((a.s048c + a.s159d) + (a.s26ae + a.s37bf), 0, sums); }
INLINE tile beyond_end(int left) { return vload4(0, AFTER_END(left)).s0123012301230123; }
#define OWN_LANES (tile)(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3)

#elif TILE_OWN == 2 && TILE_NEAR == 4
INLINE tile spread_own(const real* v) { return vload2(0, v).s00001111; }
INLINE tile own_values(__global const real* v, int i) { return vload2(0, v + i).s00001111; }
INLINE tile near_values(__global const real* v, int j) { return vload4(0, v + j).s01230123; }
INLINE void own_sums(tile a, real* sums) { vstore2((a.s04 + a.s15) + (a.s26 + a.s37), 0, sums); }
INLINE tile beyond_end(int left) { return vload4(0, AFTER_END(left)).s01230123; }
#define OWN_LANES (tile)(0, 0, 0, 0, 1, 1, 1, 1)

#elif TILE_OWN == 2 && TILE_NEAR == 2
INLINE tile spread_own(const real* v) { return vload2(0, v).s0011; }
INLINE tile own_values(__global const real* v, int i) { return vload2(0, v + i).s0011; }
INLINE tile near_values(__global const real* v, int j) { return vload2(0, v + j).s0101; }
INLINE void own_sums(tile a, real* sums) { vstore2(a.s02 + a.s13, 0, sums); }
INLINE tile beyond_end(int left) { return vload2(0, AFTER_END(left)).s0101; }
#define OWN_LANES (tile)(0, 0, 1, 1)

// of points, which need not lie together
#elif TILE_OWN == 1
INLINE tile spread_own(const real* v) { return (tile)(v[0]); }
INLINE tile own_values(__global const real* v, int i) { return (tile)(v[i]); }
#define OWN_LANES (tile)(R(0.0))
INLINE real sum4(
#if USE_DOUBLE
    double4
#else
    float4
#endif
        v) {
  return (v.s0 + v.s1) + (v.s2 + v.s3);
}
#if TILE_NEAR == 16
INLINE tile near_values(__global const real* v, int j) { return vload16(0, v + j); }
INLINE void own_sums(tile a, real* sums) { sums[0] = sum4((a.s0123 + a.s4567) + (a.s89ab + a.scdef)); }
INLINE tile beyond_end(int left) { return vload16(0, AFTER_END(left)); }
#elif TILE_NEAR == 8
INLINE tile near_values(__global const real* v, int j) { return vload8(0, v + j); }
INLINE void own_sums(tile a, real* sums) { sums[0] = sum4(a.s0123 + a.s4567); }
INLINE tile beyond_end(int left) { return vload8(0, AFTER_END(left)); }
#else
INLINE tile near_values(__global const real* v, int j) { return vload4(0, v + j); }
INLINE void own_sums(tile a, real* sums) { sums[0] = sum4(a); }
INLINE tile beyond_end(int left) { return vload4(0, AFTER_END(left)); }
#endif
#endif

#if TILE_LANES == 4
INLINE void lanes_of(tile v, real* lanes) { vstore4(v, 0, lanes); }
INLINE tile tile_of(const real* lanes) { return vload4(0, lanes); }
#elif TILE_LANES == 8
INLINE void lanes_of(tile v, real* lanes) { vstore8(v, 0, lanes); }
INLINE tile tile_of(const real* lanes) { return vload8(0, lanes); }
#elif TILE_LANES == 16
INLINE void lanes_of(tile v, real* lanes) { vstore16(v, 0, lanes); }
INLINE tile tile_of(const real* lanes) { return vload16(0, lanes); }
#endif

// 1 where x is above the bound, else 0. (step() of some compilers goes through the lanes one by one.)
INLINE tile one_above(tile x, tile bound) { return x > bound ? (tile)(R(1.0)) : (tile)(R(0.0)); }

// Whether a comparison of tiles is true of any lane. any() of pocl goes through the lanes by branches.
#if defined(__has_builtin)
#if __has_builtin(__builtin_reduce_or)
#define ANY_LANE(comparison) (__builtin_reduce_or(comparison) != 0)
#endif
#endif
#ifndef ANY_LANE
#define ANY_LANE(comparison) any(comparison)
#endif

// The greatest over the candidates, of each own particle.
INLINE void own_greatest(tile a, real* greatest) {
#if TILE_LANES == 1
  greatest[0] = a;
#else
  real lanes[TILE_LANES];
  lanes_of(a, lanes);
  for (int k = 0; k < TILE_OWN; ++k) {
    greatest[k] = lanes[k * TILE_NEAR];
    for (int lane = k * TILE_NEAR + 1; lane < (k + 1) * TILE_NEAR; ++lane) greatest[k] = fmax(greatest[k], lanes[lane]);
  }
#endif
}

typedef struct {
  real x, y, z;
} vector_t;

#if TILE_LANES == 1
typedef vector_t tile_vector_t;
#else
typedef struct {
  tile x, y, z;
} tile_vector_t;
#endif

INLINE tile_vector_t make_tile_vector(tile x, tile y, tile z) {
  tile_vector_t v = {x, y, z};
  return v;
}

INLINE tile tile_dot(tile_vector_t a, tile_vector_t b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

INLINE tile_vector_t tile_cross(vector_t a, tile_vector_t b) {
  return make_tile_vector(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

// Wendland C2: W(r) and F(r) = −W'(r)/r, so that ∇_i W = F (x_j − x_i). Both vanish beyond 2h without a branch.
INLINE tile kernel_values(__constant const parameters_t* p, tile distance) {
  const tile t = fmax(R(1.0) - distance * p->inverse_support, R(0.0));
  const tile tt = t * t;
  return p->kernel_scale * tt * tt * (R(5.0) - R(4.0) * t);
}

// F but for its factor p->slope_scale, which sums of it are given once.
INLINE tile kernel_slopes(__constant const parameters_t* p, tile distance) {
  const tile t = fmax(R(1.0) - distance * p->inverse_support, R(0.0));
  return t * t * t;
}

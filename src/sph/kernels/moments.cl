// Σ_j r ⊗ ∇W V_j of a tile's own particles, but for the factor p->slope_scale: symmetric.
typedef struct {
  tile xx, xy, xz, yy, yz, zz;
} moments_t;

typedef struct {
  real xx, xy, xz, yy, yz, zz;
} symmetric_t;

// (wx, wy, wz) is V ∇W.
INLINE void add_to_moments(moments_t* m, tile rx, tile ry, tile rz, tile wx, tile wy, tile wz) {
  m->xx += wx * rx;
  m->xz += wx * rz;
  m->zz += wz * rz;
#if DIMENSIONS == 3
  m->xy += wx * ry;
  m->yy += wy * ry;
  m->yz += wy * rz;
#endif
}

INLINE void finish_moments(const moments_t* m, symmetric_t* own) {
  real xx[TILE_OWN], xy[TILE_OWN], xz[TILE_OWN], yy[TILE_OWN], yz[TILE_OWN], zz[TILE_OWN];
  own_sums(m->xx, xx);
  own_sums(m->xy, xy);
  own_sums(m->xz, xz);
  own_sums(m->yy, yy);
  own_sums(m->yz, yz);
  own_sums(m->zz, zz);
  for (int k = 0; k < TILE_OWN; ++k) {
    const symmetric_t of_k = {xx[k], xy[k], xz[k], yy[k], yz[k], zz[k]};
    own[k] = of_k;
  }
}

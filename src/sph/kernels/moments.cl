// What sums over V ∇W of a tile's candidates are made of, and the first of them. All but for the factor p->slope_scale.
typedef struct {
  int j;                // the first candidate
  tile rx, ry, rz, r2;  // x_j − x_i, m; m²
  tile distance;        // m
  tile volume;          // V_j
  tile over_distance;   // F V_j
  tile x, y, z;         // ∇W V_j
} slope_t;

INLINE slope_t slope_of(__constant const parameters_t* p, const neighbours_t* n, int j, tile rx, tile ry, tile rz, tile r2) {
  slope_t s;
  s.j = j;
  s.rx = rx;
  s.ry = ry;
  s.rz = rz;
  s.r2 = r2;
  s.distance = sqrt(r2);
  s.volume = near_volume(n, j);
  s.over_distance = kernel_slopes(p, s.distance) * s.volume;
  s.x = s.over_distance * rx;
  s.y = s.over_distance * ry;
  s.z = s.over_distance * rz;
  return s;
}

// Σ_j r ⊗ ∇W V_j: symmetric.
typedef struct {
  tile xx, xy, xz, yy, yz, zz;
} moments_t;

typedef struct {
  real xx, xy, xz, yy, yz, zz;
} symmetric_t;

INLINE void add_to_moments(moments_t* m, const slope_t* s) {
  m->xx += s->x * s->rx;
  m->xz += s->x * s->rz;
  m->zz += s->z * s->rz;
#if DIMENSIONS == 3
  m->xy += s->x * s->ry;
  m->yy += s->y * s->ry;
  m->yz += s->y * s->rz;
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

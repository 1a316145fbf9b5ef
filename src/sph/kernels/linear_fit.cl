// The fluid's pressure on a wall by a weighted linear fit. What hydrostatics explains is taken out first, and the slope that is left is fitted with a
// small ridge, so that a few particles in a droplet give their average and many give the true slope: an average alone misses what an impact or a curved
// stream adds towards a wall.
#define FIT_SUMS(type)                                \
  type weight, pressure;       /* Σ w, Σ w p */     \
  type x, y, z;                /* Σ w r */          \
  type xx, xy, xz, yy, yz, zz; /* Σ w r r */        \
  type px, py, pz;             /* Σ w p r */

typedef struct {
  FIT_SUMS(tile)
} tile_fit_t;

typedef struct {
  FIT_SUMS(real)
} linear_fit_t;

// r = x_j − x; pressure is the particle's own, carried to the point by hydrostatics.
INLINE void add_to_fit(tile_fit_t* f, tile weight, tile pressure, tile rx, tile ry, tile rz) {
  const tile wx = weight * rx, wz = weight * rz;
  f->weight += weight;
  f->pressure += weight * pressure;
  f->x += wx;
  f->z += wz;
  f->xx += wx * rx;
  f->xz += wx * rz;
  f->zz += wz * rz;
  f->px += wx * pressure;
  f->pz += wz * pressure;
#if DIMENSIONS == 3
  const tile wy = weight * ry;
  f->y += wy;
  f->xy += wx * ry;
  f->yy += wy * ry;
  f->yz += wy * rz;
  f->py += wy * pressure;
#endif
}

// The fit of each own particle.
INLINE void own_fits(const tile_fit_t* f, linear_fit_t* fits) {
  real sums[TILE_OWN];
#define OWN_FIT(sum)         \
  own_sums(f->sum, sums);    \
  for (int k = 0; k < TILE_OWN; ++k) fits[k].sum = sums[k];
  OWN_FIT(weight)
  OWN_FIT(pressure)
  OWN_FIT(x)
  OWN_FIT(z)
  OWN_FIT(xx)
  OWN_FIT(xz)
  OWN_FIT(zz)
  OWN_FIT(px)
  OWN_FIT(pz)
#if DIMENSIONS == 3
  OWN_FIT(y)
  OWN_FIT(xy)
  OWN_FIT(yy)
  OWN_FIT(yz)
  OWN_FIT(py)
#endif
}

#define FIT_RIDGE R(0.02)  // of h²

// The fitted plane: the pressure at the point itself and its slope, what hydrostatics explains left out.
typedef struct {
  real value, slope_x, slope_y, slope_z;
} plane_t;

// The weights' sum must not be zero. `added_slope` is added to every pressure's slope before the fit: what the sums took out with another gravity.
INLINE plane_t fitted_plane(__constant const parameters_t* p, const linear_fit_t* f, vector_t added_slope) {
  const real scale = R(1.0) / f->weight;
  const real mx = f->x * scale, mz = f->z * scale;
  const real ridge = FIT_RIDGE * p->smoothing_length * p->smoothing_length;
  const real spread_xx = f->xx * scale - mx * mx, xz = f->xz * scale - mx * mz, spread_zz = f->zz * scale - mz * mz;
  const real xx = spread_xx + ridge, zz = spread_zz + ridge;
  const real own_mean = f->pressure * scale;
  real mean = own_mean + added_slope.x * mx + added_slope.z * mz;
  real bx = f->px * scale - own_mean * mx + spread_xx * added_slope.x + xz * added_slope.z;
  real bz = f->pz * scale - own_mean * mz + xz * added_slope.x + spread_zz * added_slope.z;
  plane_t plane;
#if DIMENSIONS == 3
  const real my = f->y * scale;
  const real xy = f->xy * scale - mx * my;
  const real spread_yy = f->yy * scale - my * my;
  const real yy = spread_yy + ridge;
  const real yz = f->yz * scale - my * mz;
  mean += added_slope.y * my;
  bx += xy * added_slope.y;
  bz += yz * added_slope.y;
  const real by = f->py * scale - own_mean * my + xy * added_slope.x + spread_yy * added_slope.y + yz * added_slope.z;
  const real c_xx = yy * zz - yz * yz, c_xy = xz * yz - xy * zz, c_xz = xy * yz - xz * yy;
  const real c_yy = xx * zz - xz * xz, c_yz = xy * xz - xx * yz, c_zz = xx * yy - xy * xy;
  const real inverse = R(1.0) / (xx * c_xx + xy * c_xy + xz * c_xz);
  plane.slope_x = inverse * (c_xx * bx + c_xy * by + c_xz * bz);
  plane.slope_y = inverse * (c_xy * bx + c_yy * by + c_yz * bz);
  plane.slope_z = inverse * (c_xz * bx + c_yz * by + c_zz * bz);
  plane.value = mean - (plane.slope_x * mx + plane.slope_y * my + plane.slope_z * mz);
#else
  const real inverse = R(1.0) / (xx * zz - xz * xz);
  plane.slope_x = inverse * (zz * bx - xz * bz);
  plane.slope_y = R(0.0);
  plane.slope_z = inverse * (xx * bz - xz * bx);
  plane.value = mean - (plane.slope_x * mx + plane.slope_z * mz);
#endif
  return plane;
}

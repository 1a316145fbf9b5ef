// Short-range repulsion by the foot of the particle on a plane ([B] of docs/numerics.md, §4): Lennard–Jones with exponents 4 and 2, from half a spacing on, and no harder
// than at a tenth of it. Pa/m, away from the plane.
INLINE real repulsion_at(__constant const parameters_t* p, real distance, real density) {
  const real reach = R(0.5) * p->spacing;
  if (distance >= reach) return R(0.0);
  const real d = fmax(distance, R(0.2) * reach);
  const real ratio2 = reach * reach / (d * d);
  return p->repulsion * density * (ratio2 * ratio2 - ratio2) / d;
}

#if GHOSTS
// By the planes that mirror, added to a force.
INLINE void add_repulsion(vector_t* force, __constant const parameters_t* p, __global const real* images, real x, real y, real z, real density) {
  for (int k = 0; k < p->images; ++k) {
    __global const real* image = images + k * IMAGE_COUNT;
    if (image[IMAGE_MIRRORED] < R(0.5) || image[IMAGE_NEAR + 4] != R(0.0) || image[IMAGE_NEAR + 5] != R(0.0) || image[IMAGE_NEAR + 6] != R(0.0)) continue;
    __global const real* plane = image + IMAGE_NEAR;
    real size = repulsion_at(p, plane[0] * x + plane[1] * y + plane[2] * z + plane[3], density);
#if PIERCED
    __global const real* gaps;
    const int count = gaps_of_image(p, images, k, &gaps);
    size *= mirrored_part(p, gaps, count, x, y, z);
#endif
    // n·x + o is the distance: n points into the fluid
    force->x += size * plane[0];
    force->y += size * plane[1];
    force->z += size * plane[2];
  }
}
#endif

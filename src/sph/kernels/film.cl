// Water in gaps too narrow for particles, or not filled by them (src/simulation/water_film.h), as particles beside the gap feel it: lumps of it that stand
// in for the particles that are missing there. Without them the gap would be empty, and the water would shoot into it. `film`: how many blocks of lumps;
// of each its bounding box, widened by the support, and its first and its end lump; then the lumps. Those behind a thin wall are felt as particles there are.
#define FILM_BLOCKS 1
#define FILM_BLOCK 8
#define FILM_FIRST 6
#define FILM_END 7
#define FILM_LUMP 5
#define FILM_VOLUME 3
#define FILM_PRESSURE 4

// Σ (own + share p_f) F V (x_f − x) over the lumps, F but for p->slope_scale.
INLINE vector_t film_about(__constant const parameters_t* p, const walls_t* walls, __global const real* film, real own, real share, real x, real y, real z) {
  vector_t sum = make_vector(R(0.0), R(0.0), R(0.0));
  const int blocks = (int)film[0];
  for (int b = 0; b < blocks; ++b) {
    __global const real* block = film + FILM_BLOCKS + FILM_BLOCK * b;
    if (x < block[0] || x > block[1] || y < block[2] || y > block[3] || z < block[4] || z > block[5]) continue;
    for (int k = (int)block[FILM_FIRST]; k < (int)block[FILM_END]; ++k) {
      __global const real* lump = film + FILM_BLOCKS + FILM_BLOCK * blocks + FILM_LUMP * k;
      const real rx = lump[0] - x, ry = lump[1] - y, rz = lump[2] - z;
      const real t = fmax(R(1.0) - sqrt(rx * rx + ry * ry + rz * rz) * p->inverse_support, R(0.0));
      real weight = (own + share * lump[FILM_PRESSURE]) * t * t * t * lump[FILM_VOLUME];
#if THIN_WALLS
      if (has_barriers(p, walls, x, y, z) && hidden_in_cell(p, walls, x, y, z, rx, ry, rz) != NO_OWNER) weight *= transparency_at(p, walls, x, y, z);
#endif
      sum = make_vector(sum.x + weight * rx, sum.y + weight * ry, sum.z + weight * rz);
    }
  }
  return sum;
}

INLINE vector_t film_sum(__constant const parameters_t* p, const walls_t* walls, __global const real* film, __global const real* images, real own, real share,
                         real x, real y, real z) {
  vector_t sum = film_about(p, walls, film, own, share, x, y, z);
#if IMAGES
  for (int k = 0; k < p->images && film[0] > R(0.0); ++k) {
    __global const real* image = images + k * IMAGE_COUNT;
    if (image[IMAGE_MIRRORED] > R(0.5) || !near_image(p, image, x, y, z)) continue;
    const vector_t seen = seen_by_image(image, x, y, z);
    const vector_t more = film_about(p, walls, film, own, share, seen.x, seen.y, seen.z);
    sum = make_vector(sum.x + more.x, sum.y + more.y, sum.z + more.z);
  }
#endif
  return make_vector(p->slope_scale * sum.x, p->slope_scale * sum.y, p->slope_scale * sum.z);
}

// Water in gaps too narrow for particles, or not filled by them (src/simulation/water_film.h), as particles beside the gap feel it: lumps of it that stand
// in for the particles that are missing there. Without them the gap would be empty, and the water would shoot into it. `film`: how many blocks of lumps;
// of each its bounding box, widened by the support, and its first and its end lump; then the lumps. Those behind a thin wall are felt as particles there are.
#define FILM_BLOCKS 1
#define FILM_BLOCK 8
#define FILM_FIRST 6
#define FILM_END 7
#define FILM_LUMP 6
#define FILM_VOLUME 3
#define FILM_PRESSURE 4
#define FILM_CLOSED_VOLUME 5

typedef struct {
  vector_t push;          // Σ (own + share p_f) F V (x_f − x)
  vector_t side;          // Σ F V_c (x_f − x), V_c what is of closed gaps
  real closed, pressure;  // Σ W V_c, Σ p_f W V_c
} film_sums_t;

// Adds those over the lumps, F and W but for p->slope_scale and p->kernel_scale.
INLINE void add_film_about(film_sums_t* sums, __constant const parameters_t* p, const walls_t* walls, __global const real* film, real own, real share, real x,
                           real y, real z) {
  const int blocks = (int)film[0];
  for (int b = 0; b < blocks; ++b) {
    __global const real* block = film + FILM_BLOCKS + FILM_BLOCK * b;
    if (x < block[0] || x > block[1] || y < block[2] || y > block[3] || z < block[4] || z > block[5]) continue;
    for (int k = (int)block[FILM_FIRST]; k < (int)block[FILM_END]; ++k) {
      __global const real* lump = film + FILM_BLOCKS + FILM_BLOCK * blocks + FILM_LUMP * k;
      const real rx = lump[0] - x, ry = lump[1] - y, rz = lump[2] - z;
      const real t = fmax(R(1.0) - sqrt(rx * rx + ry * ry + rz * rz) * p->inverse_support, R(0.0));
      real slope = t * t * t;
#if THIN_WALLS
      if (has_barriers(p, walls, x, y, z) && hidden_in_cell(p, walls, x, y, z, rx, ry, rz) != NO_OWNER) slope *= transparency_at(p, walls, x, y, z);
#endif
      const real weight = (own + share * lump[FILM_PRESSURE]) * slope * lump[FILM_VOLUME], side = slope * lump[FILM_CLOSED_VOLUME];
      const real value = side * t * (R(5.0) - R(4.0) * t);
      sums->push = make_vector(sums->push.x + weight * rx, sums->push.y + weight * ry, sums->push.z + weight * rz);
      sums->side = make_vector(sums->side.x + side * rx, sums->side.y + side * ry, sums->side.z + side * rz);
      sums->closed += value;
      sums->pressure += value * lump[FILM_PRESSURE];
    }
  }
}

INLINE film_sums_t film_sums(__constant const parameters_t* p, const walls_t* walls, __global const real* film, __global const real* images, real own,
                             real share, real x, real y, real z) {
  film_sums_t sums = {make_vector(R(0.0), R(0.0), R(0.0)), make_vector(R(0.0), R(0.0), R(0.0)), R(0.0), R(0.0)};
  add_film_about(&sums, p, walls, film, own, share, x, y, z);
#if IMAGES
  for (int k = 0; k < p->images && film[0] > R(0.0); ++k) {
    __global const real* image = images + k * IMAGE_COUNT;
    if (image[IMAGE_MIRRORED] > R(0.5) || !near_image(p, image, x, y, z)) continue;
    const vector_t seen = seen_by_image(image, x, y, z);
    add_film_about(&sums, p, walls, film, own, share, seen.x, seen.y, seen.z);
  }
#endif
  return sums;
}

INLINE vector_t film_push(__constant const parameters_t* p, const walls_t* walls, __global const real* film, __global const real* images, real own, real share,
                          real x, real y, real z) {
  const vector_t push = film_sums(p, walls, film, images, own, share, x, y, z).push;
  return make_vector(p->slope_scale * push.x, p->slope_scale * push.y, p->slope_scale * push.z);
}

// The divergence about a particle with what the film does to it. One that a gap has closed about is in the film, which takes what it has too much: its
// pressure goes to the film's in some steps, and walls that come together do not press it without end. The film is all about it then, and is most of what
// walls leave of the kernel; one at the gap's mouth has it on one side, one in a slit between two gaps has little of it.
#define LEAK_RATE R(0.5)  // of c₀/h
#define ONE_SIDED R(1.0)  // of h |Σ ∇W V|/Σ W V; at a mouth 1.4
#define ALL_ABOUT R(0.5)
#define LEAST_CLOSED R(0.3)  // of the Shepard factor
#define WHOLLY_CLOSED R(0.6)
INLINE real divergence_in_film(__constant const parameters_t* p, const walls_t* walls, __global const real* film, __global const real* images, real compression,
                               real shepard, real x, real y, real z, real divergence) {
  if (!(film[0] > R(0.0))) return divergence;
  const film_sums_t sums = film_sums(p, walls, film, images, R(1.0), R(0.0), x, y, z);
  const real closed = p->kernel_scale * sums.closed;
  if (!(closed > R(1.0e-3))) return divergence;
  const real side = p->smoothing_length * p->slope_scale * sqrt(dot3(sums.side, sums.side)) / closed;
  real within = fmin(fmax((ONE_SIDED - side) / (ONE_SIDED - ALL_ABOUT), R(0.0)), R(1.0));
#if SHEPARD_GEOMETRIC || SHEPARD_VOLUMETRIC
  within *= fmin(fmax((closed / bounded_shepard(shepard) - LEAST_CLOSED) / (WHOLLY_CLOSED - LEAST_CLOSED), R(0.0)), R(1.0));
#endif
  const real leak = LEAK_RATE * p->sound_speed * p->inverse_smoothing * (compression - sums.pressure / (sums.closed * p->bulk_modulus));
  return divergence + within * (leak - divergence);
}

// The one neighbour loop. A sweep is a file that defines, before it includes this one,
//   SWEEP_PARTICLES   if it goes over particles:
//     sweep_t                                      its inputs, the tile's own values and its sums; `near` are the neighbours,
//     add_particle(sweep_t*, p, j, rx, ry, rz, r2) the candidates of a tile from j on, at (rx, ry, rz) = x_j − x, for every candidate of the rows (W and F
//                                                  vanish beyond the support, so no branch is needed, and what does not count is put far away),
//   SWEEP_WALLS       if it goes over walls, which is done for one particle at a time:
//     wall_sweep_t                                 its inputs, own values and sums,
//     add_wall(wall_sweep_t*, p, s, x, y, z)       one wall element or facet that may be within the support of (x, y, z),
// and whose kernel starts the sums, calls the loop, and finishes them.
// Particles lie in memory along rows, slot after slot. Of each row near a tile only the slots within reach of it are gone through: one contiguous run.
// Elements are sorted by cells of the support's size, x fastest: three cells in a row are one contiguous run. Facets are larger than cells: each cell has a
// list of those within the support of it.
#ifdef SWEEP_PARTICLES
#if defined(KEEPS_BLOCKS) || defined(TAKES_BLOCKS)
#define GOES_BY_BLOCKS 1
#else
#define GOES_BY_BLOCKS 0
#endif
#include "runs.cl"
#if THIN_WALLS
#include "sight.cl"
#endif

#if TILE_LANES == 1
#include "walk_one.cl"
#else
#include "walk_tile.cl"
#endif

#if IMAGES
// Whether the image's neighbours can be within the support of any particle of the tile; and where they all lie as the image's originals see them.
INLINE bool places_near_image(__constant const parameters_t* p, const neighbours_t* near, __global const real* image) {
  bool any = false;
  for (int k = 0; k < TILE_OWN; ++k)
    any = any || (k < near->own && near_image(p, image, near->places.x[k], near->places.y[k], near->places.z[k]));
  return any;
}

INLINE places_t places_seen_by_image(__global const real* image, const places_t* places) {
  places_t seen;
  for (int k = 0; k < TILE_OWN; ++k) {
    const vector_t v = seen_by_image(image, places->x[k], places->y[k], places->z[k]);
    seen.x[k] = v.x;
    seen.y[k] = v.y;
    seen.z[k] = v.z;
  }
  return seen;
}
#endif

#if GHOSTS
// As the image's originals see them, and back: a reflection is its own inverse.
INLINE void turn_rests(neighbours_t* near) {
#if LONG_AXES
  const vector_t rest = turned(near->image + IMAGE_MATRIX, near->rest[0], near->rest[1], near->rest[2]);
  near->rest[0] = rest.x;
  near->rest[1] = rest.y;
  near->rest[2] = rest.z;
#endif
}

#if PIERCED
// Those of the image's planes, if any matters to what is swept: tiles are of one.
INLINE void find_gaps(neighbours_t* near, __constant const parameters_t* p, __global const real* images, int image) {
  near->gap_count = gaps_of_image(p, images, image, &near->gaps);
  if (!near_gap(p, near->gaps, near->gap_count, near->places.x[0], near->places.y[0], near->places.z[0])) near->gap_count = 0;
}
#endif

// The ghosts alone.
INLINE void sweep_ghosts(sweep_t* sums, __constant const parameters_t* p, __global const int* slot_start, __global const real* images) {
  for (int k = 0; k < p->images; ++k) {
    __global const real* image = images + k * IMAGE_COUNT;
    if (image[IMAGE_MIRRORED] < R(0.5) || !places_near_image(p, &sums->near, image)) continue;
    const places_t seen = places_seen_by_image(image, &sums->near.places);
    sums->near.mirrored = true;
    sums->near.image = image;
    turn_rests(&sums->near);
#if PIERCED
    find_gaps(&sums->near, p, images, k);
#endif
    sweep_rows(sums, p, slot_start, &seen);
    turn_rests(&sums->near);
    sums->near.mirrored = false;
#if PIERCED
    sums->near.seen = R(1.0);
#endif
  }
}
#endif

// The tank itself, and the images that repeat it: one call, or the whole loop would be compiled twice.
INLINE void sweep_repeated(sweep_t* sums, __constant const parameters_t* p, __global const int* slot_start, __global const real* images) {
  places_t at = sums->near.places;
#if IMAGES
  for (int k = -1; k < p->images; ++k) {
    if (k >= 0) {
      __global const real* image = images + k * IMAGE_COUNT;
      if (image[IMAGE_MIRRORED] > R(0.5) || !places_near_image(p, &sums->near, image)) continue;
      at = places_seen_by_image(image, &sums->near.places);
    }
    sweep_rows(sums, p, slot_start, &at);
  }
#else
  sweep_rows(sums, p, slot_start, &at);
#endif
}

#if HAS_BLOCK_LIST && GOES_BY_BLOCKS
#ifdef KEEPS_BLOCKS
// Not of tiles beside an end that repeats itself, whose list would need to say which image a block is of.
INLINE void keep_blocks(neighbours_t* near, __constant const parameters_t* p, __global const int* slot_start, __global const real* images) {
  near->blocks[0] = -1;
#if IMAGES
  for (int k = 0; k < p->images; ++k)
    if (places_near_image(p, near, images + k * IMAGE_COUNT)) return;
#endif
  list_blocks(near, p, slot_start, &near->places);
}
#endif

// Tiles in spray or beside an end that repeats itself, and those with more neighbours than the list has room for.
SELDOM void sweep_unlisted(sweep_t* sums, __constant const parameters_t* p, __global const int* slot_start, __global const real* images) {
  sweep_repeated(sums, p, slot_start, images);
}
#endif

INLINE void sweep_particles(sweep_t* sums, __constant const parameters_t* p, __global const int* slot_start, __global const real* images) {
#if THIN_WALLS
  const places_t at = sums->near.places;
  for (int k = 0; k < TILE_OWN; ++k)
    if (k < sums->near.own) sums->near.transparency[k] = transparency_at(p, sums->near.walls, at.x[k], at.y[k], at.z[k]);
#endif
#if HAS_BLOCK_LIST && GOES_BY_BLOCKS
#ifdef KEEPS_BLOCKS
  keep_blocks(&sums->near, p, slot_start, images);
#endif
  if (sums->near.blocks[0] >= 0)
    sweep_listed(sums, p, &sums->near.places);
  else
    sweep_unlisted(sums, p, slot_start, images);
#else
  sweep_repeated(sums, p, slot_start, images);
#endif
#if GHOSTS
  sweep_ghosts(sums, p, slot_start, images);
#endif
}
#endif

#include "sweep_walls.cl"

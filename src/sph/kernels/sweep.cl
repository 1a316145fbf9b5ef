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
typedef struct {
  real x0, x1, y0, y1, z0, z1;
} box_t;

INLINE box_t box_of_place(const places_t* places, int k) {
  const box_t box = {places->x[k], places->x[k], places->y[k], places->y[k], places->z[k], places->z[k]};
  return box;
}

INLINE box_t box_of_places(const places_t* places, int own) {
  box_t box = box_of_place(places, 0);
  for (int k = 1; k < TILE_OWN; ++k) {
    if (k >= own) continue;
    box.x0 = fmin(box.x0, places->x[k]);
    box.x1 = fmax(box.x1, places->x[k]);
    box.y0 = fmin(box.y0, places->y[k]);
    box.y1 = fmax(box.y1, places->y[k]);
    box.z0 = fmin(box.z0, places->z[k]);
    box.z1 = fmax(box.z1, places->z[k]);
  }
  return box;
}

// The rows within reach of a box, from y0 to y1 and z0 to z1.
typedef struct {
  int y0, y1, z0, z1;
} rows_t;

INLINE rows_t rows_near(__constant const parameters_t* p, const box_t* box, real reach) {
  rows_t rows;
#if DIMENSIONS == 3
  rows.y0 = cell_coordinate(box->y0 - reach, p->inverse_row, p->rows_y);
  rows.y1 = cell_coordinate(box->y1 + reach, p->inverse_row, p->rows_y);
#else
  rows.y0 = rows.y1 = 0;
#endif
  rows.z0 = cell_coordinate(box->z0 - reach, p->inverse_row, p->rows_z);
  rows.z1 = cell_coordinate(box->z1 + reach, p->inverse_row, p->rows_z);
  return rows;
}

// What lies beyond the grid is in its outermost rows and slots: it counts as lying on the grid's border, which is never farther from anything.
INLINE box_t within_grid(__constant const parameters_t* p, box_t box) {
  const real top = (real)(p->rows_z - 2) * p->row_side;
  box.z0 = fmin(fmax(box.z0, R(0.0)), top);
  box.z1 = fmin(fmax(box.z1, R(0.0)), top);
#if DIMENSIONS == 3
  const real width = (real)(p->rows_y - 2) * p->row_side;
  box.y0 = fmin(fmax(box.y0, R(0.0)), width);
  box.y1 = fmin(fmax(box.y1, R(0.0)), width);
#endif
  return box;
}

// How far the box is from row r in one direction.
INLINE real gap_to_row(__constant const parameters_t* p, int r, real low, real high) {
  const real begin = (real)(r - 1) * p->row_side;
  return fmax(fmax(begin - high, low - (begin + p->row_side)), R(0.0));
}

INLINE real gap_y_to_row(__constant const parameters_t* p, int r, const box_t* box) {
#if DIMENSIONS == 3
  return gap_to_row(p, r, box->y0, box->y1);
#else
  return R(0.0);
#endif
}

// The slots that the ends of a box along x fall into, as lengths of slots from the grid's border.
typedef struct {
  real x0, x1;
} span_t;

INLINE span_t span_of(__constant const parameters_t* p, const box_t* box) {
  const span_t span = {box->x0 * p->inverse_slot, box->x1 * p->inverse_slot};
  return span;
}

typedef struct {
  int begin, end;  // particles
} run_t;

// The particles of a row that may be within reach of the box; `left`: the square of the reach less that of the gap between them. None if end ≤ begin.
INLINE run_t run_of_row(__constant const parameters_t* p, __global const int* slot_start, const span_t* span, real left, int row) {
  const real half_length = sqrt(fmax(left, R(0.0))) * p->inverse_slot;
  const int most = p->slots_x - 2;
  const int first = min(max((int)(span->x0 - half_length) + 1, 1), most), last = min(max((int)(span->x1 + half_length) + 1, 1), most);
  run_t run;
  run.begin = slot_start[row * p->slots_x + first];
  run.end = left > R(0.0) ? slot_start[row * p->slots_x + last + 1] : run.begin;
  return run;
}

#if THIN_WALLS
#include "sight.cl"
#endif

#if TILE_LANES == 1
INLINE void sweep_run(sweep_t* sums, __constant const parameters_t* p, run_t run, real x, real y, real z) {
  neighbours_t* near = &sums->near;
#if THIN_WALLS
  const places_t at = {{x}, {y}, {z}};
  if (near_barriers(near, p, &at)) {
    for (int j = run.begin; j < run.end; ++j) {
      const real rx = near_way(near, 0, j, x);
      const real ry = DIMENSIONS == 3 ? near_way(near, 1, j, y) : R(0.0);
      const real rz = near_way(near, 2, j, z);
      const real r2 = rx * rx + ry * ry + rz * rz;
      if (r2 >= p->support_squared) continue;
      const sight_t sight = look_at(near, p, 0, x, y, z, j, rx, ry, rz, r2);
      near->seen = sight.seen;
      near->through = sight.through;
      if (near->seen > R(0.0)) add_particle(sums, p, j, rx, ry, rz, r2);
    }
    near->seen = R(1.0);
    near->through = R(0.0);
    return;
  }
#endif
  for (int j = run.begin; j < run.end; ++j) {
    const real rx = near_way(near, 0, j, x);
    const real ry = DIMENSIONS == 3 ? near_way(near, 1, j, y) : R(0.0);
    const real rz = near_way(near, 2, j, z);
    const real r2 = rx * rx + ry * ry + rz * rz;
#if GHOSTS
    if (sums->near.mirrored) {
      const vector_t r = turned(sums->near.image + IMAGE_MATRIX, rx, ry, rz);
#if PIERCED
      if (near->gap_count > 0) {
        if (r2 >= p->support_squared) continue;
        near->seen = mirrored_part(p, near->gaps, near->gap_count, near_field(near, FIELD_X, j),
                                   DIMENSIONS == 3 ? near_field(near, FIELD_Y, j) : R(0.0), near_field(near, FIELD_Z, j));
        if (near->seen == R(0.0)) continue;
      }
#endif
      add_particle(sums, p, j, r.x, r.y, r.z, r2);
      continue;
    }
#endif
    add_particle(sums, p, j, rx, ry, rz, r2);
  }
}

// The neighbours around `at`, which for an image is not where the particle itself lies.
INLINE void sweep_rows(sweep_t* sums, __constant const parameters_t* p, __global const int* slot_start, const places_t* at) {
  const box_t box = within_grid(p, box_of_place(at, 0));
  const rows_t rows = rows_near(p, &box, sums->near.reach);
  const span_t span = span_of(p, &box);
  const real reach2 = sums->near.reach * sums->near.reach;
  for (int rz = rows.z0; rz <= rows.z1; ++rz)
    for (int ry = rows.y0; ry <= rows.y1; ++ry) {
      const real gap_y = gap_y_to_row(p, ry, &box), gap_z = gap_to_row(p, rz, box.z0, box.z1);
      const run_t run = run_of_row(p, slot_start, &span, reach2 - gap_y * gap_y - gap_z * gap_z, row_index(p, ry, rz));
      sweep_run(sums, p, run, at->x[0], at->y[0], at->z[0]);
    }
}
#else
// Near a tile whose particles lie together, which has more of them than one alone.
#define MOST_ROWS 64

// The candidates from j on, of which `left` are left in their run; those beyond its end, of other slots, are far away.
typedef struct {
  int j, left;
  tile rx, ry, rz, r2;
} block_t;

INLINE block_t block_of(const neighbours_t* near, const int* run, int gone, tile x, tile y, tile z) {
  block_t b;
  b.j = run[0] + gone;
  b.left = run[1] - b.j;
  b.rx = near_way(near, 0, b.j, x);
#if DIMENSIONS == 3
  b.ry = near_way(near, 1, b.j, y);
#else
  b.ry = (tile)(R(0.0));
#endif
  b.rz = near_way(near, 2, b.j, z);
  b.r2 = b.rx * b.rx + b.ry * b.ry + b.rz * b.rz + beyond_end(b.left);
  return b;
}

#if HAS_BLOCK_LIST && defined(KEEPS_BLOCKS)
#define WITH_BLOCK_LIST 1
#else
#define WITH_BLOCK_LIST 0
#endif

INLINE void sweep_blocks(sweep_t* sums, __constant const parameters_t* p, const int* list, int blocks, tile x, tile y, tile z) {
  const int* run = list;
#if WITH_BLOCK_LIST
  int kept = 0;
#endif
  for (int gone = 0; gone < TILE_NEAR * blocks; gone += TILE_NEAR) {
    const block_t b = block_of(&sums->near, run, gone, x, y, z);
#if WITH_BLOCK_LIST
    sums->near.blocks[1 + min(kept, BLOCK_LIST)] = b.j * TILE_NEAR + TILE_NEAR - min(b.left, TILE_NEAR);
    kept += ANY_LANE(b.r2 < (tile)(p->support_squared)) ? 1 : 0;
#endif
#if HAS_BLOCK_LIST && defined(SKIPS_EMPTY_BLOCKS)
    if (ANY_LANE(b.r2 < (tile)(p->support_squared)))
#endif
      add_particle(sums, p, b.j, b.rx, b.ry, b.rz, b.r2);
    run += b.left <= TILE_NEAR ? 2 : 0;
  }
#if WITH_BLOCK_LIST
  sums->near.blocks[0] = kept <= BLOCK_LIST ? kept : -1;
#endif
}

#if THIN_WALLS
INLINE void add_beyond(neighbours_t* near, tile beyond) {
  real sums[TILE_OWN];
  own_sums(beyond, sums);
  for (int k = 0; k < TILE_OWN; ++k)
    if (near->transparency[k] > R(0.0)) near->beyond[k] += sums[k];
}

// What lies beyond thin walls that hide nothing from the tile, up to where more does not matter: from the middle rows on, where the kernel is largest.
INLINE void find_beyond(neighbours_t* near, __constant const parameters_t* p, near_barriers_t* barriers, const int* list, int runs, int blocks, tile x,
                        tile y, tile z) {
  const real enough = enough_beyond(p, barriers->nearest);
  if (enough < R(0.0)) return;
  keep_backs(barriers);
  if (barriers->count == 0) return;
  tile beyond = (tile)(R(0.0));
  int gone = 0;
  const int* run = list;
  for (; run < list + runs / 2 && run + 2 < list + runs; run += 2) gone += (run[1] - run[0] - gone + TILE_NEAR - 1) / TILE_NEAR * TILE_NEAR;
  for (int block = 0; block < blocks; ++block) {
    const block_t b = block_of(near, run, gone, x, y, z);
    if (add_only_beyond(near, p, barriers, &beyond, b.j, x, y, z, b.rx, b.ry, b.rz, b.r2)) {
      real sums[TILE_OWN];
      own_sums(beyond, sums);
      bool wet = true;
      for (int k = 0; k < TILE_OWN; ++k) wet = wet && (k >= near->own || sums[k] > enough);
      if (wet) break;
    }
    run += b.left <= TILE_NEAR ? 2 : 0;
    gone += TILE_NEAR;
    if (gone == TILE_NEAR * blocks) {
      gone = 0;
      run = list;
    }
  }
  add_beyond(near, beyond);
}

// The candidates of the list as thin walls let the tile see them. False, and they are left to sweep_blocks, if nothing is hidden: where no thin wall is near
// after all, and about free edges.
SELDOM bool sweep_past(sweep_t* sums, __constant const parameters_t* p, const int* list, int runs, int blocks, const places_t* at, tile x, tile y, tile z) {
  neighbours_t* near = &sums->near;
  near_barriers_t barriers;
  barriers.count = -1;
  if (!IMAGES) {
    find_barriers(&barriers, near, p, at);
    near->past = barriers.count != 0;
    if (barriers.count == 0) return false;
  }
  if (barriers.count > 0) {
    stand_before(&barriers, near, x, y, z);
    if (!barriers.hides) {
      find_beyond(near, p, &barriers, list, runs, blocks, x, y, z);
      return false;
    }
  }
  const tile transparency = spread_own(near->transparency);
  tile beyond = (tile)(R(0.0));
  const int* run = list;
  for (int gone = 0; gone < TILE_NEAR * blocks; gone += TILE_NEAR) {
    const block_t b = block_of(near, run, gone, x, y, z);
    if (barriers.count > 0)
      look_past(near, p, &barriers, transparency, &beyond, b.j, x, y, z, b.rx, b.ry, b.rz, b.r2);
    else
      look_at_all(near, p, at, b.j, b.left, b.rx, b.ry, b.rz, b.r2);
    add_particle(sums, p, b.j, b.rx, b.ry, b.rz, b.r2);
    run += b.left <= TILE_NEAR ? 2 : 0;
  }
  add_beyond(near, beyond);
  near->seen = (tile)(R(1.0));
  near->through = (tile)(R(0.0));
  return true;
}
#endif

// All rows near the box, of which there are no more than MOST_ROWS. First a list of runs, then the candidates of all of them in one loop, whose end a
// processor foresees: runs are short.
INLINE void sweep_box(sweep_t* sums, __constant const parameters_t* p, __global const int* slot_start, box_t box, const places_t* at, tile x, tile y, tile z) {
  neighbours_t* near = &sums->near;
  const rows_t rows = rows_near(p, &box, near->reach);
  const span_t span = span_of(p, &box);
  const real reach2 = near->reach * near->reach;
  int list[2 * MOST_ROWS];  // where each run begins, less what the runs before have gone through, and where it ends
  int runs = 0, blocks = 0;
  for (int rz = rows.z0; rz <= rows.z1; ++rz) {
    const real gap_z = gap_to_row(p, rz, box.z0, box.z1);
    const real left = reach2 - gap_z * gap_z;
    for (int ry = rows.y0; ry <= rows.y1; ++ry) {
      const real gap_y = gap_y_to_row(p, ry, &box);
      const run_t run = run_of_row(p, slot_start, &span, left - gap_y * gap_y, row_index(p, ry, rz));
      const int length = run.end - run.begin;
      list[runs] = run.begin - TILE_NEAR * blocks;
      list[runs + 1] = run.end;
      runs += length > 0 ? 2 : 0;
      blocks += (length + TILE_NEAR - 1) / TILE_NEAR;
    }
  }
#if THIN_WALLS
  near->past = near_barriers(near, p, at);
  if (near->past && sweep_past(sums, p, list, runs, blocks, at, x, y, z)) return;
  near->seen = (tile)(R(1.0));  // here too, so that the compiler leaves it out
  near->through = (tile)(R(0.0));
#endif
  sweep_blocks(sums, p, list, blocks, x, y, z);
}

// The neighbours around `at`, which for images is not where the particles themselves lie. Where the tile's particles do not lie together, in spray, each
// is gone round by itself, with the others far away.
INLINE void sweep_rows(sweep_t* sums, __constant const parameters_t* p, __global const int* slot_start, const places_t* at) {
  const tile x = spread_own(at->x), y = spread_own(at->y), z = spread_own(at->z);
#if TILE_OWN == 1
  sweep_box(sums, p, slot_start, within_grid(p, box_of_place(at, 0)), at, x, y, z);
#else
  const int own = sums->near.own;
  const box_t all = within_grid(p, box_of_places(at, own));
  const rows_t rows = rows_near(p, &all, sums->near.reach);
  const bool together = (rows.y1 - rows.y0 + 1) * (rows.z1 - rows.z0 + 1) <= MOST_ROWS && all.x1 - all.x0 < R(2.0) * p->support;
  const int parts = together ? 1 : own;
  for (int part = 0; part < parts; ++part) {
    box_t box = all;
    tile at_x = x;
    if (!together) {
      box = within_grid(p, box_of_place(at, part));
      at_x = OWN_LANES == (tile)((real)part) ? x : (tile)(FAR_AWAY);
    }
    sweep_box(sums, p, slot_start, box, at, at_x, y, z);
  }
#if WITH_BLOCK_LIST
  if (!together) sums->near.blocks[0] = -1;  // each particle has blocks of its own
#endif
#endif
}
#endif

#if HAS_BLOCK_LIST && defined(TAKES_BLOCKS)
// Those of the list, which add to each sum what all would: without a pair a block adds zeros. The sums are the loop's own, which the call of the other walk
// would else keep in memory.
INLINE void sweep_listed(sweep_t* all_sums, __constant const parameters_t* p, const places_t* at) {
  sweep_t sums = *all_sums;
  const tile x = spread_own(at->x), y = spread_own(at->y), z = spread_own(at->z);
  __global const int* list = sums.near.blocks;
  const int count = list[0];
  for (int k = 1; k <= count; ++k) {
    const uint block = list[k];
    const int j = block / TILE_NEAR;
    const tile rx = near_way(&sums.near, 0, j, x);
#if DIMENSIONS == 3
    const tile ry = near_way(&sums.near, 1, j, y);
#else
    const tile ry = (tile)(R(0.0));
#endif
    const tile rz = near_way(&sums.near, 2, j, z);
    add_particle(&sums, p, j, rx, ry, rz, rx * rx + ry * ry + rz * rz + beyond_end(TILE_NEAR - block % TILE_NEAR));
  }
  *all_sums = sums;
}

// Tiles in spray, and those with more neighbours than the list has room for.
SELDOM void sweep_unlisted(sweep_t* sums, __constant const parameters_t* p, __global const int* slot_start, const places_t* at) {
  sweep_rows(sums, p, slot_start, at);
}
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

INLINE void sweep_particles(sweep_t* sums, __constant const parameters_t* p, __global const int* slot_start, __global const real* images) {
  places_t at = sums->near.places;
#if THIN_WALLS
  for (int k = 0; k < TILE_OWN; ++k)
    if (k < sums->near.own) sums->near.transparency[k] = transparency_at(p, sums->near.walls, at.x[k], at.y[k], at.z[k]);
#endif
#if IMAGES
  for (int k = -1; k < p->images; ++k) {  // first the tank itself: one call, or the whole loop would be compiled twice
    if (k >= 0) {
      __global const real* image = images + k * IMAGE_COUNT;
      if (image[IMAGE_MIRRORED] > R(0.5) || !places_near_image(p, &sums->near, image)) continue;
      at = places_seen_by_image(image, &sums->near.places);
    }
    sweep_rows(sums, p, slot_start, &at);
  }
#elif HAS_BLOCK_LIST && defined(TAKES_BLOCKS)
  if (sums->near.blocks[0] >= 0)
    sweep_listed(sums, p, &at);
  else
    sweep_unlisted(sums, p, slot_start, &at);
#else
  sweep_rows(sums, p, slot_start, &at);
#endif
#if GHOSTS
  sweep_ghosts(sums, p, slot_start, images);
#endif
}
#endif

#if THIN_WALLS
// Of the kernel, what lies behind thin walls.
SELDOM real room_behind(__constant const parameters_t* p, const walls_t* walls, real x, real y, real z) {
  real room = R(0.0);
  const int centre = cell_index(p, x, y, z);
#if FACETS
  for (int k = walls->start[centre]; k < walls->start[centre + 1]; ++k) {
    const int s = walls->list[k];
    const contact_t all = whole_wall(p, walls, s, x, y, z);
    room += all.shepard - visible_part(p, walls, s, x, y, z, all).shepard;
  }
#else
  const int layer = DIMENSIONS == 3 ? p->cells_x * p->cells_y : p->cells_x;
  for (int dz = -1; dz <= 1; ++dz)
    for (int dy = DIMENSIONS == 3 ? -1 : 0; dy <= (DIMENSIONS == 3 ? 1 : 0); ++dy) {
      const int row = centre + dz * layer + dy * p->cells_x;
      for (int s = walls->start[row - 1]; s < walls->start[row + 2]; ++s) {
        const contact_t all = whole_wall(p, walls, s, x, y, z);
        if (all.weight > R(0.0)) room += all.shepard - visible_part(p, walls, s, x, y, z, all).shepard;
      }
    }
#endif
  return room;
}

// Prepares the walls for what the point sees of them: how much of those that thin ones hide from it counts. About free edges as much as of its neighbours
// beyond; but on a dry far side there is nothing for the far walls to cancel with.
INLINE void look_through(__constant const parameters_t* p, walls_t* walls, bool past, real transparency, real beyond, real x, real y, real z) {
  walls->share = R(0.0);
  walls->past = false;
  walls->screened = false;
  if (!past) return;
  find_screen(p, walls, x, y, z);
  if (transparency == R(0.0) || !MAY_HIDE(p, walls, x, y, z)) return;
  if (!IMAGES && beyond > enough_beyond(p, walls->nearest)) {
    walls->share = transparency;
    return;
  }
  walls->share = transparency * fmin((WET_BEYOND * beyond + LITTLE_ROOM) / fmax(room_behind(p, walls, x, y, z), LITTLE_ROOM), R(1.0));
}
// Of own particle k.
#define LOOK_THROUGH(walls, near, k) \
  look_through(p, &(walls), (near).past, (near).transparency[k], (near).beyond[k], (near).places.x[k], (near).places.y[k], (near).places.z[k])
#else
#define LOOK_THROUGH(walls, near, k)
#endif

#ifdef SWEEP_WALLS
INLINE void sweep_wall_cells(wall_sweep_t* sums, __constant const parameters_t* p, const walls_t* walls, real x, real y, real z) {
  const int centre = cell_index(p, x, y, z);
#if FACETS
  const int end = walls->start[centre + 1];
  for (int k = walls->start[centre]; k < end; ++k) add_wall(sums, p, walls->list[k], x, y, z);
#else
  const int layer = DIMENSIONS == 3 ? p->cells_x * p->cells_y : p->cells_x;
  for (int dz = -1; dz <= 1; ++dz) {
#if DIMENSIONS == 3
    for (int dy = -1; dy <= 1; ++dy) {
      const int row = centre + dz * layer + dy * p->cells_x;
#else
    {
      const int row = centre + dz * layer;
#endif
      const int end = walls->start[row + 2];
      for (int s = walls->start[row - 1]; s < end; ++s) {
        const real rx = WALL_FIELD(walls, WALL_X, s) - x;
        const real ry = DIMENSIONS == 3 ? WALL_FIELD(walls, WALL_Y, s) - y : R(0.0);
        const real rz = WALL_FIELD(walls, WALL_Z, s) - z;
        if (rx * rx + ry * ry + rz * rz < p->support_squared) add_wall(sums, p, s, x, y, z);
      }
    }
  }
#endif
}

INLINE void sweep_walls(wall_sweep_t* sums, __constant const parameters_t* p, const walls_t* walls, __global const real* images, real x, real y, real z) {
  sweep_wall_cells(sums, p, walls, x, y, z);
#if IMAGES
  for (int k = 0; k < p->images; ++k) {
    __global const real* image = images + k * IMAGE_COUNT;
    if (image[IMAGE_MIRRORED] > R(0.5) || !near_image(p, image, x, y, z)) continue;
    const vector_t seen = seen_by_image(image, x, y, z);
    sweep_wall_cells(sums, p, walls, seen.x, seen.y, seen.z);
  }
#endif
}
#endif

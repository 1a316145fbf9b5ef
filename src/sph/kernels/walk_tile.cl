// The walk over the candidates of a tile of particles, a block of them at a time; and by the list that one before made. For sweep.cl.
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

INLINE void sweep_blocks(sweep_t* sums, __constant const parameters_t* p, const int* list, int blocks, tile x, tile y, tile z) {
  const int* run = list;
  for (int gone = 0; gone < TILE_NEAR * blocks; gone += TILE_NEAR) {
    const block_t b = block_of(&sums->near, run, gone, x, y, z);
#if HAS_BLOCK_LIST && defined(SKIPS_EMPTY_BLOCKS)
    if (ANY_LANE(b.r2 < (tile)(p->support_squared)))
#endif
      add_particle(sums, p, b.j, b.rx, b.ry, b.rz, b.r2);
    run += b.left <= TILE_NEAR ? 2 : 0;
  }
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

// The runs near a box: where each begins, less what the runs before have gone through, and where it ends; and how many blocks of candidates they have.
typedef struct {
  int list[2 * MOST_ROWS];
  int runs, blocks;
} runs_t;

// Of all rows near the box, of which there are no more than MOST_ROWS. The candidates of all of them are then gone through in one loop, whose end a processor
// foresees: runs are short.
INLINE void runs_near(runs_t* found, __constant const parameters_t* p, __global const int* slot_start, box_t box, real reach) {
  const rows_t rows = rows_near(p, &box, reach);
  const span_t span = span_of(p, &box);
  const real reach2 = reach * reach;
  int runs = 0, blocks = 0;
  for (int rz = rows.z0; rz <= rows.z1; ++rz) {
    const real gap_z = gap_to_row(p, rz, box.z0, box.z1);
    const real left = reach2 - gap_z * gap_z;
    for (int ry = rows.y0; ry <= rows.y1; ++ry) {
      const real gap_y = gap_y_to_row(p, ry, &box);
      const run_t run = run_of_row(p, slot_start, &span, left - gap_y * gap_y, row_index(p, ry, rz));
      const int length = run.end - run.begin;
      found->list[runs] = run.begin - TILE_NEAR * blocks;
      found->list[runs + 1] = run.end;
      runs += length > 0 ? 2 : 0;
      blocks += (length + TILE_NEAR - 1) / TILE_NEAR;
    }
  }
  found->runs = runs;
  found->blocks = blocks;
}

INLINE void sweep_box(sweep_t* sums, __constant const parameters_t* p, __global const int* slot_start, box_t box, const places_t* at, tile x, tile y, tile z) {
  neighbours_t* near = &sums->near;
  runs_t found;
  runs_near(&found, p, slot_start, box, near->reach);
#if THIN_WALLS
  near->past = near_barriers(near, p, at);
  if (near->past && sweep_past(sums, p, found.list, found.runs, found.blocks, at, x, y, z)) return;
  near->seen = (tile)(R(1.0));  // here too, so that the compiler leaves it out
  near->through = (tile)(R(0.0));
#endif
  sweep_blocks(sums, p, found.list, found.blocks, x, y, z);
}

// The box about a tile's particles; whether they lie together.
INLINE bool lie_together(__constant const parameters_t* p, const places_t* at, int own, real reach, box_t* all) {
  *all = within_grid(p, box_of_places(at, own));
  const rows_t rows = rows_near(p, all, reach);
  return TILE_OWN == 1 || ((rows.y1 - rows.y0 + 1) * (rows.z1 - rows.z0 + 1) <= MOST_ROWS && all->x1 - all->x0 < R(2.0) * p->support);
}

// The neighbours around `at`, which for images is not where the particles themselves lie. Where the tile's particles do not lie together, in spray, each
// is gone round by itself, with the others far away.
INLINE void sweep_rows(sweep_t* sums, __constant const parameters_t* p, __global const int* slot_start, const places_t* at) {
  const tile x = spread_own(at->x), y = spread_own(at->y), z = spread_own(at->z);
#if TILE_OWN == 1
  sweep_box(sums, p, slot_start, within_grid(p, box_of_place(at, 0)), at, x, y, z);
#else
  const int own = sums->near.own;
  box_t all;
  const bool together = lie_together(p, at, own, sums->near.reach, &all);
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
#endif
}

#if HAS_BLOCK_LIST && defined(KEEPS_BLOCKS)
// Of what lies about a tile the blocks that have a pair: what is added up then goes through them alone. None are listed of particles that do not lie together,
// of which each has blocks of its own, nor where there are more than there is room for.
INLINE void list_blocks(neighbours_t* near, __constant const parameters_t* p, __global const int* slot_start, const places_t* at) {
  box_t all;
  if (!lie_together(p, at, near->own, near->reach, &all)) return;
  const tile x = spread_own(at->x), y = spread_own(at->y), z = spread_own(at->z);
  runs_t found;
  runs_near(&found, p, slot_start, all, near->reach);
  const int* run = found.list;
  int kept = 0;
  for (int gone = 0; gone < TILE_NEAR * found.blocks; gone += TILE_NEAR) {
    const block_t b = block_of(near, run, gone, x, y, z);
    near->blocks[1 + min(kept, BLOCK_LIST)] = b.j * TILE_NEAR + TILE_NEAR - min(b.left, TILE_NEAR);
    kept += ANY_LANE(b.r2 < (tile)(p->support_squared)) ? 1 : 0;
    run += b.left <= TILE_NEAR ? 2 : 0;
  }
  near->blocks[0] = kept <= BLOCK_LIST ? kept : -1;
}
#endif

#if HAS_BLOCK_LIST && GOES_BY_BLOCKS
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
#endif

// What a tile sees of its neighbours past thin walls: for sweep.cl.
typedef struct {
  real seen, through;
} sight_t;

// What own particle k sees of candidate j at (rx, ry, rz), within the support, past thin walls: from itself and, if that lies elsewhere, from (x, y, z), where
// an image has its neighbours.
INLINE sight_t look_at(neighbours_t* near, __constant const parameters_t* p, int k, real x, real y, real z, int j, real rx, real ry, real rz, real r2) {
  const real own_x = near->places.x[k], own_y = near->places.y[k], own_z = near->places.z[k];
  int by = hidden_in_cell(p, near->walls, x, y, z, rx, ry, rz);
  if (IMAGES && by == NO_OWNER) by = hidden_in_cell(p, near->walls, own_x, own_y, own_z, rx, ry, rz);
  const real transparency = near->transparency[k];
  if (transparency > R(0.0) && beyond_thin(p, near->walls, own_x, own_y, own_z, rx, ry, rz))
    near->beyond[k] += kernel_value(p, sqrt(r2)) * near->state[FIELD_VOLUME * near->stride + j];
  const sight_t sight = {by == NO_OWNER ? R(1.0) : transparency, by != NO_OWNER && by == near->watched ? R(1.0) : R(0.0)};
  return sight;
}

// Whether thin walls may stand between any own particle and its neighbours around `at`.
INLINE bool near_barriers(const neighbours_t* near, __constant const parameters_t* p, const places_t* at) {
  bool any = false;
  for (int k = 0; k < TILE_OWN; ++k) {
    if (k >= near->own) continue;
    any = any || has_barriers(p, near->walls, at->x[k], at->y[k], at->z[k]);
    if (IMAGES) any = any || has_barriers(p, near->walls, near->places.x[k], near->places.y[k], near->places.z[k]);
  }
  return any;
}

#if TILE_LANES > 1
// More thin walls near a tile are looked at one candidate at a time.
#define MOST_BARRIERS 12

// The barriers near a tile, and how far before each plane its own particles are.
typedef struct {
  int count;
  int list[MOST_BARRIERS];
  int edges[MOST_BARRIERS];     // a bit each: ways may pass outside of that edge
  int opposite[MOST_BARRIERS];  // a bit each: faces the other way, so that what goes in by the one and out by the other is hidden
  bool hides, transparent;      // whether it matters what they hide, and what lies beyond
  real nearest;                 // no own particle is nearer to any of them
  tile before[MOST_BARRIERS];
} near_barriers_t;

// Whether the ways from own particles, which are no longer than the support, may cross the barrier, and outside of which of its edges they may pass.
INLINE bool may_cross(const neighbours_t* near, __constant const parameters_t* p, const places_t* at, __global const real* b, int* edges, real* nearest) {
  bool any = false;
  *edges = 0;
  for (int k = 0; k < TILE_OWN; ++k) {
    if (k >= near->own) continue;
    const real x = at->x[k], y = at->y[k], z = at->z[k];
    real off = fabs(b[0] * x + b[1] * y + b[2] * z + b[3]);
    for (int e = 1; e <= BARRIER_EDGES; ++e) {
      const real inside = b[4 * e] * x + b[4 * e + 1] * y + b[4 * e + 2] * z + b[4 * e + 3];
      off = fmax(off, -inside);
      *edges |= inside < SIGHT * p->support ? 1 << e : 0;
    }
    any = any || off < SIGHT * p->support;
    *nearest = fmin(*nearest, off);
  }
  return any;
}

// Finds those that ways from own particles may cross, in the order in which their cells list them; count is −1 if there are more than MOST_BARRIERS.
INLINE void find_barriers(near_barriers_t* found, const neighbours_t* near, __constant const parameters_t* p, const places_t* at) {
  found->count = 0;
  found->nearest = p->support;
  int last_cell = -1;
  for (int k = 0; k < TILE_OWN; ++k) {
    if (k >= near->own) continue;
    const int cell = cell_index(p, at->x[k], at->y[k], at->z[k]);
    if (cell == last_cell) continue;
    last_cell = cell;
    for (int m = near->walls->barrier_start[cell]; m < near->walls->barrier_start[cell + 1]; ++m) {
      const int barrier = near->walls->barrier_list[m];
      bool known = false;
      for (int n = 0; n < found->count; ++n) known = known || found->list[n] == barrier;
      int edges;
      if (known || !may_cross(near, p, at, near->walls->barriers + BARRIER_COUNT * barrier, &edges, &found->nearest)) continue;
      if (found->count == MOST_BARRIERS) {
        found->count = -1;
        return;
      }
      found->edges[found->count] = edges;
      found->list[found->count++] = barrier;
    }
  }
}

// What else of them look_past needs, for a tile whose own particles are at (x, y, z).
INLINE void stand_before(near_barriers_t* found, const neighbours_t* near, tile x, tile y, tile z) {
  found->hides = near->watched != NO_OWNER;
  found->transparent = false;
  for (int k = 0; k < TILE_OWN; ++k) {
    if (k >= near->own) continue;
    found->hides = found->hides || near->transparency[k] < R(1.0);
    found->transparent = found->transparent || near->transparency[k] > R(0.0);
  }
  for (int k = 0; k < found->count; ++k) {
    __global const real* b = near->walls->barriers + BARRIER_COUNT * found->list[k];
    found->before[k] = b[0] * x + b[1] * y + b[2] * z + b[3];
    found->opposite[k] = 0;
    for (int l = 0; l < found->count; ++l) {
      __global const real* other = near->walls->barriers + BARRIER_COUNT * found->list[l];
      if (b[0] * other[0] + b[1] * other[1] + b[2] * other[2] < R(-0.5)) found->opposite[k] |= 1 << l;
    }
  }
}

// Whether any lane is below zero, by the bits of the signs.
INLINE bool any_negative(tile v) {
#if USE_DOUBLE
#if TILE_LANES == 8
  const long8 all = as_long8(v);
  const long4 half_of_them = all.lo | all.hi;
#else
  const long4 half_of_them = as_long4(v);
#endif
  const long2 two = half_of_them.lo | half_of_them.hi;
#else
#if TILE_LANES == 16
  const int16 all = as_int16(v);
  const int8 eight = all.lo | all.hi;
  const int4 four = eight.lo | eight.hi;
#elif TILE_LANES == 8
  const int8 all = as_int8(v);
  const int4 four = all.lo | all.hi;
#else
  const int4 four = as_int4(v);
#endif
  const int2 two = four.lo | four.hi;
#endif
  return (two.x | two.y) < 0;
}

// Leaves those out that no own particle is behind: nothing comes out of them.
INLINE void keep_backs(near_barriers_t* found) {
  int kept = 0;
  for (int k = 0; k < found->count; ++k) {
    if (!any_negative(-found->before[k])) continue;
    found->list[kept] = found->list[k];
    found->edges[kept] = found->edges[k];
    found->before[kept++] = found->before[k];
  }
  found->count = kept;
}

// 1 for what is positive, else 0; for what is next to zero between them. (step() and comparisons of vectors are calls.)
INLINE tile positive(tile v) { return fmin(fmax(v * R(1.0e20), (tile)(R(0.0))), (tile)(R(1.0))); }

// 1 where the ways from (x, y, z) cross the barrier, if they cross its plane, from `before` to `after`.
INLINE tile crossings(__global const real* b, int edges, tile x, tile y, tile z, tile rx, tile ry, tile rz, tile before, tile after) {
  tile mask = positive(-before * after);
  if (edges == 0) return mask;
  const tile part = fabs(before) / fmax(fabs(before) + fabs(after), (tile)(R(1.0e-30)));  // of ways that do not cross any, but finite
  const tile cx = x + part * rx, cy = y + part * ry, cz = z + part * rz;
  for (int e = 1; e <= BARRIER_EDGES; ++e)
    if (edges & (1 << e)) mask *= positive(b[4 * e] * cx + b[4 * e + 1] * cy + b[4 * e + 2] * cz + b[4 * e + 3]);
  return mask;
}

// Below zero where a way within the support crosses the plane from `before` on.
INLINE tile past_plane(__global const real* b, tile before, tile rx, tile ry, tile rz) { return before * (before + b[0] * rx + b[1] * ry + b[2] * rz); }

// Whether a way within the support may cross any of them; most blocks are on this side of every plane as far as they are within the support. `outside`:
// below zero within the support.
INLINE bool any_past(const neighbours_t* near, const near_barriers_t* barriers, tile rx, tile ry, tile rz, tile outside) {
  tile least = (tile)(R(1.0));
  for (int k = 0; k < barriers->count; ++k)
    least = fmin(least, past_plane(near->walls->barriers + BARRIER_COUNT * barriers->list[k], barriers->before[k], rx, ry, rz));
  return any_negative(fmax(least, outside));
}

// W V of the candidates, as far as `left` has it.
INLINE tile weight_beyond(const neighbours_t* near, __constant const parameters_t* p, tile left, int j, tile r2) {
  return left * kernel_values(p, sqrt(r2)) * near_field(near, FIELD_VOLUME, j);
}

// As look_at, of all candidates at once: past the given barriers. `transparency`: of each lane; Σ W V of all that are beyond goes into `beyond`.
INLINE void look_past(neighbours_t* near, __constant const parameters_t* p, const near_barriers_t* barriers, tile transparency, tile* beyond, int j, tile x,
                      tile y, tile z, tile rx, tile ry, tile rz, tile r2) {
  const tile nothing = (tile)(R(0.0)), one = (tile)(R(1.0));
  near->seen = one;
  near->through = nothing;
  const tile outside = r2 - p->support_squared;
  if (!any_past(near, barriers, rx, ry, rz, outside)) return;
  int crossed[MOST_BARRIERS];
  tile in[MOST_BARRIERS], out[MOST_BARRIERS];
  int count = 0;
  tile left = nothing;  // a thin wall's back
  for (int k = 0; k < barriers->count; ++k) {
    __global const real* b = near->walls->barriers + BARRIER_COUNT * barriers->list[k];
    const tile before = barriers->before[k];
    const tile after = before + b[0] * rx + b[1] * ry + b[2] * rz;
    if (!any_negative(fmax(before * after, outside))) continue;
    const tile mask = crossings(b, barriers->edges[k], x, y, z, rx, ry, rz, before, after);
    in[count] = mask * positive(-before);
    out[count] = mask - in[count];
    left = fmax(left, out[count]);
    crossed[count++] = k;
  }
  if (barriers->transparent) *beyond += weight_beyond(near, p, left, j, r2);
  tile by = nothing;  // by whom hidden: the owner, and one
  for (int k = 0; k < count; ++k) {
    __global const real* front = near->walls->barriers + BARRIER_COUNT * barriers->list[crossed[k]];
    for (int l = 0; l < count; ++l) {
      if ((barriers->opposite[crossed[k]] & (1 << crossed[l])) == 0) continue;
      __global const real* back = near->walls->barriers + BARRIER_COUNT * barriers->list[crossed[l]];
      by = fmax(by, in[k] * out[l] * (fmax(front[BARRIER_OWNER], back[BARRIER_OWNER]) + R(1.0)));
    }
  }
  const tile hidden = fmin(by, one);
  near->seen = one + hidden * (transparency - one);
  near->through = hidden * (one - fmin(fabs(by - (real)(near->watched + 1)), one));
}

// Adds Σ W V of the candidates that are beyond the barriers, of which nothing hides them; whether there may be any.
INLINE bool add_only_beyond(const neighbours_t* near, __constant const parameters_t* p, const near_barriers_t* barriers, tile* beyond, int j, tile x, tile y,
                            tile z, tile rx, tile ry, tile rz, tile r2) {
  const tile outside = r2 - p->support_squared;
  if (!any_past(near, barriers, rx, ry, rz, outside)) return false;
  tile left = (tile)(R(0.0));
  for (int k = 0; k < barriers->count; ++k) {
    __global const real* b = near->walls->barriers + BARRIER_COUNT * barriers->list[k];
    const tile before = barriers->before[k];
    const tile after = before + b[0] * rx + b[1] * ry + b[2] * rz;
    left = fmax(left, crossings(b, barriers->edges[k], x, y, z, rx, ry, rz, before, after) * positive(before));
  }
  *beyond += weight_beyond(near, p, left, j, r2);
  return true;
}

// As look_at, of all candidates from j on, of which `left` are left.
INLINE void look_at_all(neighbours_t* near, __constant const parameters_t* p, const places_t* at, int j, int left, tile rx, tile ry, tile rz, tile r2) {
  real x[TILE_LANES], y[TILE_LANES], z[TILE_LANES], square[TILE_LANES], seen[TILE_LANES], through[TILE_LANES];
  lanes_of(rx, x);
  lanes_of(ry, y);
  lanes_of(rz, z);
  lanes_of(r2, square);
  for (int lane = 0; lane < TILE_LANES; ++lane) {
    const int k = lane / TILE_NEAR, candidate = lane % TILE_NEAR;
    seen[lane] = R(1.0);
    through[lane] = R(0.0);
    if (k >= near->own || candidate >= left || square[lane] >= p->support_squared) continue;
    const sight_t sight = look_at(near, p, k, at->x[k], at->y[k], at->z[k], j + candidate, x[lane], y[lane], z[lane], square[lane]);
    seen[lane] = sight.seen;
    through[lane] = sight.through;
  }
  near->seen = tile_of(seen);
  near->through = tile_of(through);
}
#endif

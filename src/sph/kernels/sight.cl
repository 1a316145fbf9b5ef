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

// Those within the support of any own particle, in the order in which their cells list them: how many; −1 if there are more than MOST_BARRIERS.
INLINE int find_barriers(const neighbours_t* near, __constant const parameters_t* p, const places_t* at, int* list) {
  int count = 0;
  for (int k = 0; k < TILE_OWN; ++k) {
    if (k >= near->own) continue;
    const real x = at->x[k], y = at->y[k], z = at->z[k];
    const int cell = cell_index(p, x, y, z);
    for (int m = near->walls->barrier_start[cell]; m < near->walls->barrier_start[cell + 1]; ++m) {
      const int found = near->walls->barrier_list[m];
      __global const real* b = near->walls->barriers + BARRIER_COUNT * found;
      bool relevant = fabs(b[0] * x + b[1] * y + b[2] * z + b[3]) < p->support;
      for (int e = 1; e < 4; ++e) relevant = relevant && b[4 * e] * x + b[4 * e + 1] * y + b[4 * e + 2] * z + b[4 * e + 3] > -p->support;
      for (int n = 0; n < count; ++n) relevant = relevant && list[n] != found;
      if (!relevant) continue;
      if (count == MOST_BARRIERS) return -1;
      list[count++] = found;
    }
  }
  return count;
}

// The barriers near a tile, and how far before each plane its own particles are.
typedef struct {
  int count;
  int list[MOST_BARRIERS];
  tile before[MOST_BARRIERS];
} near_barriers_t;

// 1 for what is positive, else 0; for what is next to zero between them. (step() and comparisons of vectors are calls.)
INLINE tile positive(tile v) { return fmin(fmax(v * R(1.0e20), (tile)(R(0.0))), (tile)(R(1.0))); }

INLINE bool any_positive(tile v) {
  real sums[TILE_OWN];
  own_sums(fmax(v, (tile)(R(0.0))), sums);
  real sum = R(0.0);
  for (int k = 0; k < TILE_OWN; ++k) sum += sums[k];
  return sum > R(0.0);
}

// 1 where the ways from (x, y, z) cross the barrier, if they cross its plane, from `before` to `after`.
INLINE tile crossings(__global const real* b, tile x, tile y, tile z, tile rx, tile ry, tile rz, tile before, tile after) {
  const tile part = fabs(before) / fmax(fabs(before) + fabs(after), (tile)(R(1.0e-30)));  // of ways that do not cross any, but finite
  const tile cx = x + part * rx, cy = y + part * ry, cz = z + part * rz;
  tile mask = positive(-before * after);
  for (int e = 1; e < 4; ++e) mask *= positive(b[4 * e] * cx + b[4 * e + 1] * cy + b[4 * e + 2] * cz + b[4 * e + 3]);
  return mask;
}

// As look_at, of all candidates at once: past the given barriers. `transparency`: of each lane; Σ W V of all that are beyond goes into `beyond`.
INLINE void look_past(neighbours_t* near, __constant const parameters_t* p, const near_barriers_t* barriers, tile transparency, tile* beyond, int j, tile x,
                      tile y, tile z, tile rx, tile ry, tile rz, tile r2) {
  const tile nothing = (tile)(R(0.0)), one = (tile)(R(1.0));
  near->seen = one;
  near->through = nothing;
  int crossed[MOST_BARRIERS];
  tile in[MOST_BARRIERS], out[MOST_BARRIERS];
  int count = 0;
  for (int k = 0; k < barriers->count; ++k) {
    __global const real* b = near->walls->barriers + BARRIER_COUNT * barriers->list[k];
    const tile before = barriers->before[k];
    const tile after = before + b[0] * rx + b[1] * ry + b[2] * rz;
    if (!any_positive(-before * after)) continue;
    const tile mask = crossings(b, x, y, z, rx, ry, rz, before, after);
    in[count] = mask * positive(-before);
    out[count] = mask - in[count];
    crossed[count++] = barriers->list[k];
  }
  if (count == 0) return;
  tile left = nothing, by = nothing;  // a thin wall's back; by whom hidden: the owner, and one
  for (int k = 0; k < count; ++k) {
    left = fmax(left, out[k]);
    __global const real* front = near->walls->barriers + BARRIER_COUNT * crossed[k];
    for (int l = 0; l < count; ++l) {
      __global const real* back = near->walls->barriers + BARRIER_COUNT * crossed[l];
      if (front[0] * back[0] + front[1] * back[1] + front[2] * back[2] >= R(-0.5)) continue;
      by = fmax(by, in[k] * out[l] * (fmax(front[BARRIER_OWNER], back[BARRIER_OWNER]) + R(1.0)));
    }
  }
  const tile hidden = fmin(by, one);
  near->seen = one + hidden * (transparency - one);
  near->through = hidden * (one - fmin(fabs(by - (real)(near->watched + 1)), one));
  *beyond += left * kernel_values(p, sqrt(r2)) * near_field(near, FIELD_VOLUME, j);
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

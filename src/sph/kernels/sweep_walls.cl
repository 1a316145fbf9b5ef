// The walls of a sweep, particle by particle, and what lies behind thin ones. For sweep.cl.
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

// The one neighbour loop. A sweep is a file that defines, before it includes this one,
//   sweep_t                                               its inputs, its own values and its sums; `near` are the neighbours,
//   SWEEP_PARTICLES, SWEEP_WALLS                          which of the two loops it calls,
//   add_particle(sweep_t*, p, j, rx, ry, rz, r2)          one neighbour j at (rx, ry, rz) = x_j − x, for every candidate of the cells (W and F vanish
//                                                         beyond the support, so no branch is needed, and the compiler vectorises the loop),
//   add_wall(sweep_t*, p, s, x, y, z)                     one wall element or facet that may be within the support of (x, y, z),
//   SWEEP_BRIMS, add_brim(sweep_t*, p, s, x, y, z)        in cases with thin plates, if the free edges of these matter to it,
// and whose kernel starts the sums, calls the loop, and finishes them. Particles and elements are sorted by cell, x fastest: three cells in a row are
// one contiguous run. Cells have the support's size. Facets are larger than cells: each cell has a list of those within the support of it.
#ifdef SWEEP_PARTICLES
// The neighbours around (x, y, z), which for an image is not where the particle itself lies.
INLINE void sweep_cells(sweep_t* sums, __constant const parameters_t* p, __global const int* cell_start, real x, real y, real z) {
  const int stride = sums->near.stride;
  __global const real* state = sums->near.state;
  __global const real* xs = state + FIELD_X * stride;
#if DIMENSIONS == 3
  __global const real* ys = state + FIELD_Y * stride;
#endif
  __global const real* zs = state + FIELD_Z * stride;
#if THIN_WALLS
  const bool screened = has_barriers(p, sums->near.walls, x, y, z) || has_barriers(p, sums->near.walls, sums->near.x, sums->near.y, sums->near.z);
#endif
  const int centre = cell_index(p, x, y, z);
  const int layer = DIMENSIONS == 3 ? p->cells_x * p->cells_y : p->cells_x;
  for (int dz = -1; dz <= 1; ++dz) {
#if DIMENSIONS == 3
    for (int dy = -1; dy <= 1; ++dy) {
      const int row = centre + dz * layer + dy * p->cells_x;
#else
    {
      const int row = centre + dz * layer;
#endif
      const int end = cell_start[row + 2];
#if THIN_WALLS
      if (screened) {
        for (int j = cell_start[row - 1]; j < end; ++j) {
          const real rx = xs[j] - x;
          const real ry = DIMENSIONS == 3 ? state[FIELD_Y * stride + j] - y : R(0.0);
          const real rz = zs[j] - z;
          const real r2 = rx * rx + ry * ry + rz * rz;
          // seen from the particle itself and, if that lies elsewhere, from where an image has its neighbours
          if (r2 >= p->support_squared || hidden_in_cell(p, sums->near.walls, x, y, z, rx, ry, rz) ||
              hidden_in_cell(p, sums->near.walls, sums->near.x, sums->near.y, sums->near.z, rx, ry, rz))
            continue;
          add_particle(sums, p, j, rx, ry, rz, r2);
        }
        continue;
      }
#endif
      for (int j = cell_start[row - 1]; j < end; ++j) {
        const real rx = xs[j] - x;
#if DIMENSIONS == 3
        const real ry = ys[j] - y;
#else
        const real ry = R(0.0);
#endif
        const real rz = zs[j] - z;
        const real r2 = rx * rx + ry * ry + rz * rz;
#if GHOSTS
        if (sums->near.mirrored) {
          const vector_t r = turned(sums->near.image + IMAGE_MATRIX, rx, ry, rz);
          add_particle(sums, p, j, r.x, r.y, r.z, r2);
          continue;
        }
#endif
        add_particle(sums, p, j, rx, ry, rz, r2);
      }
    }
  }
}

#if GHOSTS
// The ghosts alone.
INLINE void sweep_ghosts(sweep_t* sums, __constant const parameters_t* p, __global const int* cell_start, __global const real* images) {
  const real x = sums->near.x, y = sums->near.y, z = sums->near.z;
  for (int k = 0; k < p->images; ++k) {
    __global const real* image = images + k * IMAGE_COUNT;
    if (image[IMAGE_MIRRORED] < R(0.5) || !near_image(p, image, x, y, z)) continue;
    const vector_t seen = seen_by_image(image, x, y, z);
    sums->near.mirrored = true;
    sums->near.image = image;
    sweep_cells(sums, p, cell_start, seen.x, seen.y, seen.z);
    sums->near.mirrored = false;
  }
}
#endif

INLINE void sweep_particles(sweep_t* sums, __constant const parameters_t* p, __global const int* cell_start, __global const real* images) {
  const real x = sums->near.x, y = sums->near.y, z = sums->near.z;
  sweep_cells(sums, p, cell_start, x, y, z);
#if IMAGES
  for (int k = 0; k < p->images; ++k) {
    __global const real* image = images + k * IMAGE_COUNT;
    if (image[IMAGE_MIRRORED] > R(0.5) || !near_image(p, image, x, y, z)) continue;
    const vector_t seen = seen_by_image(image, x, y, z);
    sweep_cells(sums, p, cell_start, seen.x, seen.y, seen.z);
  }
#endif
#if GHOSTS
  sweep_ghosts(sums, p, cell_start, images);
#endif
}
#endif

#ifdef SWEEP_WALLS
INLINE void sweep_wall_cells(sweep_t* sums, __constant const parameters_t* p, const walls_t* walls, real x, real y, real z) {
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
#if THIN_WALLS && defined(SWEEP_BRIMS)
  for (int k = walls->brim_start[centre]; k < walls->brim_start[centre + 1]; ++k) add_brim(sums, p, walls->brim_list[k], x, y, z);
#endif
}

INLINE void sweep_walls(sweep_t* sums, __constant const parameters_t* p, const walls_t* walls, __global const real* images, real x, real y, real z) {
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

// The walk over the candidates of one particle, one after the other. For sweep.cl.
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

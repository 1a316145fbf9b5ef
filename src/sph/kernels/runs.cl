// Which particles may be within reach of a box: of each row near it one run of slots. For sweep.cl.
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
  __global const int* starts = slot_start + row * SLOTS_OF_ROW(p);
  run.begin = starts[SLOT_HERE(p, first)];
  run.end = left > R(0.0) ? starts[SLOT_HERE(p, last) + 1] : run.begin;
#ifdef PARTED
  run.end = max(run.end, run.begin);  // far from the part, in a ring, a run may begin beyond one end of the window and end beyond the other
#endif
  return run;
}

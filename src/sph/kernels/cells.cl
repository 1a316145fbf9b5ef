// Two grids: cells of the support's size, by which the walls are found, and for the particles rows along x, finer than that, each cut into slots.
#include "common.cl"

// The cell of a coordinate, counted in cells: clamped to the inner cells, so that the border stays empty and a lost particle cannot be read out of bounds.
INLINE int cell_coordinate(real coordinate, real inverse_cell, int cells) {
  const int c = (int)(fmin(fmax(coordinate * inverse_cell, R(0.0)), R(1.0e6))) + 1;
  return min(max(c, 1), cells - 2);
}

INLINE int cell_index(__constant const parameters_t* p, real x, real y, real z) {
  const int cx = cell_coordinate(x, p->inverse_cell, p->cells_x);
  const int cz = cell_coordinate(z, p->inverse_cell, p->cells_z);
#if DIMENSIONS == 3
  const int cy = cell_coordinate(y, p->inverse_cell, p->cells_y);
  return (cz * p->cells_y + cy) * p->cells_x + cx;
#else
  return cz * p->cells_x + cx;
#endif
}

// A particle's slot of its row.
INLINE int slot_coordinate(__constant const parameters_t* p, real x) { return cell_coordinate(x, p->inverse_slot, p->slots_x); }

// Rows and slots lie in memory with x fastest, then y.
INLINE int row_index(__constant const parameters_t* p, int ry, int rz) {
#if DIMENSIONS == 3
  return rz * p->rows_y + ry;
#else
  return rz;
#endif
}

INLINE int slot_index(__constant const parameters_t* p, real x, real y, real z) {
  const int rz = cell_coordinate(z, p->inverse_row, p->rows_z);
#if DIMENSIONS == 3
  const int ry = cell_coordinate(y, p->inverse_row, p->rows_y);
#else
  const int ry = 0;
#endif
  return row_index(p, ry, rz) * p->slots_x + slot_coordinate(p, x);
}

#ifdef PARTED
// A solver of a part of the water has its own particles and a halo of others' in one sorted array. The parts are cut across one axis, between slots (along
// x) or rows; a particle's place along that axis, counted so, tells whose it is.
INLINE int place_in_parts(__constant const parameters_t* p, real x, real y, real z) {
  if (p->part_axis == 0) return slot_coordinate(p, x);
  return p->part_axis == 1 ? cell_coordinate(y, p->inverse_row, p->rows_y) : cell_coordinate(z, p->inverse_row, p->rows_z);
}

// Where the tank is periodic across the parts, the places go on beyond its ends: a place may be one of them by its period.
INLINE bool is_between(__constant const parameters_t* p, int place, int begin, int end) {
  const int period = p->part_period;
  return (place >= begin && place < end) ||
         (period > 0 && ((place - period >= begin && place - period < end) || (place + period >= begin && place + period < end)));
}

// A particle that is nowhere, or farther than in the next part, stays with the part that has it: the watchdog has to see it.
INLINE bool is_astray(__constant const parameters_t* p, real x, real y, real z, int place) {
  return not_finite(x) || not_finite(y) || not_finite(z) || !is_between(p, place, p->near_begin, p->near_end);
}

// The list of tiles lies behind the starts of the slots: how many, then of each its first particle and that after its last.
#define TILE_LIST(p) ((p)->slots_x * (p)->rows_z * (DIMENSIONS == 3 ? (p)->rows_y : 1) + 2)
#endif

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

#ifdef PARTED
// A part has the slots, or rows, of its own particles and of its halo alone in memory: a window on the places along the axis of the parts, with an empty
// place at either end, for which all count that lie beyond it. Places go on beyond the ends of a ring.
INLINE int place_in_window(__constant const parameters_t* p, int place) {
  int there = place - p->window_begin;
  const int period = p->part_period;
  if (period > 0) {
    const int least = (p->window_size - period) / 2;  // what is beyond the window counts for the end that it is nearer to
    there += there < least ? period : (there >= least + period ? -period : 0);
  }
  return min(max(there, 0), p->window_size - 1);
}
#define PLACE_HERE(p, axis, place) ((p)->part_axis == (axis) ? place_in_window(p, place) : (place))
#define PLACES_HERE(p, axis, places) ((p)->part_axis == (axis) ? (p)->window_size : (places))
#else
#define PLACE_HERE(p, axis, place) (place)
#define PLACES_HERE(p, axis, places) (places)
#endif

// Rows and slots lie in memory with x fastest, then y.
#define SLOTS_OF_ROW(p) PLACES_HERE(p, 0, (p)->slots_x)
#define SLOT_HERE(p, slot) PLACE_HERE(p, 0, slot)

INLINE int row_index(__constant const parameters_t* p, int ry, int rz) {
#if DIMENSIONS == 3
  return PLACE_HERE(p, 2, rz) * PLACES_HERE(p, 1, p->rows_y) + PLACE_HERE(p, 1, ry);
#else
  return PLACE_HERE(p, 2, rz);
#endif
}

INLINE int slot_index(__constant const parameters_t* p, real x, real y, real z) {
  int slot = slot_coordinate(p, x), rz = cell_coordinate(z, p->inverse_row, p->rows_z);
#if DIMENSIONS == 3
  int ry = cell_coordinate(y, p->inverse_row, p->rows_y);
#else
  int ry = 0;
#endif
#ifdef PARTED
  // one that is astray, which the watchdog finds, is in the window too, whose outermost places stay empty
  const int first = p->window_begin + 1, last = p->window_begin + p->window_size - 2;
  const int here = place_in_window(p, p->part_axis == 0 ? slot : (p->part_axis == 1 ? ry : rz)) + p->window_begin;
  const int inside = min(max(here, first), last);
  slot = p->part_axis == 0 ? inside : slot;
  ry = p->part_axis == 1 ? inside : ry;
  rz = p->part_axis == 2 ? inside : rz;
#endif
  return row_index(p, ry, rz) * SLOTS_OF_ROW(p) + SLOT_HERE(p, slot);
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
#define TILE_LIST(p) ((p)->window_slots + 2)
#endif

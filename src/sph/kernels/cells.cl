#include "common.cl"

// The cell of a coordinate: clamped to the inner cells, so that the border stays empty and a lost particle cannot be read out of bounds.
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

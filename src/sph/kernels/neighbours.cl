// The neighbours as a sweep sees them: itself in the same tank, or, near an end of a periodic tank or the planes of a tank with ghosts, their images.
// An image is x' = Q x + c. A periodic one is a shift; a ghost's is a reflection in one to three planes at right angles to each other.
#include "tile.cl"
#include "cells.cl"

#define IMAGE_MATRIX 0            // Q, row by row
#define IMAGE_OFFSET 9            // c
#define IMAGE_VELOCITY 12         // u' = B u + b: B, row by row
#define IMAGE_VELOCITY_OFFSET 21  // b
#define IMAGE_NEAR 24             // seen only by particles with n·x + o < R for each of three planes: n, o
#define IMAGE_MIRRORED 36         // 1: a reflection

// A plane that mirrors may have openings. After the images the array has, for each of them, where the gaps in its planes begin and how many they are; a gap is
#define PIERCED (GHOSTS && OPENINGS)
#define GAP_PLANE 0    // n, o of the plane that it is in: n·x + o is the distance from it
#define GAP_CENTRE 4   // of a disc
#define GAP_RADIUS 7   // m, of a disc; 0: edges bound the gap
#define GAP_CORNERS 8  // how many edges follow from GAP_EDGES on: m, o of each, along the plane: m·x + o is positive outside

// Neighbours may count in part.
#define PARTLY_SEEN (THIN_WALLS || PIERCED)

typedef struct {
  __global const int* start;    // of each cell: elements sorted by cell, or the cell's part of the list of facets
  __global const int* list;
  __global const real* fields;
  int wall_stride;  // with long, 3-D steps take 3 % more; walls are never as many as particles
  __global const real* motions;
  // thin walls, that the water does not see through: each cell's part of a list of flat triangles and quadrangles
  __global const int* barrier_start;
  __global const int* barrier_list;
  __global const real* barriers;
  // and their free edges
  __global const int* edge_start;
  __global const int* edge_list;
  __global const real* edges;
#if LONG_AXES
  real rest[3];  // of the place of the particle whose turn it is
#endif
#if THIN_WALLS
  // of the particle whose turn it is:
  real share;    // with which it sees walls that thin ones hide from it
  bool past;     // thin walls may stand between it and what is within its support
  real nearest;  // it is no nearer to any of them
  bool screened; // it stands before a thin wall, of the plane n·y + o = 0
  real screen[4];
#endif
} walls_t;

// The arguments of a kernel that sweeps walls, or particles that walls may hide.
#define WALL_ARGUMENTS                                                                                                             \
  __global const int *wall_start, __global const int *wall_list, __global const real *wall_fields, int wall_stride,               \
      __global const real *wall_motions, __global const int *barrier_start, __global const int *barrier_list, __global const real *barriers, \
      __global const int *edge_start, __global const int *edge_list, __global const real *edges
// Elements are gone through one after the other, so that each field is an array; facets by a list, so that each facet's fields lie together.
#if FACETS
#define WALL_FIELD(walls, field, s) ((walls)->fields[(s) * (walls)->wall_stride + (field)])
#else
#define WALL_FIELD(walls, field, s) ((walls)->fields[(field) * (walls)->wall_stride + (s)])
#endif
#define WALLS_OF_ARGUMENTS {wall_start, wall_list, wall_fields, wall_stride, wall_motions, barrier_start, barrier_list, barriers, edge_start, edge_list, edges}

// BLOCK_LIST, where it is defined, is how many blocks of candidates a tile has room for in a list, which the sweep over a state's gradients makes of those
// that have a pair, and the sweeps over the same state go by: each tile's has their number, or −1 if they are not listed, and then one value for each.
#if defined(BLOCK_LIST) && TILE_LANES > 1 && !GHOSTS && !THIN_WALLS
#define HAS_BLOCK_LIST 1
#define BLOCK_LIST_OF_TILE (blocks + (long)(BLOCK_LIST + 2) * get_global_id(0))
#define USE_BLOCK_LIST(near) (near).blocks = BLOCK_LIST_OF_TILE;
#else
#define HAS_BLOCK_LIST 0
#define USE_BLOCK_LIST(near)
#endif

// Where the particles of a tile lie, or the one point, whose neighbours are wanted.
typedef struct {
  real x[TILE_OWN], y[TILE_OWN], z[TILE_OWN];
} places_t;

typedef struct {
  __global const real* state;
  long stride;
  real reach;  // the support, and how far a particle may have moved since it was sorted
  int own;     // how many of the tile's particles count: the last tile may not be full
  places_t places;
#if LONG_AXES
  tile rest[3];  // of the places
#endif
  const walls_t* walls;
#if HAS_BLOCK_LIST
#ifdef KEEPS_BLOCKS
  __global int* blocks;
#else
  __global const int* blocks;
#endif
#endif
#if THIN_WALLS
  bool past;                     // thin walls may stand between the tile and what is within its support
  int watched;                   // the owner whose thin walls' hiding is told apart; NO_OWNER if none's is
  real transparency[TILE_OWN];   // with which neighbours count that a thin wall hides
  real beyond[TILE_OWN];         // Σ W V of all that are beyond thin walls, in sight or not
  tile through;                  // 1: it is the watched owner's walls that hide them
#endif
#if PARTLY_SEEN
  tile seen;                     // how much the neighbours that are added now count: 1 in sight
#endif
#if GHOSTS
  bool mirrored;  // the neighbours added now are those of the image
  __global const real* image;
#endif
#if PIERCED
  int gap_count;  // of the image's planes, if any of them is near
  __global const real* gaps;
#endif
} neighbours_t;

INLINE real dot3(vector_t a, vector_t b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
INLINE vector_t make_vector(real x, real y, real z) {
  vector_t v = {x, y, z};
  return v;
}

INLINE vector_t cross3(vector_t a, vector_t b) { return make_vector(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x); }

INLINE vector_t turned(__global const real* q, real x, real y, real z) {
  return make_vector(q[0] * x + q[1] * y + q[2] * z, q[3] * x + q[4] * y + q[5] * z, q[6] * x + q[7] * y + q[8] * z);
}

INLINE vector_t velocity_of(__global const real* state, long stride, int i) {
  return make_vector(state[FIELD_U * stride + i], DIMENSIONS == 3 ? state[FIELD_V * stride + i] : R(0.0), state[FIELD_W * stride + i]);
}

INLINE void start_neighbours(neighbours_t* n, __global const real* state, long stride, real reach, const walls_t* walls) {
  n->state = state;
  n->stride = stride;
  n->reach = reach;
  n->own = TILE_OWN;
  n->walls = walls;
#if LONG_AXES
  for (int axis = 0; axis < 3; ++axis) n->rest[axis] = (tile)(R(0.0));
#endif
#if THIN_WALLS
  n->past = true;
  n->watched = NO_OWNER;
  for (int k = 0; k < TILE_OWN; ++k) n->transparency[k] = n->beyond[k] = R(0.0);
  n->through = (tile)(R(0.0));
#endif
#if PARTLY_SEEN
  n->seen = (tile)(R(1.0));
#endif
#if GHOSTS
  n->mirrored = false;
  n->image = 0;
#endif
#if PIERCED
  n->gap_count = 0;
  n->gaps = 0;
#endif
}

// Of the particles from `first` on, TILE_OWN or as many as there are before `end`.
INLINE void neighbours_of(neighbours_t* n, __global const real* state, long stride, real reach, const walls_t* walls, int first, int end) {
  start_neighbours(n, state, stride, reach, walls);
  n->own = min(TILE_OWN, end - first);
  for (int k = 0; k < TILE_OWN; ++k) {
    n->places.x[k] = state[FIELD_X * stride + first + k];
    n->places.y[k] = DIMENSIONS == 3 ? state[FIELD_Y * stride + first + k] : R(0.0);
    n->places.z[k] = state[FIELD_Z * stride + first + k];
  }
#if LONG_AXES
  for (int axis = 0; axis < 3; ++axis) n->rest[axis] = own_values(state + (FIELD_REST_X + axis) * stride, first);
#endif
}

// Of a point; in tiles of one.
INLINE void neighbours_at(neighbours_t* n, __global const real* state, long stride, real reach, const walls_t* walls, real x, real y, real z) {
  start_neighbours(n, state, stride, reach, walls);
  n->places.x[0] = x;
  n->places.y[0] = y;
  n->places.z[0] = z;
}

// A field of the candidates from j on.
INLINE tile near_field(const neighbours_t* n, int field, int j) { return near_values(n->state + field * n->stride, j); }

// How far they are along one axis, from where `own` and the rests are. The bound on the difference, which nothing reaches, keeps fast-math from
// adding up coordinates and rests in another order.
INLINE tile near_way(const neighbours_t* n, int axis, int j, tile own) {
  const tile way = near_field(n, FIELD_X + axis, j) - own;
#if LONG_AXES
  if (IS_LONG(axis)) return fmin(way, (tile)(FAR_AWAY)) - (near_field(n, FIELD_REST_X + axis, j) - n->rest[axis]);
#endif
  return way;
}

// From a particle at `own` to a wall, likewise.
INLINE real wall_way(const walls_t* walls, int axis, real wall, real own) {
#if LONG_AXES
  if (IS_LONG(axis)) return fmin(wall - own, FAR_AWAY) + walls->rest[axis];
#endif
  return wall - own;
}

// Particle i sees the walls now.
INLINE void stand_at(walls_t* walls, __global const real* state, long stride, int i) {
#if LONG_AXES
  for (int axis = 0; axis < 3; ++axis) walls->rest[axis] = state[(FIELD_REST_X + axis) * stride + i];
#endif
}

// Their volumes, as far as they count.
INLINE tile near_volume(const neighbours_t* n, int j) {
#if PARTLY_SEEN
  return n->seen * near_field(n, FIELD_VOLUME, j);
#else
  return near_field(n, FIELD_VOLUME, j);
#endif
}

INLINE tile_vector_t neighbour_velocity(const neighbours_t* n, int j) {
  const tile u = near_field(n, FIELD_U, j), w = near_field(n, FIELD_W, j);
  const tile v = DIMENSIONS == 3 ? near_field(n, FIELD_V, j) : (tile)(R(0.0));
#if GHOSTS
  if (n->mirrored) {
    const vector_t t = turned(n->image + IMAGE_VELOCITY, u, v, w);
    __global const real* b = n->image + IMAGE_VELOCITY_OFFSET;
    return make_vector(t.x + b[0], t.y + b[1], t.z + b[2]);
  }
#endif
  return make_tile_vector(u, v, w);
}

#if GHOSTS
// From what a ghost mirrors to the ghost; r: of the ghost from the particle.
INLINE vector_t way_to_ghost(const neighbours_t* n, int j, real rx, real ry, real rz) {
  return make_vector(n->places.x[0] + rx - n->state[FIELD_X * n->stride + j],
                     DIMENSIONS == 3 ? n->places.y[0] + ry - n->state[FIELD_Y * n->stride + j] : R(0.0),
                     n->places.z[0] + rz - n->state[FIELD_Z * n->stride + j]);
}
#endif

// r: of the neighbour from the particle. A ghost lies deeper or higher than what it mirrors, by as much hydrostatic pressure.
INLINE tile neighbour_pressure(const neighbours_t* n, __constant const parameters_t* p, int j, tile rx, tile ry, tile rz) {
  const tile pressure = near_field(n, FIELD_PRESSURE, j);
#if GHOSTS
  if (n->mirrored) {
    const real density = p->density * (R(1.0) + n->state[FIELD_COMPRESSION * n->stride + j]);
    const vector_t way = way_to_ghost(n, j, rx, ry, rz);
    return pressure + density * (p->gravity_x * way.x + p->gravity_y * way.y + p->gravity_z * way.z);
  }
#endif
  return pressure;
}

// A ghost's compression, by the same hydrostatics, linearised.
INLINE tile neighbour_compression(const neighbours_t* n, __constant const parameters_t* p, int j, tile rx, tile ry, tile rz) {
  const tile compression = near_field(n, FIELD_COMPRESSION, j);
#if GHOSTS
  if (n->mirrored) {
    const vector_t way = way_to_ghost(n, j, rx, ry, rz);
    return compression + p->hydrostatic_x * way.x + p->hydrostatic_y * way.y + p->hydrostatic_z * way.z;
  }
#endif
  return compression;
}

// Whether the image's neighbours can be within the support of (x, y, z).
INLINE bool near_image(__constant const parameters_t* p, __global const real* image, real x, real y, real z) {
  bool near = true;
  for (int k = 0; k < 3; ++k) {
    __global const real* plane = image + IMAGE_NEAR + 4 * k;
    near = near && plane[0] * x + plane[1] * y + plane[2] * z + plane[3] < p->support;
  }
  return near;
}

// Where (x, y, z) lies as the image's originals see it: Qᵀ (x − c).
INLINE vector_t seen_by_image(__global const real* image, real x, real y, real z) {
  __global const real* q = image + IMAGE_MATRIX;
  const real dx = x - image[IMAGE_OFFSET], dy = y - image[IMAGE_OFFSET + 1], dz = z - image[IMAGE_OFFSET + 2];
  return make_vector(q[0] * dx + q[3] * dy + q[6] * dz, q[1] * dx + q[4] * dy + q[7] * dz, q[2] * dx + q[5] * dy + q[8] * dz);
}

#if PIERCED
#define GAP_BORDER R(0.5)    // spacings, about a gap's outline, over which the plane comes to mirror wholly: what passes the outline is not to kick
#define BEHIND_PLANE R(0.1)  // spacings: nothing is mirrored that lies so far behind, where the water beyond openings stands

// How far the foot of (x, y, z) on the plane, from which it is `above`, lies outside of a gap.
INLINE real way_beside_gap(__global const real* gap, real above, real x, real y, real z) {
  if (gap[GAP_RADIUS] > R(0.0)) {
    const vector_t off = make_vector(x - gap[GAP_CENTRE], y - gap[GAP_CENTRE + 1], z - gap[GAP_CENTRE + 2]);
    return sqrt(fmax(dot3(off, off) - above * above, R(0.0))) - gap[GAP_RADIUS];
  }
  real way = -FAR_AWAY;
  for (int k = 0; k < (int)gap[GAP_CORNERS]; ++k) {
    __global const real* edge = gap + GAP_EDGES + 4 * k;
    way = fmax(way, edge[0] * x + edge[1] * y + edge[2] * z + edge[3]);
  }
  return way;
}

INLINE real above_gap(__global const real* gap, real x, real y, real z) {
  return gap[GAP_PLANE] * x + gap[GAP_PLANE + 1] * y + gap[GAP_PLANE + 2] * z + gap[GAP_PLANE + 3];
}

INLINE __global const real* next_gap(__global const real* gap) { return gap + GAP_EDGES + 4 * (int)gap[GAP_CORNERS]; }

// How much of what is at (x, y, z) the planes with these gaps mirror: nothing before a gap.
INLINE real mirrored_part(__constant const parameters_t* p, __global const real* gaps, int count, real x, real y, real z) {
  real part = R(1.0);
  for (__global const real* gap = gaps; count > 0; --count, gap = next_gap(gap)) {
    const real above = above_gap(gap, x, y, z);
    const real beside = above < -BEHIND_PLANE * p->spacing ? -p->spacing : way_beside_gap(gap, above, x, y, z);
    part = fmin(part, fmin(fmax(beside / (GAP_BORDER * p->spacing) + R(0.5), R(0.0)), R(1.0)));
  }
  return part;
}

// Where the gaps of an image's planes are, and how many.
INLINE int gaps_of_image(__constant const parameters_t* p, __global const real* images, int image, __global const real** gaps) {
  __global const real* at = images + p->images * IMAGE_COUNT + 2 * image;
  *gaps = images + (int)at[0];
  return (int)at[1];
}

// Whether any of the gaps is so near to (x, y, z) that something within the support of it has its foot in it.
INLINE bool near_gap(__constant const parameters_t* p, __global const real* gaps, int count, real x, real y, real z) {
  bool near = false;
  for (__global const real* gap = gaps; count > 0; --count, gap = next_gap(gap))
    near = near || way_beside_gap(gap, above_gap(gap, x, y, z), x, y, z) < p->support + GAP_BORDER * p->spacing;
  return near;
}
#endif

#if THIN_WALLS
#define BARRIER_OWNER 20

// Whether the barrier stands at the point (x, y, z) of its plane.
INLINE bool within_barrier(__global const real* b, real x, real y, real z) {
  bool within = true;
  for (int e = 1; e <= BARRIER_EDGES; ++e) within = within && b[4 * e] * x + b[4 * e + 1] * y + b[4 * e + 2] * z + b[4 * e + 3] >= R(0.0);
  return within;
}

// Where the way from (x, y, z) along (rx, ry, rz) crosses a barrier, as a part of it; 2 if it does not. `side`: 1 from its water to its back, −1 back.
INLINE real crossing(__global const real* b, real x, real y, real z, real rx, real ry, real rz, real side) {
  const real before = side * (b[0] * x + b[1] * y + b[2] * z + b[3]);
  const real after = before + side * (b[0] * rx + b[1] * ry + b[2] * rz);
  if (before >= R(0.0) || after <= R(0.0)) return R(2.0);
  const real part = before / (before - after);
  return within_barrier(b, x + part * rx, y + part * ry, z + part * rz) ? part : R(2.0);
}

// Whose thin wall of the cell the way from (x, y, z) along (rx, ry, rz) goes through: in by one side and out by the other. What only cuts a corner of a
// solid is not hidden by it; nor does any solid hide its corners. Of several owners the last, which it also is on the way back.
INLINE int hidden_in_cell(__constant const parameters_t* p, const walls_t* walls, real x, real y, real z, real rx, real ry, real rz) {
  const int cell = cell_index(p, x, y, z);
  const int first = walls->barrier_start[cell], end = walls->barrier_start[cell + 1];
  real by = R(-1.0);  // NO_OWNER
  for (int k = first; k < end; ++k) {
    __global const real* in = walls->barriers + BARRIER_COUNT * walls->barrier_list[k];
    if (crossing(in, x, y, z, rx, ry, rz, R(1.0)) > R(1.0)) continue;
    for (int l = first; l < end; ++l) {
      __global const real* out = walls->barriers + BARRIER_COUNT * walls->barrier_list[l];
      if (in[0] * out[0] + in[1] * out[1] + in[2] * out[2] < R(-0.5) && crossing(out, x, y, z, rx, ry, rz, R(-1.0)) <= R(1.0))
        by = fmax(by, fmax(in[BARRIER_OWNER], out[BARRIER_OWNER]));
    }
  }
  return (int)by;
}

// Whether that way comes out of any thin wall of the cell.
INLINE bool beyond_thin(__constant const parameters_t* p, const walls_t* walls, real x, real y, real z, real rx, real ry, real rz) {
  const int cell = cell_index(p, x, y, z);
  for (int k = walls->barrier_start[cell]; k < walls->barrier_start[cell + 1]; ++k)
    if (crossing(walls->barriers + BARRIER_COUNT * walls->barrier_list[k], x, y, z, rx, ry, rz, R(-1.0)) <= R(1.0)) return true;
  return false;
}

// Of the support: how far thin walls are looked for. Walls are also looked at from a hair off the particle.
#define SIGHT R(1.01)

// (x, y, z) is no nearer to the barrier, of whose plane it is that far.
INLINE real least_way_to_barrier(__global const real* b, real off_plane, real x, real y, real z) {
  real off = fabs(off_plane);
  for (int e = 1; e <= BARRIER_EDGES; ++e) off = fmax(off, -(b[4 * e] * x + b[4 * e + 1] * y + b[4 * e + 2] * z + b[4 * e + 3]));
  return off;
}

// Sets whether thin walls may hide anything from (x, y, z), and the plane of the nearest one that it stands before and over.
INLINE void find_screen(__constant const parameters_t* p, walls_t* walls, real x, real y, real z) {
  const int cell = cell_index(p, x, y, z);
  const real reach = SIGHT * p->support;
  real nearest = p->support;
  walls->past = false;
  walls->nearest = p->support;
  walls->screened = false;
  for (int k = walls->barrier_start[cell]; k < walls->barrier_start[cell + 1]; ++k) {
    __global const real* b = walls->barriers + BARRIER_COUNT * walls->barrier_list[k];
    const real distance = -(b[0] * x + b[1] * y + b[2] * z + b[3]);
    if (fabs(distance) >= reach) continue;
    const real least = least_way_to_barrier(b, distance, x, y, z);
    if (least >= reach) continue;
    walls->past = true;
    walls->nearest = fmin(walls->nearest, least);
    if (distance <= R(0.0) || distance >= nearest) continue;
    if (!within_barrier(b, x + distance * b[0], y + distance * b[1], z + distance * b[2])) continue;
    nearest = distance;
    walls->screened = true;
    for (int i = 0; i < 4; ++i) walls->screen[i] = b[i];
  }
}

// Of the kernel, what lies farther than this, in supports.
INLINE real kernel_beyond(real q) {
  const real q2 = q * q;
#if DIMENSIONS == 3
  const real within = R(42.0) * q2 * q * (R(1.0) / R(3.0) + q2 * (R(-2.0) + q * (R(10.0) / R(3.0) + q * (R(-15.0) / R(7.0) + q * R(0.5)))));
#else
  const real within = R(14.0) * q2 * (R(0.5) + q2 * (R(-2.5) + q * (R(4.0) + q * (R(-2.5) + q * (R(4.0) / R(7.0))))));
#endif
  return fmax(R(1.0) - within, R(0.0));
}

// The far side of thin walls counts by how wet it is beyond them: wholly from this Σ W V on, since no more than all of the kernel that is farther than
// they are has room there; and a little more, for the quadrature. Where thin walls hide less than LITTLE_ROOM, the far side counts as wet: off the tip of
// a part next to nothing is hidden, and next to nothing beyond; their ratio would be noise.
#define WET_BEYOND R(20.0)  // far from full, a far side is not dry
#define LITTLE_ROOM R(0.02)
INLINE real enough_beyond(__constant const parameters_t* p, real nearest) {
  return (R(1.1) * kernel_beyond(nearest * p->inverse_support) - LITTLE_ROOM) / WET_BEYOND;
}

// Whether they may hide walls that are looked at from (x, y, z), once find_screen has been at the particle. Where images have them it has not.
#if IMAGES
#define MAY_HIDE(p, walls, x, y, z) has_barriers(p, walls, x, y, z)
#else
#define MAY_HIDE(p, walls, x, y, z) ((walls)->past)
#endif

// Of the thin walls of the cell that the way from (x, y, z) along (rx, ry, rz) crosses from their water to their back: whether the first one faces the
// other way than a wall with this normal.
INLINE bool behind_opposite(__constant const parameters_t* p, const walls_t* walls, real x, real y, real z, real rx, real ry, real rz, vector_t normal) {
  const int cell = cell_index(p, x, y, z);
  real first = R(2.0);
  bool opposite = false;
  for (int k = walls->barrier_start[cell]; k < walls->barrier_start[cell + 1]; ++k) {
    __global const real* b = walls->barriers + BARRIER_COUNT * walls->barrier_list[k];
    const real part = crossing(b, x, y, z, rx, ry, rz, R(1.0));
    if (part >= first) continue;
    first = part;
    opposite = b[0] * normal.x + b[1] * normal.y + b[2] * normal.z < R(-0.5);
  }
  return opposite;
}

INLINE bool has_barriers(__constant const parameters_t* p, const walls_t* walls, real x, real y, real z) {
  const int cell = cell_index(p, x, y, z);
  return walls->barrier_start[cell + 1] > walls->barrier_start[cell];
}

// Thin walls are transparent about their free edges. There the water on both sides is one and the sums over all of it and over all of the wall are those
// of any solid; hiding what lies behind the wall from a particle would leave its sums open, or closed by a guess, and pressures would jump whenever a
// neighbour comes round the edge. Farther from the edge than the support a particle sees no more of what is behind than behind any wall, and what is there
// and the wall's own far side cancel: between EDGE_NEAR and EDGE_FAR of the support both ways of summing are right, and the one goes over into the other.
#define FREE_EDGE_DIRECTION 3
#define FREE_EDGE_LENGTH 6
#define FREE_EDGE_OPEN 7  // 1; 0 where another wall stands at it
#define EDGE_NEAR R(1.0)
#define EDGE_FAR R(1.5)

INLINE real transparency_at(__constant const parameters_t* p, const walls_t* walls, real x, real y, real z) {
  const int cell = cell_index(p, x, y, z);
  real transparency = R(0.0);
  for (int k = walls->edge_start[cell]; k < walls->edge_start[cell + 1]; ++k) {
    __global const real* e = walls->edges + FREE_EDGE_COUNT * walls->edge_list[k];
    const vector_t to = make_vector(x - e[0], DIMENSIONS == 3 ? y - e[1] : R(0.0), z - e[2]);
    const vector_t way = make_vector(e[FREE_EDGE_DIRECTION], e[FREE_EDGE_DIRECTION + 1], e[FREE_EDGE_DIRECTION + 2]);
    const real along = fmin(fmax(dot3(to, way), R(0.0)), e[FREE_EDGE_LENGTH]);
    const vector_t off = make_vector(to.x - along * way.x, to.y - along * way.y, to.z - along * way.z);
    const real distance = sqrt(dot3(off, off)) * p->inverse_support;
    const real near = fmin(fmax((EDGE_FAR - distance) / (EDGE_FAR - EDGE_NEAR), R(0.0)), R(1.0));
    transparency = fmax(transparency, near * near * (R(3.0) - R(2.0) * near) * e[FREE_EDGE_OPEN]);
  }
  return transparency;
}
#endif

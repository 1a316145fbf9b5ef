// The neighbours as a sweep sees them: itself in the same tank, or, near an end of a periodic tank or the planes of a tank with ghosts, their images.
// An image is x' = Q x + c. A periodic one is a shift; a ghost's is a reflection in one to three planes at right angles to each other.
#include "cells.cl"

#define IMAGE_MATRIX 0            // Q, row by row
#define IMAGE_OFFSET 9            // c
#define IMAGE_VELOCITY 12         // u' = B u + b: B, row by row
#define IMAGE_VELOCITY_OFFSET 21  // b
#define IMAGE_NEAR 24             // seen only by particles with n·x + o < R for each of three planes: n, o
#define IMAGE_MIRRORED 36         // 1: a reflection
#define IMAGE_COUNT 37

typedef struct {
  __global const real* state;
  int stride;
  real x, y, z;  // of the particle, or the point, whose neighbours they are
#if GHOSTS
  bool mirrored;  // the neighbours added now are those of the image
  __global const real* image;
#endif
} neighbours_t;

typedef struct {
  real x, y, z;
} vector_t;

INLINE real dot3(vector_t a, vector_t b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
INLINE vector_t make_vector(real x, real y, real z) {
  vector_t v = {x, y, z};
  return v;
}

INLINE vector_t cross3(vector_t a, vector_t b) { return make_vector(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x); }

INLINE vector_t turned(__global const real* q, real x, real y, real z) {
  return make_vector(q[0] * x + q[1] * y + q[2] * z, q[3] * x + q[4] * y + q[5] * z, q[6] * x + q[7] * y + q[8] * z);
}

INLINE neighbours_t neighbours_of(__global const real* state, int stride, real x, real y, real z) {
  neighbours_t n;
  n.state = state;
  n.stride = stride;
  n.x = x;
  n.y = y;
  n.z = z;
#if GHOSTS
  n.mirrored = false;
  n.image = 0;
#endif
  return n;
}

INLINE vector_t neighbour_velocity(const neighbours_t* n, int j) {
  const real u = n->state[FIELD_U * n->stride + j], w = n->state[FIELD_W * n->stride + j];
  const real v = DIMENSIONS == 3 ? n->state[FIELD_V * n->stride + j] : R(0.0);
#if GHOSTS
  if (n->mirrored) {
    const vector_t t = turned(n->image + IMAGE_VELOCITY, u, v, w);
    __global const real* b = n->image + IMAGE_VELOCITY_OFFSET;
    return make_vector(t.x + b[0], t.y + b[1], t.z + b[2]);
  }
#endif
  return make_vector(u, v, w);
}

// r: of the neighbour from (x, y, z). A ghost lies deeper or higher than what it mirrors, by as much hydrostatic pressure.
INLINE real neighbour_pressure(const neighbours_t* n, __constant const parameters_t* p, int j, real rx, real ry, real rz) {
  const real pressure = n->state[FIELD_PRESSURE * n->stride + j];
#if GHOSTS
  if (n->mirrored) {
    const real density = p->density * (R(1.0) + n->state[FIELD_COMPRESSION * n->stride + j]);
    const real dx = n->x + rx - n->state[FIELD_X * n->stride + j], dz = n->z + rz - n->state[FIELD_Z * n->stride + j];
    const real dy = DIMENSIONS == 3 ? n->y + ry - n->state[FIELD_Y * n->stride + j] : R(0.0);
    return pressure + density * (p->gravity_x * dx + p->gravity_y * dy + p->gravity_z * dz);
  }
#endif
  return pressure;
}

// A ghost's compression, by the same hydrostatics, linearised.
INLINE real neighbour_compression(const neighbours_t* n, __constant const parameters_t* p, int j, real rx, real ry, real rz) {
  const real compression = n->state[FIELD_COMPRESSION * n->stride + j];
#if GHOSTS
  if (n->mirrored) {
    const real dx = n->x + rx - n->state[FIELD_X * n->stride + j], dz = n->z + rz - n->state[FIELD_Z * n->stride + j];
    const real dy = DIMENSIONS == 3 ? n->y + ry - n->state[FIELD_Y * n->stride + j] : R(0.0);
    return compression + p->hydrostatic_x * dx + p->hydrostatic_y * dy + p->hydrostatic_z * dz;
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

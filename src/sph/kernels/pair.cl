// A tile's own particles and its candidates, as schemes and their terms see them: i its own, j the candidates.
typedef struct {
  int j;                   // the first candidate
  tile rx, ry, rz, r2;     // x_j − x_i, m; m²
  tile distance;           // m
  tile slope_volume;       // F V_j, but for the factor p->slope_scale
  tile_vector_t relative;  // u_j − u_i, m/s
  tile approach;           // (u_j − u_i)·(x_j − x_i), m²/s
} pair_t;

INLINE pair_t pair_of(const neighbours_t* n, int j, tile rx, tile ry, tile rz, tile r2, tile distance, tile slope_volume, tile u, tile v, tile w) {
  pair_t pair;
  pair.j = j;
  pair.rx = rx;
  pair.ry = ry;
  pair.rz = rz;
  pair.r2 = r2;
  pair.distance = distance;
  pair.slope_volume = slope_volume;
  const tile_vector_t velocity = neighbour_velocity(n, j);
  pair.relative = make_tile_vector(velocity.x - u, DIMENSIONS == 3 ? velocity.y - v : (tile)(R(0.0)), velocity.z - w);
#if DIMENSIONS == 3
  pair.approach = pair.relative.x * rx + pair.relative.y * ry + pair.relative.z * rz;
#else
  pair.approach = pair.relative.x * rx + pair.relative.z * rz;
#endif
  return pair;
}

// Gradients that gradients.cl has found, one after the other in an array.
#define GRADIENT_COMPRESSION 0  // three values
#define GRADIENT_U 3            // of u, then v, then w, three values each (GRADIENT_OF_VELOCITY); or of the rate of strain six, twice it off the diagonal (GRADIENT_OF_STRAIN)
#define GRADIENT_SHEPARD 12     // and, where particles exchange mass, γ
#define GRADIENT_EDDIES (GRADIENT_OF_STRAIN ? 9 : 13)  // and (d+2) ρ₀ times the eddy viscosity

INLINE tile_vector_t own_gradient(const neighbours_t* n, __global const real* gradient, int of, int first) {
  __global const real* g = gradient + of * n->stride;
  return make_tile_vector(own_values(g, first), DIMENSIONS == 3 ? own_values(g + n->stride, first) : (tile)(R(0.0)), own_values(g + 2 * n->stride, first));
}

// As the particle has it; a ghost's is not turned.
INLINE tile_vector_t near_gradient(const neighbours_t* n, __global const real* gradient, int of, int j) {
  __global const real* g = gradient + of * n->stride;
  return make_tile_vector(near_values(g, j), DIMENSIONS == 3 ? near_values(g + n->stride, j) : (tile)(R(0.0)), near_values(g + 2 * n->stride, j));
}

// Of the compression. A ghost's is mirrored, but for what hydrostatics explains, which goes on through the wall (neighbour_compression).
INLINE tile_vector_t neighbour_gradient(const neighbours_t* n, __constant const parameters_t* p, __global const real* gradient, int j) {
  tile_vector_t near = near_gradient(n, gradient, GRADIENT_COMPRESSION, j);
#if GHOSTS
  if (n->mirrored) {
    near = turned(n->image + IMAGE_MATRIX, near.x - p->hydrostatic_x, near.y - p->hydrostatic_y, near.z - p->hydrostatic_z);
    near.x += p->hydrostatic_x;
    near.y += p->hydrostatic_y;
    near.z += p->hydrostatic_z;
  }
#endif
  return near;
}

// What the velocity changes by from the candidates over the way r, (r·∇)u.
INLINE tile_vector_t neighbour_velocity_change(const neighbours_t* n, __global const real* gradient, int j, tile rx, tile ry, tile rz) {
#if GHOSTS
  if (n->mirrored) {
    const vector_t way = turned(n->image + IMAGE_MATRIX, rx, ry, rz);  // of what it mirrors: a reflection is its own inverse
    const vector_t change = make_vector(dot3(near_gradient(n, gradient, GRADIENT_U, j), way), dot3(near_gradient(n, gradient, GRADIENT_U + 3, j), way),
                                        dot3(near_gradient(n, gradient, GRADIENT_U + 6, j), way));
    return turned(n->image + IMAGE_VELOCITY, change.x, change.y, change.z);
  }
#endif
  const tile_vector_t way = make_tile_vector(rx, ry, rz);
  return make_tile_vector(tile_dot(near_gradient(n, gradient, GRADIENT_U, j), way),
                          DIMENSIONS == 3 ? tile_dot(near_gradient(n, gradient, GRADIENT_U + 3, j), way) : (tile)(R(0.0)),
                          tile_dot(near_gradient(n, gradient, GRADIENT_U + 6, j), way));
}

// What antisymmetric exchanges of a pair are multiplied by: 1/γ of the mean γ, or what the one gives the other would not get.
INLINE tile shared_shepard(const neighbours_t* n, __global const real* gradient, tile own_shepard, int j) {
  return R(2.0) / (own_shepard + near_values(gradient + GRADIENT_SHEPARD * n->stride, j));
}

// The rate of strain ½ (∇u + ∇uᵀ), off its diagonal twice that.
typedef struct {
  tile xx, xy, xz, yy, yz, zz;
} strain_t;

INLINE strain_t own_strain(const neighbours_t* n, __global const real* gradient, int first) {
  __global const real* g = gradient + GRADIENT_U * n->stride;
  strain_t e = {own_values(g, first), own_values(g + n->stride, first), own_values(g + 2 * n->stride, first), own_values(g + 3 * n->stride, first),
                own_values(g + 4 * n->stride, first), own_values(g + 5 * n->stride, first)};
  return e;
}

INLINE strain_t near_strain(const neighbours_t* n, __global const real* gradient, int j) {
  __global const real* g = gradient + GRADIENT_U * n->stride;
  strain_t e = {near_values(g, j), near_values(g + n->stride, j), near_values(g + 2 * n->stride, j), near_values(g + 3 * n->stride, j),
                near_values(g + 4 * n->stride, j), near_values(g + 5 * n->stride, j)};
  return e;
}

// r·(r·∇)u.
INLINE tile stretch_of(const strain_t* e, tile rx, tile ry, tile rz) {
#if DIMENSIONS == 3
  return rx * (e->xx * rx + e->xy * ry + e->xz * rz) + ry * (e->yy * ry + e->yz * rz) + e->zz * rz * rz;
#else
  return rx * (e->xx * rx + e->xz * rz) + e->zz * rz * rz;
#endif
}

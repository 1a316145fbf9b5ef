// Rates by second-order moving least squares ([M], docs/least_squares.md), with G_ij = [M_i⁻¹ b(ξ_ij)]_{1..d} W(r_ij, h_m)/h_m in the place of ∇_i W_ij:
//   du/dt = −(1/ρ_i) Σ_j V_j (pressures of i and j, and q_ij) G_ij + ν ∇²u + g
//   ds/dt = −(1+s) Σ_j V_j (u_j − u_i)·G_ij + diffusion
// All is linear in G_ij: what stands beside it is summed times w b, and M_i⁻¹ comes in after the sweep. Where the fit has no Laplacian, viscosity is Morris' sum.
// q_ij is the artificial viscosity of two particles that approach each other; of derivatives straight from the fit (MLS_DIRECT), it is one more viscosity where
// water is compressed.
// A kernel's file says what is found: WITH_ACCELERATIONS, WITH_COMPRESSION; FIT_IN_SWEEP if the same sweep builds the fit, else it is in the array of gradients;
// ONLY_FIT if nothing else is wanted; WALL_FORCES.
#include "walls.cl"
#include "pair.cl"
#include "equation_of_state.cl"
#include "scheme.cl"
#include "mls_basis.cl"
#include "mls_solution.cl"
#include "mls_pressure.cl"
#include "continuity_sums.cl"
#define SWEEP_PARTICLES
#define SPREADS (DENSITY_DIFFUSION && WITH_COMPRESSION)
#define NEEDS_VELOCITIES (!ONLY_FIT)
#define NEIGHBOURS_FITS (ADJOINT_PRESSURE && WITH_ACCELERATIONS)
#define LOCAL_IMAGES (!GHOSTS)
#if LOCAL_IMAGES
#define SWEEP_WALLS
#include "mls_images.cl"
#endif

typedef struct {
  neighbours_t near;
  __global const real* gradient;
#if LOCAL_IMAGES
  const planes_t* planes;
  bool mirrors;  // any wall is near
#endif
#if WALL_FORCES
  bool fitting;  // all neighbours go into the fit; then the images alone into the rest
#endif
  tile u, v, w, pressure;
#if FIT_IN_SWEEP
  moments_t moments;
#endif
#if NEEDS_VELOCITIES
  tile velocity[3][BASIS];  // Σ w (u_j − u_i) b
#endif
#if WITH_ACCELERATIONS
  tile force[BASIS];  // Σ w (…) b
  tile morris_x, morris_y, morris_z;
#endif
#if NEIGHBOURS_FITS
  tile across_x, across_y, across_z;  // Σ V_j (…) G_ji
#endif
#if SPREADS
  diffusion_t diffusion;
#endif
} sweep_t;

// A neighbour as a particle sees it: itself, a ghost, or its image in a plane.
typedef struct {
  tile rx, ry, rz, r2, volume, pressure;
  tile_vector_t relative;  // u_j − u_i
} seen_t;

INLINE tile_vector_t mirrored_by(tile nx, tile ny, tile nz, tile_vector_t v) {
  const tile twice = R(2.0) * (nx * v.x + ny * v.y + nz * v.z);
  return make_tile_vector(v.x - twice * nx, v.y - twice * ny, v.z - twice * nz);
}

#if NEIGHBOURS_FITS
// Σ of a row of the neighbour's times b(−ξ).
INLINE tile near_row_times(const sweep_t* a, int row, int j, const tile* b) {
  tile sum = (tile)(R(0.0));
  for (int l = 0; l < BASIS; ++l) {
    const tile entry = near_values(a->gradient + (row * BASIS + l) * a->near.stride, j);
    sum += l < DIMENSIONS ? -entry * b[l] : entry * b[l];
  }
  return sum;
}

// G_ji/W, as the neighbour has it: of what a ghost or an image mirrors, in its place.
INLINE tile_vector_t gradient_by_neighbour(const sweep_t* a, __constant const parameters_t* p, int j, tile rx, tile ry, tile rz) {
  tile b[BASIS];
  basis_at(p, rx, ry, rz, b);
#if DIMENSIONS == 3
  return make_tile_vector(near_row_times(a, 0, j, b), near_row_times(a, 1, j, b), near_row_times(a, 2, j, b));
#else
  return make_tile_vector(near_row_times(a, 0, j, b), (tile)(R(0.0)), near_row_times(a, 1, j, b));
#endif
}
#endif

// `plane`: of the image; −1 of what is none.
INLINE void add_seen(sweep_t* a, __constant const parameters_t* p, int j, const pair_t* pair, const seen_t* seen, int plane) {
  const tile distance = sqrt(seen->r2);
  const tile weight = mls_weights(p, distance) * seen->volume;
  tile b[BASIS];
  basis_at(p, seen->rx, seen->ry, seen->rz, b);
#if FIT_IN_SWEEP
#if WALL_FORCES
  if (a->fitting)
#endif
    add_to_moments(&a->moments, weight, b);
#endif
#if WALL_FORCES && !MLS_DIRECT
  if (a->fitting) return;
#endif
#if NEEDS_VELOCITIES
  const tile wu = weight * seen->relative.x, ww = weight * seen->relative.z;
  for (int l = 0; l < BASIS; ++l) {
    a->velocity[0][l] += wu * b[l];
    a->velocity[2][l] += ww * b[l];
  }
#if DIMENSIONS == 3
  const tile wv = weight * seen->relative.y;
  for (int l = 0; l < BASIS; ++l) a->velocity[1][l] += wv * b[l];
#endif
#endif
#if WALL_FORCES && MLS_DIRECT
  if (a->fitting) return;  // the whole velocity's divergence is wanted, which switches a viscosity on
#endif
#if WITH_ACCELERATIONS || SPREADS
  const tile slope = mls_slopes(p, distance) * seen->volume;
#endif
#if WITH_ACCELERATIONS
  tile pressure = pair_pressure(a->pressure, seen->pressure);
#if MLS_DIRECT
  const tile artificial = (tile)(R(0.0));
#else
  // the small part only against a division by zero
  const tile approach = fmin(seen->relative.x * seen->rx + seen->relative.y * seen->ry + seen->relative.z * seen->rz, (tile)(R(0.0)));
  const tile artificial = -p->mls_artificial * p->density * approach / (seen->r2 + R(1.0e-4) * p->smoothing_length * p->smoothing_length);
#endif
#if ADJOINT_PRESSURE
  pressure += R(0.5) * artificial;
  const tile given = weight * (seen->pressure + R(0.5) * artificial);
#if LOCAL_IMAGES
  if (plane >= 0) {
    const tile nx = spread_own(a->planes->normal_x[max(plane, 0)]), ny = spread_own(a->planes->normal_y[max(plane, 0)]);
    const tile nz = spread_own(a->planes->normal_z[max(plane, 0)]);
    const tile_vector_t way = mirrored_by(nx, ny, nz, make_tile_vector(seen->rx, seen->ry, seen->rz));
    const tile_vector_t g = mirrored_by(nx, ny, nz, gradient_by_neighbour(a, p, j, way.x, way.y, way.z));
    a->across_x += given * g.x;
    a->across_y += given * g.y;
    a->across_z += given * g.z;
  } else
#elif GHOSTS
  if (a->near.mirrored) {
    __global const real* q = a->near.image + IMAGE_MATRIX;
    const vector_t way = turned(q, seen->rx, seen->ry, seen->rz);
    const vector_t theirs = gradient_by_neighbour(a, p, j, way.x, way.y, way.z);
    const vector_t g = turned(q, theirs.x, theirs.y, theirs.z);
    a->across_x += given * g.x;
    a->across_y += given * g.y;
    a->across_z += given * g.z;
  } else
#endif
  {
    const tile_vector_t g = gradient_by_neighbour(a, p, j, seen->rx, seen->ry, seen->rz);
    a->across_x += given * g.x;
    a->across_y += given * g.y;
    a->across_z += given * g.z;
  }
#else
  pressure += artificial;
#endif
  const tile weighted = weight * pressure;
  for (int l = 0; l < BASIS; ++l) a->force[l] += weighted * b[l];
  a->morris_x += slope * seen->relative.x;
  a->morris_z += slope * seen->relative.z;
#if DIMENSIONS == 3
  a->morris_y += slope * seen->relative.y;
#endif
#endif
#if SPREADS
  // of an image what it mirrors tells: hydrostatics goes on through the wall
  pair_t spread = *pair;
  spread.slope_volume = slope;
  add_diffusion(&a->diffusion, p, &a->near, a->gradient, &spread);
#endif
}

#if LOCAL_IMAGES
// The images of the candidates from j on, which `original` has, in the plane.
INLINE void add_image(sweep_t* a, __constant const parameters_t* p, int j, const pair_t* pair, const seen_t* original, tile_vector_t velocity, int plane) {
  const planes_t* planes = a->planes;
  const tile nx = spread_own(planes->normal_x[plane]), ny = spread_own(planes->normal_y[plane]), nz = spread_own(planes->normal_z[plane]);
  const tile d = spread_own(planes->distance[plane]) - (nx * original->rx + ny * original->ry + nz * original->rz);
  const tile counts = one_above(d, (tile)(R(0.0))) * spread_own(planes->share[plane]);
  const tile depth = R(2.0) * fmin(d, (tile)(p->support));
  seen_t seen;
  seen.rx = original->rx + depth * nx;
  seen.ry = original->ry + depth * ny;
  seen.rz = original->rz + depth * nz;
  // no image is nearer than its original; and what lies past the end of a run of candidates is far by the original's distance alone
  seen.r2 = fmax(seen.rx * seen.rx + seen.ry * seen.ry + seen.rz * seen.rz, original->r2);
  seen.volume = original->volume * counts;
#if WITH_ACCELERATIONS
  const tile density = p->density * (R(1.0) + near_field(&a->near, FIELD_COMPRESSION, j));
  seen.pressure = original->pressure + density * depth * spread_own(planes->head[plane]);
#endif
  const tile ux = spread_own(planes->velocity_x[plane]), uy = spread_own(planes->velocity_y[plane]), uz = spread_own(planes->velocity_z[plane]);
  // relative to the wall, mirrored where the water slips and turned round where it does not
  const tile slips = spread_own(planes->slips[plane]);
  const tile vx = velocity.x - ux, vy = velocity.y - uy, vz = velocity.z - uz;
  const tile twice = R(2.0) * (vx * nx + vy * ny + vz * nz);
  seen.relative = make_tile_vector(ux - a->u + slips * (vx - twice * nx) - (R(1.0) - slips) * vx,
                                   DIMENSIONS == 3 ? uy - a->v + slips * (vy - twice * ny) - (R(1.0) - slips) * vy : (tile)(R(0.0)),
                                   uz - a->w + slips * (vz - twice * nz) - (R(1.0) - slips) * vz);
  add_seen(a, p, j, pair, &seen, plane);
}
#endif

INLINE void add_particle(sweep_t* a, __constant const parameters_t* p, int j, tile rx, tile ry, tile rz, tile r2) {
  seen_t seen;
  seen.rx = rx;
  seen.ry = ry;
  seen.rz = rz;
  seen.r2 = r2;
  seen.volume = near_volume(&a->near, j);
#if WITH_ACCELERATIONS
  seen.pressure = neighbour_pressure(&a->near, p, j, rx, ry, rz);
#endif
  const pair_t pair = pair_of(&a->near, j, rx, ry, rz, r2, r2, r2, a->u, a->v, a->w);
  seen.relative = pair.relative;
#if WALL_FORCES && LOCAL_IMAGES
  if (a->fitting)
#endif
    add_seen(a, p, j, &pair, &seen, -1);
#if LOCAL_IMAGES
  if (!a->mirrors) return;
  const tile_vector_t velocity = neighbour_velocity(&a->near, j);
  for (int plane = 0; plane < a->planes->count; ++plane) add_image(a, p, j, &pair, &seen, velocity, plane);
#endif
}

#include "sweep.cl"
#if LOCAL_IMAGES
#include "mls_planes.cl"
#endif

INLINE void start_sums(sweep_t* a, __constant const parameters_t* p, int first, int end, __global const real* state, long stride, real reach,
                       const walls_t* walls, __global const real* gradient) {
  // what is farther than the weights' support counts nowhere
  neighbours_of(&a->near, state, stride, reach - p->support + p->mls_support, walls, first, end);
  a->gradient = gradient;
  a->u = own_values(state + FIELD_U * stride, first);
  a->v = DIMENSIONS == 3 ? own_values(state + FIELD_V * stride, first) : (tile)(R(0.0));
  a->w = own_values(state + FIELD_W * stride, first);
  a->pressure = own_values(state + FIELD_PRESSURE * stride, first);
#if SPREADS
  start_diffusion(&a->diffusion, p, &a->near, gradient, first);
#endif
}

INLINE void find_sums(sweep_t* a, __constant const parameters_t* p, __global const int* slot_start, __global const real* images) {
#if LOCAL_IMAGES
  // two loops, so that the compiler leaves the images out of one
  a->mirrors = a->planes->count > 0;
  if (a->mirrors) {
    sweep_particles(a, p, slot_start, images);
  } else {
    a->mirrors = false;
    sweep_particles(a, p, slot_start, images);
  }
#else
  sweep_particles(a, p, slot_start, images);
#endif
}

INLINE own_t own_load(__global const real* v) {
#if TILE_OWN == 1
  return v[0];
#elif TILE_OWN == 2
  return vload2(0, v);
#else
  return vload4(0, v);
#endif
}

#define FIT_LEVEL (ROWS * BASIS)  // after the rows in the array of gradients

INLINE void fit_of_tile(const sweep_t* a, __constant const parameters_t* p, int first, fit_t* fit) {
#if FIT_IN_SWEEP
  solve_fit(p, &a->moments, fit);
#else
  for (int r = 0; r < ROWS; ++r)
    for (int l = 0; l < BASIS; ++l) fit->row[r][l] = own_load(a->gradient + (r * BASIS + l) * a->near.stride + first);
  own_lanes(own_load(a->gradient + FIT_LEVEL * a->near.stride + first), fit->level);
#endif
}

#if NEEDS_VELOCITIES
// What the fit makes of the sums, of each of the tile's own particles.
typedef struct {
  real divergence[TILE_OWN];  // 1/s
#if WITH_ACCELERATIONS
  places_t force;    // Σ V_j (…) G_ij, Pa/m
  places_t viscous;  // acceleration, m/s²
#endif
} derivatives_t;

INLINE void velocities_of(const sweep_t* a, own_t velocity[DIMENSIONS][BASIS]) {
  for (int axis = 0; axis < DIMENSIONS; ++axis)
    for (int l = 0; l < BASIS; ++l) velocity[axis][l] = own_total(a->velocity[DIMENSIONS == 3 ? axis : 2 * axis][l]);
}

INLINE void divergence_of(const fit_t* fit, own_t velocity[DIMENSIONS][BASIS], real* divergence) {
  own_t sum = row_times(fit->row[0], velocity[0]);
  for (int axis = 1; axis < DIMENSIONS; ++axis) sum += row_times(fit->row[axis], velocity[axis]);
  own_lanes(sum, divergence);
}

// `compressing`: the divergence that switches the artificial viscosity on.
INLINE void differentiate(const sweep_t* a, __constant const parameters_t* p, const fit_t* fit, derivatives_t* d, const real* compressing) {
  own_t velocity[DIMENSIONS][BASIS];
  velocities_of(a, velocity);
  divergence_of(fit, velocity, d->divergence);
#if WITH_ACCELERATIONS
  own_t force[BASIS];
  for (int l = 0; l < BASIS; ++l) force[l] = own_total(a->force[l]);
  own_lanes(row_times(fit->row[0], force), d->force.x);
  own_lanes(row_times(fit->row[1], force), DIMENSIONS == 3 ? d->force.y : d->force.z);
#if DIMENSIONS == 3
  own_lanes(row_times(fit->row[2], force), d->force.z);
#endif
#if ADJOINT_PRESSURE
  places_t across;
  own_sums(a->across_x, across.x);
  own_sums(a->across_y, across.y);
  own_sums(a->across_z, across.z);
#endif
  own_lanes(row_times(fit->row[DIMENSIONS], velocity[0]), d->viscous.x);
  own_lanes(row_times(fit->row[DIMENSIONS], velocity[1]), DIMENSIONS == 3 ? d->viscous.y : d->viscous.z);
#if DIMENSIONS == 3
  own_lanes(row_times(fit->row[DIMENSIONS], velocity[2]), d->viscous.z);
#endif
  places_t morris;
  own_sums(a->morris_x, morris.x);
  own_sums(a->morris_y, morris.y);
  own_sums(a->morris_z, morris.z);
  for (int k = 0; k < TILE_OWN; ++k) {
#if DIMENSIONS == 2
    d->force.y[k] = R(0.0);
    d->viscous.y[k] = R(0.0);
#endif
#if ADJOINT_PRESSURE
    d->force.x[k] -= across.x[k];
    d->force.y[k] -= DIMENSIONS == 3 ? across.y[k] : R(0.0);
    d->force.z[k] -= across.z[k];
#endif
    real viscosity = p->mls_viscosity;
#if MLS_DIRECT
    if (compressing[k] < R(0.0)) viscosity += p->mls_artificial * (R(0.5) / (DIMENSIONS + R(2.0)));  // as much as α means in a pair
#endif
    const bool whole = fit->level[k] == FIT_WHOLE;
    const real by_morris = R(2.0) * p->mls_slope_scale;
    d->viscous.x[k] = viscosity * (whole ? d->viscous.x[k] : by_morris * morris.x[k]);
    d->viscous.y[k] = viscosity * (whole ? d->viscous.y[k] : by_morris * morris.y[k]);
    d->viscous.z[k] = viscosity * (whole ? d->viscous.z[k] : by_morris * morris.z[k]);
  }
#endif
}
#endif

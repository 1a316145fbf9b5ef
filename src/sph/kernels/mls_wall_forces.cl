// What the fluid does to one owner of walls, by the sums of mls_sums.cl: of each particle's force what its images in the owner's walls have part in, turned round.
// First all that the particle sees is gone through for the fit, then the images alone.
#define WITH_ACCELERATIONS 1
#define WITH_COMPRESSION 0
#define ONLY_FIT 0
#define WALL_FORCES 1
#define FIT_IN_SWEEP 1
#include "mls_sums.cl"
#include "owner_region.cl"
#include "repulsion.cl"

#if LOCAL_IMAGES
// Leaves the planes of this owner alone, and adds up what they press at.
INLINE void keep_owner(planes_t* planes, int owner) {
  for (int q = 0; q < planes->count; ++q)
    for (int k = 0; k < TILE_OWN; ++k)
      if (planes->owner[q][k] != owner) planes->share[q][k] = R(0.0);
}

// Where the particle's force acts: at its feet on the planes, by their shares.
INLINE vector_t foot_on_planes(const planes_t* planes, const neighbours_t* near, int k) {
  vector_t foot = make_vector(R(0.0), R(0.0), R(0.0));
  real shares = R(0.0);
  for (int q = 0; q < planes->count; ++q) {
    const real share = planes->share[q][k];
    if (share <= R(0.0)) continue;
    const real way = share * planes->distance[q][k];
    foot = plus(foot, make_vector(way * planes->normal_x[q][k], way * planes->normal_y[q][k], way * planes->normal_z[q][k]));
    shares += share;
  }
  const real inverse = shares > R(0.0) ? R(1.0) / shares : R(0.0);
  return make_vector(near->places.x[k] + inverse * foot.x, near->places.y[k] + inverse * foot.y, near->places.z[k] + inverse * foot.z);
}
#endif

// Per run of slots of an owner's region: Σ of pressure force, viscous force and their torques about the owner's centre.
__kernel void wall_forces(__constant const parameters_t* p, int count, __global const int* slot_start, __global const real* state, long stride, real reach,
                          WALL_ARGUMENTS, __global const real* images, __global const real* gradient, int regions, __global const int* region_values,
                          __global real* wrenches) {
  const int item = get_global_id(0);
  if (item >= count) return;
  walls_t walls = WALLS_OF_ARGUMENTS;
  const owner_run_t run = run_of_owner(p, slot_start, item, regions, region_values);
  __global const real* centre = OWNER_MOTION(wall_motions, run.owner);
  wrench_t wrench = {{R(0.0)}};
  for (int first = run.begin; first < run.end; first += TILE_OWN) {
    sweep_t a = {0};
    start_sums(&a, p, first, run.end, state, stride, reach, &walls, gradient);
#if LOCAL_IMAGES
    planes_t planes;
    start_planes(&planes);
    for (int k = 0; k < a.near.own; ++k) find_planes(&planes, p, &walls, &a.near, first + k, k, images);
    if (planes.count == 0) continue;
    a.planes = &planes;
#endif
    a.fitting = true;
    find_sums(&a, p, slot_start, images);
    fit_t fit;
    fit_of_tile(&a, p, first, &fit);
    a.fitting = false;
    derivatives_t found;
    real compressing[TILE_OWN] = {R(0.0)};
#if MLS_DIRECT
    own_t velocity[DIMENSIONS][BASIS];
    velocities_of(&a, velocity);
    divergence_of(&fit, velocity, compressing);
    for (int axis = 0; axis < 3; ++axis)
      for (int l = 0; l < BASIS; ++l) a.velocity[axis][l] = (tile)(R(0.0));
#endif
#if LOCAL_IMAGES
    keep_owner(&planes, run.owner);
    find_sums(&a, p, slot_start, images);
#elif GHOSTS
    sweep_ghosts(&a, p, slot_start, images);
#endif
    differentiate(&a, p, &fit, &found, compressing);
    for (int k = 0; k < a.near.own; ++k) {
      const int i = first + k;
      const real volume = state[FIELD_VOLUME * stride + i];
      const real mass = volume * p->density * (R(1.0) + state[FIELD_COMPRESSION * stride + i]);
      const vector_t push = make_vector(volume * found.force.x[k], volume * found.force.y[k], volume * found.force.z[k]);
      vector_t drag = make_vector(-mass * found.viscous.x[k], -mass * found.viscous.y[k], -mass * found.viscous.z[k]);
      vector_t repelled = make_vector(R(0.0), R(0.0), R(0.0));
#if LOCAL_IMAGES
      const vector_t place = foot_on_planes(&planes, &a.near, k);
      add_planes_repulsion(&repelled, p, &planes, k, mass / volume);
#else
      const vector_t place = make_vector(a.near.places.x[k], a.near.places.y[k], a.near.places.z[k]);
      add_repulsion(&repelled, p, images, place.x, place.y, place.z, mass / volume);
#endif
      drag = plus(drag, make_vector(-volume * repelled.x, -volume * repelled.y, -volume * repelled.z));
      add_to_wrench(&wrench, push, drag, make_vector(place.x - centre[0], place.y - centre[1], place.z - centre[2]));
    }
  }
  write_wrench(&wrench, item, wrenches);
}

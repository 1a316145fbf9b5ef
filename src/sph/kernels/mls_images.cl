// Images of the water in the walls about a particle, for walls by boundary integrals: one-sided least squares are right at a wall, and for that reason do not feel
// it. In the plane of each wall within the support every neighbour, and the particle itself, is mirrored, as by a ghost, but counts by χ only: what the
// wall's facets take from the geometric Shepard factor, of what its whole plane would. So a wall counts as far as it closes the support, two walls close a corner
// without images of images, and on one flat wall it is the method of ghosts. An image is never nearer than what it mirrors: all are among the candidates.
#define MOST_PLANES 6

typedef struct {
  int count;  // the most of any own particle
  real normal_x[MOST_PLANES][TILE_OWN], normal_y[MOST_PLANES][TILE_OWN], normal_z[MOST_PLANES][TILE_OWN];  // out of the water
  real distance[MOST_PLANES][TILE_OWN];                                                                   // m
  real share[MOST_PLANES][TILE_OWN];                                                                      // χ; 0: no plane
  real velocity_x[MOST_PLANES][TILE_OWN], velocity_y[MOST_PLANES][TILE_OWN], velocity_z[MOST_PLANES][TILE_OWN];  // m/s, of the wall
  real slips[MOST_PLANES][TILE_OWN];                                                                      // 1: freely
  real head[MOST_PLANES][TILE_OWN];                                                                       // (g − a)·n, m/s²
  int owner[MOST_PLANES][TILE_OWN];
} planes_t;

typedef struct {
  const walls_t* walls;
  planes_t* planes;
  int own, count;    // of the tile's particles, whose planes are looked for; how many it has
  vector_t velocity;  // of the particle
  real clearance;
} wall_sweep_t;

// What a whole plane at that distance takes from γ.
INLINE real taken_by_plane(__constant const parameters_t* p, real distance) {
  const real d = fmax(distance * p->inverse_smoothing, LEAST_HEIGHT);
  if (d >= R(2.0)) return R(0.0);
#if DIMENSIONS == 3
  return -R(6.28318530718) * (d * potential_integral(d) - QUARTER_PI_INVERSE);
#else
  return -segment_terms(d, R(-2.0), R(2.0)).shepard;
#endif
}

#define SAME_NORMAL R(0.9999)  // cosine
#define SAME_PLANE R(0.01)     // of the spacing

// The place of a plane among those of the particle; a new one if it is not yet among them. Where there is no more room it counts as that which is most like it.
INLINE int place_of_plane(wall_sweep_t* a, __constant const parameters_t* p, const contact_t* c, int owner) {
  planes_t* planes = a->planes;
  int like = 0;
  real most = R(-2.0);
  for (int q = 0; q < a->count; ++q) {
    const real cosine = c->normal.x * planes->normal_x[q][a->own] + c->normal.y * planes->normal_y[q][a->own] + c->normal.z * planes->normal_z[q][a->own];
    const real off = fabs(c->distance - planes->distance[q][a->own]);
    if (cosine > SAME_NORMAL && off < SAME_PLANE * p->spacing && planes->owner[q][a->own] == owner) return q;
    if (cosine > most) {
      most = cosine;
      like = q;
    }
  }
  return a->count < MOST_PLANES ? a->count : like;
}

INLINE void add_wall(wall_sweep_t* a, __constant const parameters_t* p, int s, real x, real y, real z) {
  const contact_t c = see_wall(p, a->walls, s, x, y, z);
  a->clearance = fmin(a->clearance, wall_clearance(p, &c));
  if (c.weight == R(0.0) || c.distance < -BEHIND_TOLERANCE * p->spacing) return;
  const int owner = (int)WALL_FIELD(a->walls, WALL_OWNER, s);
  planes_t* planes = a->planes;
  const int q = place_of_plane(a, p, &c, owner), k = a->own;
  if (q == a->count) {
    const vector_t foot = make_vector(x + c.distance * c.normal.x, y + c.distance * c.normal.y, z + c.distance * c.normal.z);
    const vector_t wall = wall_velocity(a->walls, s, c.normal, foot.x, foot.y, foot.z);
    planes->normal_x[q][k] = c.normal.x;
    planes->normal_y[q][k] = c.normal.y;
    planes->normal_z[q][k] = c.normal.z;
    planes->distance[q][k] = c.distance;
    planes->velocity_x[q][k] = wall.x;
    planes->velocity_y[q][k] = wall.y;
    planes->velocity_z[q][k] = wall.z;
    planes->slips[q][k] = !NO_SLIP || (MOTION_OF(a->walls, s))[MOTION_FRICTION] == (real)FRICTION_NONE ? R(1.0) : R(0.0);
    planes->head[q][k] = dot3(gravity_at_wall(p, a->walls, s, foot.x, foot.y, foot.z, a->velocity), c.normal);
    planes->owner[q][k] = owner;
    planes->share[q][k] = R(0.0);
    ++a->count;
  }
  planes->share[q][k] -= c.shepard;
}

// Semi-analytical wall elements ([C] B.1): triangles (2-D: segments) of about the spacing that know their corners. The singular part of Φ is
// integrated exactly, as the angle that the triangle subtends; the rest is the midpoint rule with its second-order term.

// How far the foot lies beside the edge from a to b (seen from the point), positive outside. `normal` is on the side from which the corners turn right.
INLINE real beside_edge(vector_t normal, vector_t a, vector_t b) {
  const vector_t edge = make_vector(b.x - a.x, b.y - a.y, b.z - a.z);
  const vector_t out = cross3(edge, normal);
  return -dot3(out, a) * rsqrt(dot3(out, out));
}

INLINE contact_t touch_wall(__constant const parameters_t* p, const walls_t* walls, int s, real x, real y, real z) {
  __global const real* fields = walls->fields;
  const long n = walls->wall_stride;
  const real rx = wall_way(walls, 0, fields[WALL_X * n + s], x), rz = wall_way(walls, 2, fields[WALL_Z * n + s], z);
  const real ry = DIMENSIONS == 3 ? wall_way(walls, 1, fields[WALL_Y * n + s], y) : R(0.0);
  const real r2 = rx * rx + ry * ry + rz * rz;
  contact_t c;
  c.normal = make_vector(fields[WALL_NORMAL_X * n + s], DIMENSIONS == 3 ? fields[WALL_NORMAL_Y * n + s] : R(0.0), fields[WALL_NORMAL_Z * n + s]);
  c.distance = c.normal.x * rx + c.normal.y * ry + c.normal.z * rz;
  const real area = fields[WALL_AREA * n + s];
  c.weight = kernel_value(p, sqrt(r2)) * area;
  c.moment = make_vector(rx * c.weight, ry * c.weight, rz * c.weight);

  // the corners as seen from the point, the point itself moved off the plane if it nearly lies in it
  const real least = LEAST_DISTANCE * p->spacing;
  const real d = fmax(fabs(c.distance), least);
  const real lift = d - c.distance;  // along the normal; always seen from in front, the side decides the sign
  vector_t corner[3];
  real size[3];
  const potential_t f = potential_polynomial(p, r2);
  const real inverse2 = p->inverse_smoothing * p->inverse_smoothing;
  real second = R(0.0);
  for (int k = 0; k < 3; ++k) {
    const real cx = fields[(WALL_CORNERS + 3 * k) * n + s], cz = fields[(WALL_CORNERS + 3 * k + 2) * n + s];
    const real cy = DIMENSIONS == 3 ? fields[(WALL_CORNERS + 3 * k + 1) * n + s] : R(0.0);
    corner[k] = make_vector(rx + cx + lift * c.normal.x, ry + cy + lift * c.normal.y, rz + cz + lift * c.normal.z);
    size[k] = sqrt(dot3(corner[k], corner[k]));
    const real towards = (cx * rx + cy * ry + cz * rz) * inverse2;
    second += (cx * cx + cy * cy + cz * cz) * inverse2 * f.slope + towards * towards * f.bend;
  }
#if DIMENSIONS == 3
  const real beside = fmax(fmax(beside_edge(c.normal, corner[0], corner[1]), beside_edge(c.normal, corner[1], corner[2])),
                           beside_edge(c.normal, corner[2], corner[0]));
  const real triple = dot3(corner[0], cross3(corner[1], corner[2]));
  const real below = size[0] * size[1] * size[2] + dot3(corner[0], corner[1]) * size[2] + dot3(corner[1], corner[2]) * size[0] +
                     dot3(corner[2], corner[0]) * size[1];
  const real share = R(0.0795774715459) * R(2.0) * whole_arctangent(fabs(triple), below);
  second *= R(0.0416666666667);  // ∫ ξ ξᵀ dS = S/12 Σ c cᵀ over the corners c; half of it
#else
  const vector_t along = make_vector(corner[1].x - corner[0].x, R(0.0), corner[1].z - corner[0].z);
  const real inverse_length = rsqrt(dot3(along, along));
  const real from = dot3(along, corner[0]) * inverse_length, to = dot3(along, corner[1]) * inverse_length;
  const real beside = fmax(from, -to);
  const real share = R(0.159154943092) * (arctangent(to, d) - arctangent(from, d));
  // the second and the third corner are one: they count once
  const real cx = fields[WALL_CORNERS * n + s], cz = fields[(WALL_CORNERS + 2) * n + s];
  const real towards = (cx * rx + cz * rz) * inverse2;
  second = R(0.166666666667) * ((cx * cx + cz * cz) * inverse2 * f.slope + towards * towards * f.bend);  // ∫ ξ² dS = S/3 c²; half of it
#endif
  c.beside = beside;
  c.over = beside <= BORDER * p->spacing;
#if SHEPARD_MONOLITHIC
  c.shepard = c.distance * area * whole_value(p, r2);
#else
  const real height = c.over && c.distance > -BEHIND_TOLERANCE * p->spacing ? fabs(c.distance) : c.distance;
  c.shepard = height * area * f.scale * (f.value + second) - side_of(p, c.distance, c.over) * share;
#endif
  return c;
}

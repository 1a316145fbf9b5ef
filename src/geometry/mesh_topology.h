#pragma once

#include <vector>

#include "wavetank/geometry/mesh.h"

namespace wavetank {

/// A triangle's edge, from its corner `side` to the next, by its vertices in ascending order.
struct HalfEdge {
  int low, high;
  int triangle, side;
};

/// Those of one edge behind each other, by triangle.
std::vector<HalfEdge> sorted_edges(const TriangleMesh& mesh);

/// For every triangle the triangle across each of its edges (edge k runs from corner k to corner k + 1); −1 where there is none or more
/// than one, as where a baffle stands on a floor.
using Neighbours = std::vector<Vector3i>;

Neighbours neighbours_of(const TriangleMesh& mesh);

/// Removes triangles without area. Where one has three distinct corners in a line, the triangle on its long side is split at the middle
/// one, so that a closed mesh stays closed.
void remove_degenerate_triangles(TriangleMesh& mesh);

/// Of triangles over the same three vertices, in whatever turn, keeps the first.
void remove_duplicate_triangles(TriangleMesh& mesh);

/// How often the mesh winds about the point: 1 inside a closed mesh wound outwards, 0 outside.
double winding_number(const TriangleMesh& mesh, const Vector3d& point);

}  // namespace wavetank

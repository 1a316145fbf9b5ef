#pragma once

#include <vector>

#include "wavetank/geometry/mesh.h"

namespace wavetank {

/// For every triangle the triangle across each of its edges (edge k runs from corner k to corner k + 1); −1 where there is none.
using Neighbours = std::vector<Vector3i>;

/// Throws Error where more than two triangles share an edge.
Neighbours neighbours_of(const TriangleMesh& mesh);

/// Removes triangles without area. Where one has three distinct corners in a line, the triangle on its long side is split at the middle
/// one, so that a closed mesh stays closed.
void remove_degenerate_triangles(TriangleMesh& mesh);

/// Of triangles over the same three vertices, in whatever turn, keeps the first.
void remove_duplicate_triangles(TriangleMesh& mesh);

/// How often the mesh winds about the point: 1 inside a closed mesh wound outwards, 0 outside.
double winding_number(const TriangleMesh& mesh, const Vector3d& point);

}  // namespace wavetank

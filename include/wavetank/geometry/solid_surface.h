#pragma once

#include <vector>

#include "wavetank/geometry/mesh.h"

namespace wavetank {

/// A flat piece of a mesh's surface, and how much of it bounds what the mesh encloses.
struct SurfacePiece {
  std::vector<Vector3d> corners;  ///< m, convex, anticlockwise seen from outside
  double share = 1;               ///< 1; 0 within another solid; ½ each where two of one facing lie on each other
};

/// The surface of all that a closed mesh encloses, where solids of it overlap, touch or lie in one another and the common part counts once:
/// its triangles, cut where others cross them, each with its share. What lies within a cavity, wound inwards, is outside. Pieces narrower
/// than 1e-5 of the mesh's size may be wrong. Empty where nothing overlaps or touches: the triangles themselves are that surface.
std::vector<SurfacePiece> solid_surface(const TriangleMesh& closed);

}  // namespace wavetank

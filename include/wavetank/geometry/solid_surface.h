#pragma once

#include <memory>
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

/// The surfaces of a closed mesh that hang together by edges of two triangles; none where one is not closed for itself.
std::vector<TriangleMesh> closed_surfaces(const TriangleMesh& closed);

/// Tells quickly, of many points, which are in a closed mesh. Of a point on its surface either may come out.
class SolidTest {
 public:
  explicit SolidTest(const TriangleMesh& closed);
  ~SolidTest();
  SolidTest(SolidTest&&) noexcept;
  bool holds(const Vector3d& point) const;

 private:
  class Windings;
  std::unique_ptr<Windings> windings_;
};

}  // namespace wavetank

#pragma once

#include <string>
#include <vector>

#include "wavetank/geometry/mesh.h"

namespace wavetank {

/// A convex polyhedron with everything that contacts ask of it.
struct ConvexHull {
  struct Face {
    std::vector<int> loop;               ///< corners, anticlockwise seen from outside
    Vector3d normal = Vector3d::Zero();  ///< unit, outwards
    double offset = 0;                   ///< normal · x of its plane
  };
  struct Edge {
    int from = 0, to = 0;     ///< along the loop of `left`
    int left = 0, right = 0;  ///< faces
  };

  std::vector<Vector3d> vertices;
  std::vector<Face> faces;
  std::vector<Edge> edges;
  std::vector<std::vector<int>> faces_at;  ///< of each vertex
  Vector3d centre = Vector3d::Zero();      ///< of volume
  double volume = 0;                       ///< m³

  Box bounding_box() const;
};

struct HullPrecision {
  double rounding = 0;  ///< m, by which the points may be off
  double left_out = 0;  ///< m, by which points may stick out that the hull does not take in
};

/// Of points in any order. Points within the rounding of a face, at least 1e-7 of the size, count as on it, and triangles that lie in one
/// plane within 20 times that are one face. `what` opens the message. Throws Error if they enclose next to nothing.
ConvexHull convex_hull(const std::vector<Vector3d>& points, const std::string& what, const HullPrecision& precision = {});

/// The hull with all of its faces moved inwards; its faces are not kept.
std::vector<Vector3d> shrunk(const ConvexHull& hull, double distance);

}  // namespace wavetank

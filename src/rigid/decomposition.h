#pragma once

#include <string>
#include <vector>

#include "convex_hull.h"
#include "wavetank/geometry/mesh.h"

namespace wavetank {

/// Convex parts that together come close to a closed mesh, hollows wider than a spacing kept open. `what` opens the message. Throws Error if
/// none can be found.
std::vector<ConvexHull> decompose(const TriangleMesh& mesh, double spacing, const std::string& what);

/// How parts differ from the mesh that they stand for, of the mesh's volume; found on a grid of points.
struct VolumeDifference {
  double lacking = 0;  ///< in the mesh but in no part
  double added = 0;    ///< in a part but not in the mesh
};
VolumeDifference volume_difference(const TriangleMesh& mesh, const std::vector<ConvexHull>& parts);

}  // namespace wavetank

#pragma once

#include <string>
#include <vector>

#include "convex_hull.h"
#include "wavetank/geometry/mesh.h"

namespace wavetank {

/// Convex parts that together come close to a closed mesh, hollows wider than a spacing kept open. Found by Bullet's HACD on the mesh, or
/// where that has very many triangles on a coarser one with some of its vertices. `what` opens the message. Throws Error if there are none.
std::vector<ConvexHull> decompose(const TriangleMesh& mesh, double spacing, const HullPrecision& precision, const std::string& what);

/// How parts differ from the closed mesh that they stand for, of the mesh's volume; in 2-D of its section's area.
struct VolumeDifference {
  double lacking = 0;  ///< in the mesh but in no part
  double added = 0;    ///< in a part but not in the mesh
};
/// Along a grid of lines through both, exact on each; to some 0.1 %.
VolumeDifference volume_difference(const TriangleMesh& mesh, const std::vector<ConvexHull>& parts, int dimensions);

}  // namespace wavetank

#pragma once

#include <string>
#include <vector>

#include "convex_hull.h"
#include "wavetank/geometry/mesh.h"

namespace wavetank {

/// Convex parts that together hold the same as a closed mesh, to 5 % of its volume: each of its solids is cut by planes, of very many
/// triangles on a coarser mesh with some of its vertices. `what` opens the message. Throws Error if they do not.
std::vector<ConvexHull> decompose(const TriangleMesh& mesh, double spacing, const HullPrecision& precision, const std::string& what);

/// How parts differ from the closed mesh that they stand for, of the mesh's volume; in 2-D of its section's area.
struct VolumeDifference {
  double lacking = 0;  ///< in the mesh but in no part
  double added = 0;    ///< in a part but not in the mesh
};
/// Along a grid of lines through both, exact on each; to some 0.1 %.
VolumeDifference volume_difference(const TriangleMesh& mesh, const std::vector<ConvexHull>& parts, int dimensions);

}  // namespace wavetank

#pragma once

#include <visualization_msgs/MarkerArray.h>

#include "wavetank/geometry/layout.h"
#include "wavetank/node/frames.h"

namespace wavetank {

/// The case as rviz draws it: the tank as glass with its edges, pressure probes as named spheres and wave gauges as named vertical lines in
/// the tank's frame, bodies solid, those that move in their own frames; openings as holes with a named rim, green of inlets, red of outlets
/// and violet of pressures. Begins by deleting what an earlier run drew. Stamps are 0 (draw at
/// the latest transform); sizes follow the tank's. A mesh given as package:// of a format that rviz reads stays a mesh resource, if
/// `resources` and it has no openings; everything else is sent as triangles.
visualization_msgs::MarkerArray markers(const Case& checked, const Layout& layout, const std::vector<BodyFrame>& frames,
                                        bool resources = true);

/// Ends of the edges that show a mesh's shape, two points an edge: open ones and those where it bends by more than `angle` (rad).
std::vector<Vector3d> feature_edges(const TriangleMesh& mesh, double angle);

}  // namespace wavetank

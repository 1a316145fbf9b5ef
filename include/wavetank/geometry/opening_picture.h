#pragma once

#include <vector>

#include "wavetank/geometry/mesh.h"
#include "wavetank/geometry/opening.h"

namespace wavetank {

/// Corners of an opening as a picture has them, m: in 2-D a rectangle over the width of the wall's mesh.
std::vector<Vector3d> drawn_outline(const Opening& opening, const TriangleMesh& wall);

/// The wall's mesh without what of it lies in the openings of that owner and their pockets, for pictures: the pockets have no walls there.
TriangleMesh without_openings(TriangleMesh wall, int owner, const std::vector<Opening>& openings, double spacing);

}  // namespace wavetank

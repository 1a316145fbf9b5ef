#pragma once

#include <vector>

#include "open_space.h"
#include "wall_sampling.h"
#include "wavetank/geometry/layout.h"

namespace wavetank {

/// Whose the patches are; of faces that lie on each other the first owner's first surface keeps its own.
struct WallSource {
  int owner = 0;
  int surface = 0;  ///< as WallTriangle has it
};

/// Makes wall elements of the patches' parts that the fluid can reach, with normals out of the fluid whatever way the mesh is wound. A
/// patch with fluid on both sides (a baffle) becomes two elements; one that nothing reaches (an outer skin, the floor under a box that
/// stands on it) none. Patches that another wall cuts are clipped at it, exactly where the cut is made of straight lines across the patch.
/// Areas are in m² (ribbons in 2-D as well).
std::vector<WallElement> face_walls(const std::vector<WallPatch>& patches, WallSource source, const OpenSpace& open,
                                    const TriangleGrid& grid, double spacing);

/// The same patches' wetted parts as triangles, or in 2-D as segments along their tangents.
std::vector<Facet> face_facets(const std::vector<WallPatch>& patches, WallSource source, const OpenSpace& open, const TriangleGrid& grid,
                               double spacing, int dimensions);

}  // namespace wavetank

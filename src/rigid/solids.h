#pragma once

#include <vector>

#include "wavetank/geometry/mesh.h"

namespace wavetank {

/// The solids that a closed mesh is made of, each with the cavities in it; solids may overlap or touch. One alone, the mesh itself, where
/// its connected surfaces do not close for themselves.
std::vector<TriangleMesh> solids_of(const TriangleMesh& closed);

/// The closed cavities of a closed mesh that is wound outwards, each as a solid of its own, wound outwards; a solid within a cavity is not
/// taken out of it.
std::vector<TriangleMesh> cavities_of(const TriangleMesh& closed);

/// The mesh without its cavities, and without what lies in them.
TriangleMesh filled_up(const TriangleMesh& closed);

}  // namespace wavetank

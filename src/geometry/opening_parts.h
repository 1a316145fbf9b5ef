#pragma once

#include "wavetank/geometry/mesh.h"
#include "wavetank/geometry/opening.h"

namespace wavetank {

/// Puts an opening where a named part of a mesh is: its normal into the water, and its outline in that plane with `up` as near to
/// `against_gravity` as can be. `is_body`: the water is outside of the mesh, as it is not of the tank's. Throws Error for a part that is
/// not there, not flat, not convex, or, in 2-D, that does not meet the plane y = 0.
void place_by_part(const OpeningCase& given, const TriangleMesh& mesh, bool is_body, const Vector3d& against_gravity, int dimensions,
                   double spacing, Opening& opening);

/// Unit vector within the opening's plane for its height: that given, or against gravity, or along x.
void set_axes(const std::optional<Vector3d>& given_up, const Vector3d& against_gravity, int dimensions, Opening& opening);

}  // namespace wavetank

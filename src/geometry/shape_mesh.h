#pragma once

#include <string>

#include "wavetank/geometry/mesh.h"

namespace wavetank {

/// Whether a mesh's URI is that of a parametric shape, shape://…
bool is_shape(const std::string& uri);

/// The closed mesh of a parametric shape, wound outwards, as read_mesh describes it. m. Throws Error for what is no such shape.
TriangleMesh shape_mesh(const std::string& uri);

}  // namespace wavetank

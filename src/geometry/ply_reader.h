#pragma once

#include <string>

#include "wavetank/geometry/mesh.h"

namespace wavetank {

/// By its extension or how it begins.
bool is_ply(const std::string& path);

/// The vertices and triangles of a PLY, as text or binary, its numbers in either order of bytes: of `vertex` x, y and z, of `face`
/// `vertex_indices` or `vertex_index`, of `tristrips` `vertex_indices`; what else it has is passed over. Polygons are cut into triangles.
/// Throws Error, with the line of a text, for what is no PLY, for counts that the file's length does not hold, indices of vertices that do
/// not exist, and numbers that are none.
TriangleMesh read_ply(const std::string& path);

}  // namespace wavetank

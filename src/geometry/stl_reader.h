#pragma once

#include <string>

#include "wavetank/geometry/mesh.h"

namespace wavetank {

/// Whether the file's name says that it is an STL file.
bool is_stl(const std::string& path);

/// The triangles of an STL file, three vertices of its own each: binary (with whatever header and attribute bytes) or text in any case,
/// with several solids, without or with an odd `endsolid`, after blanks or a byte-order mark. Throws Error for what is neither and for a
/// file that ends too early; of a text it names the line.
TriangleMesh read_stl(const std::string& path);

}  // namespace wavetank

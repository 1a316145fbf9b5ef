#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "wavetank/scene/case.h"
#include "wavetank/scene/file_path.h"
#include "wavetank/scene/upward.h"

namespace wavetank {

using Eigen::Vector3i;

/// Triangles that bear a name in a mesh file: of a node, of a mesh or of a material there.
struct MeshPart {
  std::string name;
  std::vector<std::array<Vector3d, 3>> triangles;  ///< corners, m; none of a part that was not asked for
};

/// Triangles over shared vertices (equal positions are one vertex). Unit: m.
struct TriangleMesh {
  std::string name;  ///< of the file or the shape, for messages
  std::vector<Vector3d> vertices;
  std::vector<Vector3i> triangles;
  std::vector<MeshPart> parts;  ///< of a file

  Vector3d corner(std::size_t triangle, int which) const { return vertices[triangles[triangle][which]]; }
  Box bounding_box() const;
  /// By the divergence theorem, positive when a closed mesh's triangles are wound outwards. m³.
  double signed_volume() const;
  /// Of a closed mesh, m; the middle of the bounding box where next to nothing is enclosed.
  Vector3d centre_of_volume() const;
};

/// Makes a parametric shape's triangles or reads a file's; scales, rotates and translates them.
/// Of a file it reads every submesh with its node transforms, merges equal vertices, drops exact duplicates. "Equal" is within 1e-6 of the
/// mesh's size, the resolution of float32 files. A Collada file's unit is applied, its up-axis is not (as in rviz): turn a y-up file by
/// rotation (π/2, 0, 0). Throws Error for a missing, unreadable, corrupt or empty file, non-finite vertices, a file without triangles, or a
/// shape that is none.
/// A shape lies about its own origin, a cylinder's axis along z: shape://box?size=X,Y,Z, shape://sphere?radius=R,
/// shape://cylinder?radius=R&length=L, of the last two also &facets=N round a circle, a multiple of 4 from 8 to 512, 24 unless given. Its
/// volume is that of the true shape, so its corners lie a little outside of that and the middles of its facets a little inside: with 24
/// facets by at most 1.5 % of a sphere's radius and 0.6 % of a cylinder's.
/// `wanted_parts`: names of those parts whose triangles are kept apart as well.
TriangleMesh read_mesh(const MeshSource& source, const std::string& case_directory, const ResourceResolver& resolve,
                       const std::vector<std::string>& wanted_parts = {});

/// The twelve triangles of a box, wound outwards; without those of the top if it is open.
TriangleMesh box_mesh(const Box& box, bool open_top, const std::string& name, const Top& top = {});

/// Checks that apply to every mesh: not all triangles degenerate (zero-area ones are removed). Any number of triangles may share an edge,
/// as where baffles stand on a tank's floor.
void check_surface(TriangleMesh& mesh);

/// For a body as well, which must enclose its volume: no edge of one triangle only, all turned outwards, none left between solids that
/// share a face, volume > 0, no part inside out. Throws Error naming the mesh and an edge, also where triangles overlap at one.
void check_closed(TriangleMesh& mesh);

/// Whether a point lies inside a closed mesh (generalised winding number > 1/2: robust at edges and vertices).
bool inside(const TriangleMesh& closed, const Vector3d& point);

/// Closest point of a triangle, which may be no more than a segment.
Vector3d nearest_on_triangle(const Vector3d& point, const Vector3d& a, const Vector3d& b, const Vector3d& c);

/// Distance from a point to the nearest triangle, m.
double distance(const TriangleMesh& mesh, const Vector3d& point);

}  // namespace wavetank

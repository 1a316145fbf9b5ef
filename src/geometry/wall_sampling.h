#pragma once

#include <optional>
#include <vector>

#include "outline.h"
#include "polygon.h"
#include "wavetank/geometry/mesh.h"

namespace wavetank {

/// A piece of a wall that becomes one element, or two where the fluid is on both sides: not yet known here.
struct WallPatch {
  std::vector<Polygon> pieces;  ///< convex, all turned the same way
  Vector3d tangent;             ///< unit, along a side
  double area_factor = 1;       ///< true area over the pieces' area: corrects the rounding of nearly flat, nearly rectangular regions
  Vector3d plane_point = Vector3d::Zero();   ///< of facets: a point of the plane ...
  Vector3d plane_normal = Vector3d::Zero();  ///< ... and its unit normal, the same for all triangles of one plane
  bool curved = false;                       ///< of a curved wall: may be joined with its neighbours if it is small
};

/// Cuts a surface into patches of about the spacing. Rectangles become regular grids of equal cells; other flat regions a square grid along
/// their longest edge, clipped to the region; facets smaller than a cell stay whole. The patches' area is the mesh's. With `within`,
/// patches outside that box may be left out: a body may reach far out of its tank.
std::vector<WallPatch> sample_mesh(const TriangleMesh& mesh, double spacing, const std::optional<Box>& within = {});

/// The same in 2-D: straight runs become equal pieces. Each piece is a ribbon as wide as the spacing across the x–z plane.
std::vector<WallPatch> sample_outline(const Outline& outline, double spacing, const std::optional<Box>& within = {});

/// The surface's own triangles, uncut.
std::vector<WallPatch> whole_facets(const TriangleMesh& mesh);

/// An outline's straight runs, uncut, as ribbons of the given width (m) across the x–z plane.
std::vector<WallPatch> whole_facets(const Outline& outline, double width);

}  // namespace wavetank

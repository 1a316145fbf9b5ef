#pragma once

#include <string>
#include <utility>
#include <vector>

#include "wavetank/geometry/mesh.h"
#include "wavetank/geometry/opening.h"

namespace wavetank {

/// A piece of wall: a square in 3-D, a segment in 2-D, that stands for `area` of the wall about `centre`.
struct WallElement {
  Vector3d centre;         ///< m
  Vector3d normal;         ///< unit, pointing out of the fluid
  Vector3d tangent;        ///< unit, in the element's plane, along a side of the rectangle (2-D: along the segment, in the x–z plane)
  double area = 0;         ///< m² in 3-D, m in 2-D
  double elongation = 1;   ///< of the rectangle of this area that it is taken for: side along the tangent over the other (3-D)
  double gap[2] = {0, 0};  ///< m, by which the wall that it stands for reaches beyond that rectangle, along the tangent and across
  int owner = 0;           ///< 0 the tank, 1 + i body i
};

/// A flat triangle of wall; in 2-D a segment, whose third corner is not used.
struct Facet {
  Vector3d corners[3];                      ///< m
  Vector3d normal = Vector3d::Zero();       ///< unit, pointing out of the fluid
  Vector3d plane_point = Vector3d::Zero();  ///< m, a point of its plane; facets of one plane share normal and point to the last bit
  int owner = 0;                            ///< 0 the tank, 1 + i body i
};

/// A rectangle as two triangles (2-D: as one segment).
std::vector<Facet> facets_of(const WallElement& element, int dimensions);

/// Rectangles that lie side by side in one plane, about `spacing` (m) wide, as few larger ones that cover the same; in an order of their
/// own.
std::vector<WallElement> joined_rectangles(const std::vector<WallElement>& elements, double spacing, int dimensions);

/// A part of a facet.
struct FacetPiece {
  int facet = 0;  ///< of Layout::facets
  Facet shape;
};

/// A section through the water, cut into cells of about a spacing, of those that water can come to.
struct FlowSection {
  Vector3d normal = Vector3d::UnitX();  ///< unit, the way that counts as positive
  std::vector<Vector3d> outline;        ///< m, corners, of a disc on its rim; in 2-D the lower and the upper end
  std::vector<Vector3d> places;         ///< m, middles of the cells
  std::vector<double> areas;            ///< m² (2-D: m), of each
};

/// A case's geometry, sampled at the particle spacing: what the solver starts from.
struct Layout {
  double spacing = 0;                ///< m
  Box domain;                        ///< bounding box of the tank's walls, m (2-D: y = 0)
  std::vector<TriangleMesh> meshes;  ///< 0 the tank, 1 + i body i; in 3-D and as given in 2-D
  std::vector<WallElement> walls;    ///< in a fixed order, the same at every start
  std::vector<Facet> facets;         ///< the walls as the meshes' own triangles, of any size
  std::vector<Facet> triangles;      ///< the walls cut into triangles of about the spacing: where it has semi-analytical elements
  std::vector<WallElement> lid;      ///< temporary, closes the fluid's free surface while it is packed
  std::vector<Vector3d> particles;   ///< centres, m
  std::vector<double> volumes;       ///< of each particle, m³ (2-D: m²)
  Vector3d up = Vector3d::UnitZ();   ///< unit; along it the water is hydrostatic at the start
  std::vector<double> levels;        ///< height along `up` of the free surface over each particle, as filled, m
  bool open_top = true;              ///< water could leave the tank over its highest point
  std::vector<bool> moving;          ///< of each owner: its walls move relative to the tank
  /// Owners of which the first one's walls may lie inside the second as they move against each other: both ways round.
  std::vector<std::pair<int, int>> intruding;
  std::vector<Vector3d> disc_normals;  ///< unit, of each pressure probe's wall where it has a disc, else zero
  std::vector<FlowSection> sections;   ///< as the case has them
  std::vector<Opening> openings;       ///< as the case has them; the water beyond them comes last among the particles
  std::size_t beyond = 0;              ///< how many particles that is
  std::vector<FacetPiece> pieces;      ///< of those facets that may lie partly in such a body: all of each, ascending
};

/// Lays a case out: reads and checks the meshes, samples the walls, fills the fluid, makes the lid.
/// Hydrostatic along gravity is water that fills its region to the walls, or whose free surface is level: from a seed, or a box with
/// gravity along an axis. Under the face of a box that is not level it is so along the axis nearest to gravity's. Walls that the fluid
/// cannot reach have no elements: a tank's outer skin, the bottom of a box that stands on the floor, and the floor under it, where elements
/// that the box covers partly are clipped at its sides. A body that moves has the outside of itself and
/// what is fixed to it, and hides nothing of other walls; where it may move into another body the facets of both have pieces, see
/// `intruding`. Throws Error for every mesh fault, for fluid outside the tank or leaking from it, for an empty fill, a spacing larger than
/// the tank, a body of a mesh ten times as large as it, a probe in a body or outside the tank, a section that no water
/// can come to, and openings that do not lie in a wall or
/// whose pockets meet what is there. Meshes of doubtful size are named. In `walls`, `facets` and `triangles` openings are holes with a
/// pocket behind each; `meshes` are whole.
Layout lay_out(const Case& checked, const ResourceResolver& resolve = {});

}  // namespace wavetank

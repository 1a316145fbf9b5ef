#pragma once

#include <vector>

#include "wavetank/geometry/mesh.h"

namespace wavetank {

/// What a surface without open edges looks like from the spaces that it parts. A shell is all of the surface that can be seen from one
/// space, as sides of triangles: a cube has two, one outside and one inside; two cubes that share a face or an edge have three, one outside
/// about both.
struct Shells {
  std::vector<int> of_side;               ///< 2 t: of the side that triangle t's normal points to, 2 t + 1: of its other side
  std::vector<int> component;             ///< of each shell; shells whose triangles share an edge are of one component
  std::vector<double> volume;             ///< of each shell, m³: what it encloses if seen from outside, less the space if seen from inside
  std::vector<double> forward, backward;  ///< of each shell, m²: the area of its sides that normals point to, and of the others
  int components = 0;
};

/// At an edge of more than two triangles neighbours are those next to each other about the edge. Of two that lie upon each other there,
/// wound against each other, the space between their front sides is taken for one, as between solids that touch. Throws Error naming mesh
/// and edge where an edge has one triangle only, and where more triangles lie upon each other or are not wound so.
Shells find_shells(const TriangleMesh& mesh);

}  // namespace wavetank

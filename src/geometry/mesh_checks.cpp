#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mesh_shells.h"
#include "mesh_topology.h"
#include "polygon.h"
#include "wavetank/common/error.h"
#include "wavetank/geometry/mesh.h"

namespace wavetank {
namespace {

void turn_over(Vector3i& triangle) { std::swap(triangle[1], triangle[2]); }

[[noreturn]] void refuse_winding(const TriangleMesh& mesh, std::size_t triangle) {
  throw Error("mesh '" + mesh.name + "' has no inside: its triangles cannot be wound consistently at the edge from " +
              describe(mesh.corner(triangle, 0)) + " to " + describe(mesh.corner(triangle, 1)));
}

/// Whether going round on the surface comes to a triangle's other side, as on a Möbius strip.
void check_two_sides(const TriangleMesh& mesh, const Shells& shells) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (shells.of_side[2 * t] == shells.of_side[2 * t + 1]) refuse_winding(mesh, t);
  }
}

/// What the shells of a mesh enclose.
struct Solids {
  std::vector<bool> solid;  ///< of each shell: the space that it is seen from is inside the body
  std::vector<int> outer;   ///< of each component: its shell that is seen from outside
};

/// Each component is solid inside its outer shell, but for spaces that its triangles all face, wound as they are on the outer shell: gaps
/// between solids.
Solids find_solids(const TriangleMesh& mesh, const Shells& shells, double size) {
  Solids solids;
  solids.outer.assign(shells.components, -1);
  const int count = static_cast<int>(shells.component.size());
  for (int s = 0; s < count; ++s) {
    int& outer = solids.outer[shells.component[s]];
    if (outer < 0 || shells.volume[s] > shells.volume[outer]) outer = s;
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const int outer = solids.outer[shells.component[shells.of_side[2 * t]]];
    if (shells.volume[outer] > 1e-12 * size * size * size) continue;
    throw Error("mesh '" + mesh.name + "' has a part without volume about " + describe(mesh.corner(t, 0)) +
                "; a body must enclose a volume");
  }
  for (int s = 0; s < count; ++s) {
    const int outer = solids.outer[shells.component[s]];
    const bool inside_out = shells.backward[outer] > shells.forward[outer];
    const double against = inside_out ? shells.forward[s] : shells.backward[s];
    solids.solid.push_back(s != outer && against > 0);
  }
  return solids;
}

/// Leaves only what parts a body from the space outside, wound outwards; returns the component of each triangle.
std::vector<int> keep_outsides(TriangleMesh& mesh, const Shells& shells, const Solids& solids) {
  std::vector<int> component;
  std::vector<Vector3i> kept;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const int front = shells.of_side[2 * t], back = shells.of_side[2 * t + 1];
    if (solids.solid[front] && solids.solid[back]) continue;  // parts two solids
    if (!solids.solid[front] && !solids.solid[back]) refuse_winding(mesh, t);
    kept.push_back(mesh.triangles[t]);
    if (solids.solid[front]) turn_over(kept.back());
    component.push_back(shells.component[front]);
  }
  mesh.triangles = std::move(kept);
  return component;
}

/// Each part as a mesh of its own.
std::vector<TriangleMesh> separate(const TriangleMesh& mesh, const std::vector<int>& part, int parts) {
  std::vector<TriangleMesh> result(parts);
  std::vector<int> index(mesh.vertices.size(), -1);  // parts share no edge; where they share a vertex, each has its own copy of it
  std::vector<int> owner(mesh.vertices.size(), -1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    TriangleMesh& piece = result[part[t]];
    Vector3i triangle;
    for (int k = 0; k < 3; ++k) {
      const int vertex = mesh.triangles[t][k];
      if (owner[vertex] != part[t]) {
        owner[vertex] = part[t];
        index[vertex] = static_cast<int>(piece.vertices.size());
        piece.vertices.push_back(mesh.vertices[vertex]);
      }
      triangle[k] = index[vertex];
    }
    piece.triangles.push_back(triangle);
  }
  return result;
}

bool encloses(const Box& outer, const Box& inner) {
  return (outer.min.array() <= inner.min.array()).all() && (outer.max.array() >= inner.max.array()).all();
}

/// Whether a part lies in another wholly; one that crosses or touches it from within is a solid of its own. By up to a hundred corners.
bool lies_in(const TriangleMesh& inner, const TriangleMesh& outer) {
  const std::size_t step = std::max<std::size_t>(1, inner.vertices.size() / 100);
  for (std::size_t v = 0; v < inner.vertices.size(); v += step)
    if (winding_number(outer, inner.vertices[v]) < 0.9) return false;
  return true;
}

/// Parts inside an odd number of others are cavities, and are turned inwards.
void turn_cavities(TriangleMesh& mesh, const std::vector<int>& part, int parts) {
  if (parts < 2) return;
  const std::vector<TriangleMesh> pieces = separate(mesh, part, parts);
  std::vector<Box> boxes;
  std::vector<bool> cavity(parts, false);
  boxes.reserve(pieces.size());
  for (const TriangleMesh& piece : pieces) boxes.push_back(piece.bounding_box());
  for (int p = 0; p < parts; ++p) {
    for (int q = 0; q < parts; ++q) {
      if (p != q && encloses(boxes[q], boxes[p]) && lies_in(pieces[p], pieces[q])) cavity[p] = !cavity[p];
    }
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (cavity[part[t]]) turn_over(mesh.triangles[t]);
  }
}

/// Where a surface crosses itself and comes out inside out, the winding number just outside of it is negative. Looks at as many triangles,
/// evenly spread, as some ten million solid angles allow: all of them up to 4 000.
void refuse_inverted_parts(const TriangleMesh& mesh, double size) {
  const std::size_t count = mesh.triangles.size();
  const std::size_t samples = std::min(count, std::max<std::size_t>(50, 16000000 / count));
  for (std::size_t s = 0; s < samples; ++s) {
    const std::size_t t = s * count / samples;
    const Polygon triangle = {mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)};
    const Vector3d outside = centroid(triangle) + 1e-6 * size * vector_area(triangle).normalized();
    if (winding_number(mesh, outside) < -0.5) {
      throw Error("mesh '" + mesh.name + "' is turned inside out about " + describe(centroid(triangle)) +
                  ": its surface crosses itself there");
    }
  }
}

}  // namespace

void check_surface(TriangleMesh& mesh) {
  if (mesh.triangles.empty()) throw Error("mesh '" + mesh.name + "' has no triangles");
  remove_degenerate_triangles(mesh);
  if (mesh.triangles.empty()) throw Error("mesh '" + mesh.name + "' has only triangles of zero area");
}

void check_closed(TriangleMesh& mesh) {
  check_surface(mesh);
  const Box box = mesh.bounding_box();
  const double size = (box.max - box.min).norm();
  if (mesh.signed_volume() < 0) std::for_each(mesh.triangles.begin(), mesh.triangles.end(), turn_over);
  const Shells shells = find_shells(mesh);
  check_two_sides(mesh, shells);
  const std::vector<int> component = keep_outsides(mesh, shells, find_solids(mesh, shells, size));
  turn_cavities(mesh, component, shells.components);
  if (mesh.signed_volume() <= 0) throw Error("mesh '" + mesh.name + "' encloses no volume: its parts cancel each other");
  refuse_inverted_parts(mesh, size);
}

}  // namespace wavetank

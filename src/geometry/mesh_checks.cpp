#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mesh_topology.h"
#include "polygon.h"
#include "wavetank/common/error.h"
#include "wavetank/geometry/mesh.h"

namespace wavetank {
namespace {

/// Whether the neighbour runs along the shared edge in the same direction as this triangle, that is, is wound the other way.
bool wound_against(const TriangleMesh& mesh, int triangle, int side, int neighbour) {
  const int from = mesh.triangles[triangle][side], to = mesh.triangles[triangle][(side + 1) % 3];
  for (int k = 0; k < 3; ++k) {
    if (mesh.triangles[neighbour][k] == from && mesh.triangles[neighbour][(k + 1) % 3] == to) return true;
  }
  return false;
}

void turn_over(Vector3i& triangle) { std::swap(triangle[1], triangle[2]); }

/// Winds each connected part consistently; returns the part of every triangle.
std::vector<int> wind_parts(TriangleMesh& mesh, int& parts) {
  Neighbours across = neighbours_of(mesh);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      if (across[t][k] < 0) {
        throw Error("mesh '" + mesh.name + "' is not closed: only one triangle has the edge from " + describe(mesh.corner(t, k)) + " to " +
                    describe(mesh.corner(t, (k + 1) % 3)) + "; a body must enclose its volume");
      }
    }
  }
  std::vector<int> part(mesh.triangles.size(), -1), queue;
  parts = 0;
  for (std::size_t first = 0; first < mesh.triangles.size(); ++first) {
    if (part[first] >= 0) continue;
    queue.assign(1, static_cast<int>(first));
    part[first] = parts;
    while (!queue.empty()) {
      const int t = queue.back();
      queue.pop_back();
      for (int k = 0; k < 3; ++k) {
        const int other = across[t][k];
        const bool against = wound_against(mesh, t, k, other);
        if (part[other] < 0) {
          part[other] = parts;
          if (against) {
            turn_over(mesh.triangles[other]);  // corners 0 2 1: edges 0-2, 2-1, 1-0
            std::swap(across[other][0], across[other][2]);
          }
          queue.push_back(other);
        } else if (against) {
          throw Error("mesh '" + mesh.name + "' has no inside: its triangles cannot be wound consistently at the edge from " +
                      describe(mesh.corner(t, k)) + " to " + describe(mesh.corner(t, (k + 1) % 3)));
        }
      }
    }
    ++parts;
  }
  return part;
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

/// Outer parts are wound outwards, cavities (parts inside an odd number of others) inwards.
void orient_parts(TriangleMesh& mesh, const std::vector<int>& part, int parts, double size) {
  std::vector<TriangleMesh> pieces = separate(mesh, part, parts);
  std::vector<Box> boxes;
  std::vector<bool> outward, cavity(parts, false);
  for (TriangleMesh& piece : pieces) {
    boxes.push_back(piece.bounding_box());
    const double volume = piece.signed_volume();
    if (std::abs(volume) <= 1e-12 * size * size * size) {
      throw Error("mesh '" + mesh.name + "' has a part without volume about " + describe(piece.corner(0, 0)) +
                  "; a body must enclose a volume");
    }
    outward.push_back(volume > 0);
    if (volume < 0) std::for_each(piece.triangles.begin(), piece.triangles.end(), turn_over);
  }
  for (int p = 0; p < parts; ++p) {
    for (int q = 0; q < parts; ++q) {
      if (p != q && encloses(boxes[q], boxes[p]) && lies_in(pieces[p], pieces[q])) cavity[p] = !cavity[p];
    }
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (outward[part[t]] == cavity[part[t]]) turn_over(mesh.triangles[t]);
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
  neighbours_of(mesh);
}

void check_closed(TriangleMesh& mesh) {
  check_surface(mesh);
  const Box box = mesh.bounding_box();
  const double size = (box.max - box.min).norm();
  int parts = 0;
  const std::vector<int> part = wind_parts(mesh, parts);
  orient_parts(mesh, part, parts, size);
  if (mesh.signed_volume() <= 0) throw Error("mesh '" + mesh.name + "' encloses no volume: its parts cancel each other");
  refuse_inverted_parts(mesh, size);
}

}  // namespace wavetank

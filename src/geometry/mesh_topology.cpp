#include "mesh_topology.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <tuple>

namespace wavetank {
namespace {

/// Twice the area is below this part of the squared longest edge: a height of 1e-9 of the length.
constexpr double flatness = 1e-9;

double longest_edge_squared(const TriangleMesh& mesh, const Vector3i& t) {
  double longest = 0;
  for (int k = 0; k < 3; ++k) longest = std::max(longest, (mesh.vertices[t[(k + 1) % 3]] - mesh.vertices[t[k]]).squaredNorm());
  return longest;
}

bool has_area(const TriangleMesh& mesh, const Vector3i& t) {
  if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return false;
  const Vector3d& a = mesh.vertices[t[0]];
  return (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).norm() > flatness * longest_edge_squared(mesh, t);
}

/// The corner of a collinear triangle that lies between the other two: the one opposite its longest edge.
int middle_corner(const TriangleMesh& mesh, const Vector3i& t) {
  int best = 0;
  double longest = -1;
  for (int k = 0; k < 3; ++k) {
    const double length = (mesh.vertices[t[(k + 2) % 3]] - mesh.vertices[t[(k + 1) % 3]]).squaredNorm();
    if (length > longest) {
      longest = length;
      best = k;
    }
  }
  return best;
}

}  // namespace

std::vector<HalfEdge> sorted_edges(const TriangleMesh& mesh) {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), t, k});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return std::tie(a.low, a.high, a.triangle, a.side) < std::tie(b.low, b.high, b.triangle, b.side);
  });
  return edges;
}

Neighbours neighbours_of(const TriangleMesh& mesh) {
  Neighbours result(mesh.triangles.size(), Vector3i(-1, -1, -1));
  const std::vector<HalfEdge> edges = sorted_edges(mesh);
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high) ++end;
    if (end - i == 2) {
      result[edges[i].triangle][edges[i].side] = edges[i + 1].triangle;
      result[edges[i + 1].triangle][edges[i + 1].side] = edges[i].triangle;
    }
    i = end;
  }
  return result;
}

void remove_degenerate_triangles(TriangleMesh& mesh) {
  std::vector<Vector3i> collinear, solid;
  for (const Vector3i& t : mesh.triangles) {
    if (has_area(mesh, t)) {
      solid.push_back(t);
    } else if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) {
      collinear.push_back(t);
    }
  }
  if (collinear.size() + solid.size() == mesh.triangles.size() && collinear.empty()) return;
  // Splitting at one collinear triangle may give another its long-side neighbour: repeat until nothing changes.
  for (bool changed = true; changed && !collinear.empty();) {
    changed = false;
    std::map<std::pair<int, int>, std::size_t> wanted;  // long edge of a collinear triangle -> which
    for (std::size_t c = 0; c < collinear.size(); ++c) {
      const int k = middle_corner(mesh, collinear[c]);
      wanted[std::minmax(collinear[c][(k + 1) % 3], collinear[c][(k + 2) % 3])] = c;
    }
    std::vector<Vector3i> split;
    std::set<std::size_t> used;
    for (const Vector3i& t : solid) {
      bool done = false;
      for (int k = 0; k < 3 && !done; ++k) {
        const auto found = wanted.find(std::minmax(t[k], t[(k + 1) % 3]));
        if (found == wanted.end() || used.count(found->second)) continue;
        const Vector3i& flat = collinear[found->second];
        const int middle = flat[middle_corner(mesh, flat)];
        if (middle == t[(k + 2) % 3]) continue;
        split.emplace_back(t[k], middle, t[(k + 2) % 3]);
        split.emplace_back(middle, t[(k + 1) % 3], t[(k + 2) % 3]);
        used.insert(found->second);
        done = changed = true;
      }
      if (!done) split.push_back(t);
    }
    solid = std::move(split);
    std::vector<Vector3i> left;
    for (std::size_t c = 0; c < collinear.size(); ++c) {
      if (!used.count(c)) left.push_back(collinear[c]);
    }
    collinear = std::move(left);
  }
  mesh.triangles = std::move(solid);
}

void remove_duplicate_triangles(TriangleMesh& mesh) {
  std::vector<std::pair<std::array<int, 3>, std::size_t>> keys;
  keys.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<int, 3> key = {mesh.triangles[t][0], mesh.triangles[t][1], mesh.triangles[t][2]};
    std::sort(key.begin(), key.end());
    keys.emplace_back(key, t);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<char> keep(mesh.triangles.size(), 1);
  for (std::size_t k = 1; k < keys.size(); ++k) {
    if (keys[k].first == keys[k - 1].first) keep[keys[k].second] = 0;
  }
  std::size_t count = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (keep[t]) mesh.triangles[count++] = mesh.triangles[t];
  }
  mesh.triangles.resize(count);
}

}  // namespace wavetank

#include "solids.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace wavetank {
namespace {

/// The surfaces that hang together by edges of two triangles; empty where one is not closed.
std::vector<TriangleMesh> surfaces_of(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, std::vector<int>> at_edge;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) at_edge[std::minmax(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3])].push_back(static_cast<int>(t));
  std::vector<int> root(mesh.triangles.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int t) {
    while (root[t] != t) t = root[t] = root[root[t]];
    return t;
  };
  for (const auto& [edge, around] : at_edge)
    if (around.size() == 2) root[find(around[0])] = find(around[1]);
  std::map<int, TriangleMesh> by_root;
  std::map<int, std::map<std::pair<int, int>, int>> balance;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const int own = find(static_cast<int>(t));
    by_root[own].triangles.push_back(mesh.triangles[t]);
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      balance[own][std::minmax(a, b)] += a < b ? 1 : -1;
    }
  }
  std::vector<TriangleMesh> surfaces;
  for (auto& [own, surface] : by_root) {
    for (const auto& [edge, count] : balance[own])
      if (count != 0) return {};
    std::map<int, int> index;  // only the vertices that it has
    surface.name = mesh.name;
    for (Vector3i& triangle : surface.triangles)
      for (int k = 0; k < 3; ++k) {
        const auto [entry, is_new] = index.emplace(triangle[k], static_cast<int>(surface.vertices.size()));
        if (is_new) surface.vertices.push_back(mesh.vertices[triangle[k]]);
        triangle[k] = entry->second;
      }
    surfaces.push_back(std::move(surface));
  }
  return surfaces;
}

void append(const TriangleMesh& from, TriangleMesh& to) {
  const int first = static_cast<int>(to.vertices.size());
  to.vertices.insert(to.vertices.end(), from.vertices.begin(), from.vertices.end());
  for (const Vector3i& triangle : from.triangles) to.triangles.push_back(triangle + Vector3i::Constant(first));
}

void turn_over(TriangleMesh& mesh) {
  for (Vector3i& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
}

bool holds(const TriangleMesh& outer, const TriangleMesh& inner) {
  const Box out = outer.bounding_box(), in = inner.bounding_box();
  return (out.min.array() <= in.min.array()).all() && (out.max.array() >= in.max.array()).all() && inside(outer, inner.vertices.front());
}

}  // namespace

std::vector<TriangleMesh> solids_of(const TriangleMesh& closed) {
  const std::vector<TriangleMesh> surfaces = surfaces_of(closed);
  std::vector<TriangleMesh> solids, shells;
  for (const TriangleMesh& surface : surfaces)
    if (surface.signed_volume() > 0) solids.push_back(surface);
  shells = solids;
  for (const TriangleMesh& surface : surfaces) {
    if (surface.signed_volume() > 0) continue;
    int around = -1;  // the smallest solid that the cavity is in
    for (std::size_t s = 0; s < shells.size(); ++s)
      if (holds(shells[s], surface) && (around < 0 || shells[s].signed_volume() < shells[around].signed_volume()))
        around = static_cast<int>(s);
    if (around < 0) return {closed};
    append(surface, solids[around]);
  }
  return solids.empty() ? std::vector<TriangleMesh>{closed} : solids;
}

std::vector<TriangleMesh> cavities_of(const TriangleMesh& closed) {
  std::vector<TriangleMesh> cavities;
  for (TriangleMesh& surface : surfaces_of(closed)) {
    if (surface.signed_volume() >= 0) continue;
    turn_over(surface);
    cavities.push_back(std::move(surface));
  }
  return cavities;
}

TriangleMesh filled_up(const TriangleMesh& closed) {
  const std::vector<TriangleMesh> cavities = cavities_of(closed);
  if (cavities.empty()) return closed;
  TriangleMesh result;
  result.name = closed.name;
  for (const TriangleMesh& surface : surfaces_of(closed)) {
    const auto has = [&](const TriangleMesh& cavity) { return holds(cavity, surface); };
    if (surface.signed_volume() > 0 && std::none_of(cavities.begin(), cavities.end(), has)) append(surface, result);
  }
  return result;
}

}  // namespace wavetank

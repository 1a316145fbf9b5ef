#include "solids.h"

#include <algorithm>
#include <utility>

#include "wavetank/geometry/solid_surface.h"

namespace wavetank {
namespace {

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
  const std::vector<TriangleMesh> surfaces = closed_surfaces(closed);
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
  for (TriangleMesh& surface : closed_surfaces(closed)) {
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
  for (const TriangleMesh& surface : closed_surfaces(closed)) {
    const auto has = [&](const TriangleMesh& cavity) { return holds(cavity, surface); };
    if (surface.signed_volume() > 0 && std::none_of(cavities.begin(), cavities.end(), has)) append(surface, result);
  }
  return result;
}

}  // namespace wavetank

#include "decomposition.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>

#include "convex_cutting.h"
#include "number_text.h"
#include "section.h"
#include "solids.h"
#include "wavetank/common/error.h"

namespace wavetank {
namespace {

constexpr std::size_t many_triangles = 2000;  // more take seconds to cut
constexpr double greatest_difference = 0.05;  // of the volume, lacking or added

/// The mesh with the vertices of each cell of a grid taken together in one of them. It stays closed.
TriangleMesh coarsened(const TriangleMesh& mesh, double cell) {
  std::map<std::array<long, 3>, int> vertex_in;
  std::vector<int> kept(mesh.vertices.size());
  TriangleMesh coarse;
  coarse.name = mesh.name;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    std::array<long, 3> key;
    for (int axis = 0; axis < 3; ++axis) key[axis] = std::lround(mesh.vertices[v][axis] / cell);
    const auto [entry, is_new] = vertex_in.emplace(key, static_cast<int>(coarse.vertices.size()));
    if (is_new) coarse.vertices.push_back(mesh.vertices[v]);
    kept[v] = entry->second;
  }
  std::map<std::array<int, 3>, Vector3i> left;  // what lies on its own back cancels
  for (const Vector3i& triangle : mesh.triangles) {
    const Vector3i corners(kept[triangle[0]], kept[triangle[1]], kept[triangle[2]]);
    std::array<int, 3> sorted{corners[0], corners[1], corners[2]};
    std::sort(sorted.begin(), sorted.end());
    if (sorted[0] == sorted[1] || sorted[1] == sorted[2]) continue;
    const auto [entry, is_new] = left.emplace(sorted, corners);
    if (!is_new) left.erase(entry);
  }
  for (const auto& [sorted, corners] : left) coarse.triangles.push_back(corners);
  return coarse;
}

/// Stretches of a line, in order and apart.
using Stretches = std::vector<std::pair<double, double>>;

Stretches united(Stretches stretches) {
  std::sort(stretches.begin(), stretches.end());
  Stretches result;
  for (const auto& stretch : stretches) {
    if (result.empty() || stretch.first > result.back().second)
      result.push_back(stretch);
    else
      result.back().second = std::max(result.back().second, stretch.second);
  }
  return result;
}

double length(const Stretches& stretches) {
  double sum = 0;
  for (const auto& stretch : stretches) sum += stretch.second - stretch.first;
  return sum;
}

double common_length(const Stretches& a, const Stretches& b) {
  double sum = 0;
  for (const auto& one : a)
    for (const auto& other : b) sum += std::max(0.0, std::min(one.second, other.second) - std::max(one.first, other.first));
  return sum;
}

/// Where the upright line through (x, y) is in the mesh.
Stretches within(const TriangleMesh& mesh, double x, double y) {
  std::vector<std::pair<double, int>> crossings;  // z, and +1 where the line goes in
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vector3d a = mesh.corner(t, 0), b = mesh.corner(t, 1), c = mesh.corner(t, 2);
    const auto side = [&](const Vector3d& p, const Vector3d& q) { return (q.x() - p.x()) * (y - p.y()) - (q.y() - p.y()) * (x - p.x()); };
    const double u = side(b, c), v = side(c, a), w = side(a, b);
    if (!((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0)) || u + v + w == 0) continue;
    crossings.emplace_back((u * a.z() + v * b.z() + w * c.z()) / (u + v + w), u + v + w < 0 ? 1 : -1);
  }
  std::sort(crossings.begin(), crossings.end());
  Stretches stretches;
  int depth = 0;
  for (std::size_t k = 0; k + 1 < crossings.size(); ++k) {
    depth += crossings[k].second;
    if (depth > 0) stretches.emplace_back(crossings[k].first, crossings[k + 1].first);
  }
  return united(stretches);
}

Stretches within(const std::vector<ConvexHull>& parts, double x, double y) {
  Stretches stretches;
  for (const ConvexHull& part : parts) {
    double low = -1e300, high = 1e300;
    for (const ConvexHull::Face& face : part.faces) {
      const double rest = face.offset - face.normal.x() * x - face.normal.y() * y, slope = face.normal.z();
      if (slope > 1e-12) high = std::min(high, rest / slope);
      if (slope < -1e-12) low = std::max(low, rest / slope);
      if (std::abs(slope) <= 1e-12 && rest < 0) high = low;  // beside it
    }
    if (low < high) stretches.emplace_back(low, high);
  }
  return united(stretches);
}

}  // namespace

std::vector<ConvexHull> decompose(const TriangleMesh& mesh, double spacing, const HullPrecision& precision, const std::string& what) {
  std::vector<ConvexHull> parts;
  for (const TriangleMesh& solid : solids_of(mesh)) {
    TriangleMesh coarse = solid;
    for (double cell = 0.1 * spacing; coarse.triangles.size() > many_triangles; cell *= 1.25) coarse = coarsened(solid, cell);
    std::vector<ConvexHull> own = convex_parts(coarse, precision, what);
    std::move(own.begin(), own.end(), std::back_inserter(parts));
  }
  const VolumeDifference difference = volume_difference(mesh, parts, 3);
  if (parts.empty() || difference.lacking > greatest_difference || difference.added > greatest_difference)
    throw Error(what + " falls into no convex parts that hold the same within " + number_text(100 * greatest_difference) +
                " % (they lack " + number_text(100 * difference.lacking) + " % of its volume and hold " +
                number_text(100 * difference.added) +
                " % more); list convex parts for contacts (collision: parts, collision_parts), or choose collision: convex_hull");
  return parts;
}

VolumeDifference volume_difference(const TriangleMesh& mesh, const std::vector<ConvexHull>& parts, int dimensions) {
  Box box = mesh.bounding_box();
  for (const ConvexHull& part : parts) {
    const Box own = part.bounding_box();
    box.min = box.min.cwiseMin(own.min);
    box.max = box.max.cwiseMax(own.max);
  }
  double held = 0, lacking = 0, added = 0;
  const auto compare = [&](const Stretches& in_mesh, const Stretches& in_parts) {
    const double common = common_length(in_mesh, in_parts);
    held += length(in_mesh);
    lacking += length(in_mesh) - common;
    added += length(in_parts) - common;
  };
  // A little off the middle of its cell, so that lines do not run along faces and edges that lie there.
  const int lines = dimensions == 2 ? 1024 : 64;  // along each axis
  const Vector3d step = (box.max - box.min) / lines;
  std::vector<double> abscissae;
  abscissae.reserve(lines);
  for (int i = 0; i < lines; ++i) abscissae.push_back(box.min.x() + (i + 0.5003) * step.x());
  if (dimensions == 2) {
    const std::vector<Stretches> in_mesh = section_along(mesh, abscissae);
    for (int i = 0; i < lines; ++i) compare(in_mesh[i], within(parts, abscissae[i], 0));
  } else {
    for (const double x : abscissae)
      for (int j = 0; j < lines; ++j) {
        const double y = box.min.y() + (j + 0.4997) * step.y();
        compare(within(mesh, x, y), within(parts, x, y));
      }
  }
  const double whole = std::max(held, 1e-300);
  const auto fraction = [&](double part) { return part > 1e-9 * whole ? part / whole : 0.0; };
  return {fraction(lacking), fraction(added)};
}

}  // namespace wavetank

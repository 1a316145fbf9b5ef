#include "section.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "wavetank/common/error.h"

namespace wavetank {
namespace {

constexpr double merge_excess = 1e-3;  // of their area: what the hull of bands taken together may hold more than they do

struct Segment {
  Vector3d left, right;  ///< by x
  bool top = false;      ///< the mesh is below it
  double z(double x) const { return left.z() + (right.z() - left.z()) * (x - left.x()) / (right.x() - left.x()); }
};

/// Where the plane cuts; corners in the plane count to one side of it.
std::vector<Segment> cut(const TriangleMesh& mesh, bool plane_is_above) {
  const auto above = [&](int v) { return plane_is_above ? mesh.vertices[v].y() >= 0 : mesh.vertices[v].y() > 0; };
  const auto crossing = [&](int u, int v) {
    if (u > v) std::swap(u, v);  // so that both triangles of an edge find the same point, to the last bit
    const Vector3d &a = mesh.vertices[u], &b = mesh.vertices[v];
    Vector3d point = a + a.y() / (a.y() - b.y()) * (b - a);
    point.y() = 0;
    return point;
  };
  std::vector<Segment> segments;
  for (const Vector3i& triangle : mesh.triangles) {
    std::vector<Vector3d> ends;
    for (int k = 0; k < 3; ++k)
      if (above(triangle[k]) != above(triangle[(k + 1) % 3])) ends.push_back(crossing(triangle[k], triangle[(k + 1) % 3]));
    if (ends.size() != 2 || ends[0] == ends[1]) continue;
    if (ends[0].x() > ends[1].x()) std::swap(ends[0], ends[1]);
    const Vector3d &a = mesh.vertices[triangle[0]], &b = mesh.vertices[triangle[1]], &c = mesh.vertices[triangle[2]];
    segments.push_back({ends[0], ends[1], (b - a).cross(c - a).z() > 0});
  }
  return segments;
}

std::vector<Segment> section(const TriangleMesh& mesh) {
  std::vector<Segment> segments = cut(mesh, true);
  if (segments.empty()) segments = cut(mesh, false);  // the mesh only touches the plane from above
  if (segments.empty()) throw Error("mesh '" + mesh.name + "' has no section with the plane y = 0 of a two-dimensional case");
  return segments;
}

double area_of(const std::vector<Vector3d>& polygon) {
  double area = 0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vector3d &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    area += 0.5 * (a.x() * b.z() - b.x() * a.z());
  }
  return area;
}

/// Convex hull in the plane, anticlockwise as x goes right and z up (the monotone chain).
std::vector<Vector3d> plane_hull(std::vector<Vector3d> points) {
  std::sort(points.begin(), points.end(),
            [](const Vector3d& a, const Vector3d& b) { return a.x() < b.x() || (a.x() == b.x() && a.z() < b.z()); });
  std::vector<Vector3d> hull;
  const auto turns_right = [&](const Vector3d& point) {
    const Vector3d &a = hull[hull.size() - 2], &b = hull.back();
    return (b.x() - a.x()) * (point.z() - a.z()) - (b.z() - a.z()) * (point.x() - a.x()) <= 0;
  };
  for (int half = 0; half < 2; ++half) {
    const std::size_t start = hull.size();
    for (const Vector3d& point : points) {
      while (hull.size() >= start + 2 && turns_right(point)) hull.pop_back();
      hull.push_back(point);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

/// Where a line upwards is in the section, given what it crosses: pairs of what it goes in and out by. Solids that overlap count once.
std::vector<std::pair<const Segment*, const Segment*>> within(std::vector<const Segment*> crossed, double x, const std::string& name) {
  std::stable_sort(crossed.begin(), crossed.end(), [&](const Segment* a, const Segment* b) { return a->z(x) < b->z(x); });
  std::vector<std::pair<const Segment*, const Segment*>> result;
  int depth = 0;
  for (const Segment* segment : crossed) {
    depth += segment->top ? -1 : 1;
    if (depth == 1 && !segment->top) result.emplace_back(segment, nullptr);
    if (depth == 0 && segment->top && !result.empty()) result.back().second = segment;
  }
  if (depth != 0) throw Error("the section of mesh '" + name + "' with the plane y = 0 is not made of closed lines");
  result.erase(std::remove_if(result.begin(), result.end(), [](const auto& pair) { return pair.second == nullptr; }), result.end());
  return result;
}

/// Where the segments begin, end and cross.
std::vector<double> abscissae_of(const std::vector<Segment>& segments) {
  std::vector<double> places;
  for (const Segment& segment : segments) {
    places.push_back(segment.left.x());
    places.push_back(segment.right.x());
  }
  for (std::size_t s = 0; s < segments.size(); ++s)
    for (std::size_t t = s + 1; t < segments.size(); ++t) {
      const double from = std::max(segments[s].left.x(), segments[t].left.x()), to = std::min(segments[s].right.x(), segments[t].right.x());
      if (!(from < to)) continue;
      const double before = segments[s].z(from) - segments[t].z(from), after = segments[s].z(to) - segments[t].z(to);
      if (before * after < 0) places.push_back(from + before / (before - after) * (to - from));
    }
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  return places;
}

}  // namespace

std::vector<Vector3d> section_points(const TriangleMesh& mesh) {
  std::vector<Vector3d> points;
  for (const Segment& segment : section(mesh)) {
    points.push_back(segment.left);
    points.push_back(segment.right);
  }
  return plane_hull(points);
}

std::vector<std::vector<Vector3d>> section_bands(const TriangleMesh& mesh) {
  const std::vector<Segment> segments = section(mesh);
  const std::vector<double> places = abscissae_of(segments);
  std::vector<std::vector<Vector3d>> all;
  for (std::size_t k = 0; k + 1 < places.size(); ++k) {
    const double from = places[k], to = places[k + 1];
    std::vector<const Segment*> crossed;
    for (const Segment& segment : segments)
      if (segment.left.x() <= from && segment.right.x() >= to) crossed.push_back(&segment);
    for (const auto& [low, high] : within(crossed, 0.5 * (from + to), mesh.name))
      all.push_back({{from, 0, low->z(from)}, {to, 0, low->z(to)}, {to, 0, high->z(to)}, {from, 0, high->z(from)}});
  }
  return all;
}

std::vector<std::vector<Vector3d>> convex_polygons(const TriangleMesh& mesh) {
  const std::vector<std::vector<Vector3d>> all = section_bands(mesh);
  double whole = 0;
  for (const std::vector<Vector3d>& band : all) whole += area_of(band);
  std::vector<std::vector<Vector3d>> merged;
  std::vector<double> own_areas;  // of the bands in each, so that what many merges add is bounded, not what each of them does
  for (const std::vector<Vector3d>& band : all) {
    const double area = area_of(band);
    if (area <= 1e-9 * whole) continue;
    bool taken = false;
    for (std::size_t m = 0; m < merged.size() && !taken; ++m) {
      std::vector<Vector3d> both = merged[m];
      both.insert(both.end(), band.begin(), band.end());
      both = plane_hull(both);
      const double own_area = own_areas[m] + area;
      taken = area_of(both) - own_area <= merge_excess * own_area;
      if (!taken) continue;
      merged[m] = both;
      own_areas[m] = own_area;
    }
    if (taken) continue;
    merged.push_back(plane_hull(band));
    own_areas.push_back(area);
  }
  return merged;
}

std::vector<std::vector<std::pair<double, double>>> section_along(const TriangleMesh& mesh, const std::vector<double>& abscissae) {
  const std::vector<Segment> segments = section(mesh);
  std::vector<std::vector<std::pair<double, double>>> lines;
  for (const double x : abscissae) {
    std::vector<const Segment*> crossed;
    for (const Segment& segment : segments)
      if (segment.left.x() <= x && segment.right.x() > x) crossed.push_back(&segment);
    lines.emplace_back();
    for (const auto& [low, high] : within(crossed, x, mesh.name)) lines.back().emplace_back(low->z(x), high->z(x));
  }
  return lines;
}

}  // namespace wavetank

#include "section.h"

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
    segments.push_back({ends[0], ends[1]});
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

/// Between two abscissae the section is bands, each from one segment up to the next.
std::vector<std::vector<Vector3d>> bands(const std::vector<Segment>& segments, double from, double to, const std::string& name) {
  const double middle = 0.5 * (from + to);
  std::vector<Segment> across;
  for (const Segment& segment : segments)
    if (segment.left.x() <= from && segment.right.x() >= to) across.push_back(segment);
  std::sort(across.begin(), across.end(), [&](const Segment& a, const Segment& b) { return a.z(middle) < b.z(middle); });
  if (across.size() % 2 != 0) throw Error("the section of mesh '" + name + "' with the plane y = 0 is not made of closed lines");
  std::vector<std::vector<Vector3d>> result;
  for (std::size_t k = 0; k + 1 < across.size(); k += 2) {
    const Segment &low = across[k], &high = across[k + 1];
    result.push_back({{from, 0, low.z(from)}, {to, 0, low.z(to)}, {to, 0, high.z(to)}, {from, 0, high.z(from)}});
  }
  return result;
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

std::vector<std::vector<Vector3d>> convex_polygons(const TriangleMesh& mesh) {
  const std::vector<Segment> segments = section(mesh);
  std::vector<double> places;
  for (const Segment& segment : segments) {
    places.push_back(segment.left.x());
    places.push_back(segment.right.x());
  }
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  double whole = 0;
  std::vector<std::vector<Vector3d>> all;
  for (std::size_t k = 0; k + 1 < places.size(); ++k) {
    for (const std::vector<Vector3d>& band : bands(segments, places[k], places[k + 1], mesh.name)) {
      all.push_back(band);
      whole += area_of(band);
    }
  }
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
    std::vector<double> crossings;
    for (const Segment& segment : segments)
      if (segment.left.x() <= x && segment.right.x() > x) crossings.push_back(segment.z(x));
    std::sort(crossings.begin(), crossings.end());
    lines.emplace_back();
    for (std::size_t k = 0; k + 1 < crossings.size(); k += 2) lines.back().emplace_back(crossings[k], crossings[k + 1]);
  }
  return lines;
}

}  // namespace wavetank

#include "polygon.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "wavetank/geometry/mesh.h"

namespace wavetank {
namespace {

/// Whether `point`, no corner of it, lies in the triangle, seen along `normal`, or outside by less than a margin (in units of the normal
/// times an area).
bool covers(const Vector3d& normal, const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& point, double margin) {
  if (point == a || point == b || point == c) return false;
  return normal.dot((b - a).cross(point - a)) > -margin && normal.dot((c - b).cross(point - b)) > -margin &&
         normal.dot((a - c).cross(point - c)) > -margin;
}

}  // namespace

Vector3d vector_area(const Polygon& polygon) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t k = 2; k < polygon.size(); ++k) sum += (polygon[k - 1] - polygon[0]).cross(polygon[k] - polygon[0]);
  return 0.5 * sum;
}

Vector3d centroid(const Polygon& polygon) {
  const Vector3d direction = vector_area(polygon).normalized();
  double area = 0;
  Vector3d moment = Vector3d::Zero(), mean = Vector3d::Zero();
  for (std::size_t k = 0; k < polygon.size(); ++k) mean += (polygon[k] - polygon[0]) / static_cast<double>(polygon.size());
  for (std::size_t k = 2; k < polygon.size(); ++k) {
    const Vector3d p = polygon[k - 1] - polygon[0], q = polygon[k] - polygon[0];
    const double part = 0.5 * direction.dot(p.cross(q));
    area += part;
    moment += part / 3.0 * (p + q);
  }
  return polygon[0] + (area > 0 ? Vector3d(moment / area) : mean);
}

Polygon part_below(const Polygon& polygon, const Vector3d& normal, double offset, double tolerance) {
  const std::size_t count = polygon.size();
  std::vector<double> height(count);
  bool any_below = false, any_above = false;
  for (std::size_t k = 0; k < count; ++k) {
    height[k] = normal.dot(polygon[k]) - offset;
    if (std::abs(height[k]) <= tolerance) height[k] = 0;
    any_below = any_below || height[k] < 0;
    any_above = any_above || height[k] > 0;
  }
  if (!any_below) return {};
  if (!any_above) return polygon;
  Polygon part;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t next = (k + 1) % count;
    if (height[k] <= 0) part.push_back(polygon[k]);
    if (height[k] * height[next] < 0) part.push_back(polygon[k] + height[k] / (height[k] - height[next]) * (polygon[next] - polygon[k]));
  }
  return part;
}

std::vector<Eigen::Vector3i> triangulate(const std::vector<Vector3d>& corners, std::uint64_t* budget) {
  const Vector3d normal = vector_area(corners);  // of a polygon that is not convex too: the parts outside cancel
  std::vector<int> left(corners.size());
  for (std::size_t k = 0; k < left.size(); ++k) left[k] = static_cast<int>(k);
  std::vector<Eigen::Vector3i> triangles;
  std::uint64_t comparisons = 0;
  const auto is_ear = [&](std::size_t k, double margin) {
    const std::size_t count = left.size();
    const Vector3d &a = corners[left[(k + count - 1) % count]], &b = corners[left[k]], &c = corners[left[(k + 1) % count]];
    ++comparisons;
    if (normal.dot((b - a).cross(c - b)) <= 0) return false;
    return std::none_of(left.begin(), left.end(), [&](int other) {
      ++comparisons;
      return covers(normal, a, b, c, corners[other], margin);
    });
  };
  while (left.size() > 3) {
    // a corner on the ear's open side would leave a polygon that touches itself there, and triangles that lie on each other
    std::size_t ear = left.size();
    for (const double margin : {1e-6 * normal.squaredNorm(), 0.0})
      for (std::size_t k = 0; k < left.size() && ear == left.size(); ++k) {
        if (is_ear(k, margin)) ear = k;
        if (budget == nullptr || comparisons < *budget) continue;
        *budget = 0;
        return {};
      }
    if (ear == left.size()) ear = 1;  // no ear in a degenerate polygon: what comes of it has no area
    const std::size_t count = left.size();
    triangles.emplace_back(left[(ear + count - 1) % count], left[ear], left[(ear + 1) % count]);
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  if (left.size() == 3) triangles.emplace_back(left[0], left[1], left[2]);
  if (budget != nullptr) *budget -= comparisons;
  return triangles;
}

Vector3d nearest_on_triangle(const Vector3d& point, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d normal = (b - a).cross(c - a);
  const Vector3d* corner[3] = {&a, &b, &c};
  bool over_face = normal.squaredNorm() > 0;
  for (int k = 0; k < 3 && over_face; ++k) {
    const Vector3d edge = *corner[(k + 1) % 3] - *corner[k];
    over_face = normal.dot(edge.cross(point - *corner[k])) >= 0;
  }
  if (over_face) return point - normal.dot(point - a) / normal.squaredNorm() * normal;
  Vector3d best = a;
  double least = (point - a).squaredNorm();
  for (int k = 0; k < 3; ++k) {
    const Vector3d edge = *corner[(k + 1) % 3] - *corner[k];
    const double length2 = edge.squaredNorm();
    const double t = length2 > 0 ? std::clamp(edge.dot(point - *corner[k]) / length2, 0.0, 1.0) : 0.0;
    const Vector3d foot = *corner[k] + t * edge;
    const double distance2 = (point - foot).squaredNorm();
    if (distance2 < least) {
      least = distance2;
      best = foot;
    }
  }
  return best;
}

std::string describe(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", std::abs(value) < 1e-12 ? 0.0 : value);
  return text;
}

std::string describe(const Vector3d& point) {
  return "(" + describe(point.x()) + ", " + describe(point.y()) + ", " + describe(point.z()) + ")";
}

int cells_in(double length, double cell) { return std::max(1, static_cast<int>(std::floor(length / cell + 0.5 + 1e-6))); }

}  // namespace wavetank

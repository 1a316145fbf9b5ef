#include "opening_parts.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh_topology.h"
#include "polygon.h"
#include "wavetank/common/error.h"

namespace wavetank {
namespace {

constexpr double flat_enough = 1e-3;  // of the spacing: corners nearer to a plane are in it

const MeshPart& part_of(const OpeningCase& given, const TriangleMesh& mesh) {
  std::string names;
  for (const MeshPart& part : mesh.parts) {
    if (part.name == given.part) return part;
    names += (names.empty() ? "" : ", ") + part.name;
  }
  throw Error("opening '" + given.name + "' is to be part '" + given.part + "' of mesh '" + mesh.name + "', which has " +
              (names.empty() ? "no named parts; give centre, normal and size" : "the parts " + names));
}

/// Whatever the triangles' turn.
Vector3d normal_of(const MeshPart& part) {
  Vector3d sum = Vector3d::Zero();
  for (const auto& [a, b, c] : part.triangles) {
    const Vector3d area = (b - a).cross(c - a);
    sum += sum.dot(area) < 0 ? Vector3d(-area) : area;
  }
  return sum.normalized();
}

/// Points in a plane, by their coordinates in it; anticlockwise, without those on a side (Andrew's monotone chain).
std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points) {
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y()); });
  const auto turns_left = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
    const Eigen::Vector2d u = b - a, v = c - a;
    return u.x() * v.y() - u.y() * v.x() > 1e-9 * u.norm() * v.norm();
  };
  std::vector<Eigen::Vector2d> hull;
  for (int way = 0; way < 2; ++way) {
    const std::size_t first = hull.size();
    for (const Eigen::Vector2d& point : points) {
      while (hull.size() >= first + 2 && !turns_left(hull[hull.size() - 2], hull.back(), point)) hull.pop_back();
      hull.push_back(point);
    }
    hull.pop_back();  // begins the way back
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

void set_outline_3d(const OpeningCase& given, const MeshPart& part, const Vector3d& origin, double spacing, Opening& opening) {
  std::vector<Eigen::Vector2d> points;
  double area = 0;
  for (const auto& triangle : part.triangles) {
    area += 0.5 * (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).norm();
    for (const Vector3d& corner : triangle) points.emplace_back((corner - origin).dot(opening.across), (corner - origin).dot(opening.up));
  }
  const std::vector<Eigen::Vector2d> hull = convex_hull(points);
  Eigen::Vector2d low = hull.front(), high = hull.front();
  for (const Eigen::Vector2d& point : hull) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  opening.width = high.x() - low.x();
  opening.height = high.y() - low.y();
  opening.centre = origin + 0.5 * (low.x() + high.x()) * opening.across + 0.5 * (low.y() + high.y()) * opening.up;
  for (const Eigen::Vector2d& point : hull) opening.outline.push_back(origin + point.x() * opening.across + point.y() * opening.up);
  const double whole = vector_area(opening.outline).norm();
  const bool fills = std::abs(whole - opening.width * opening.height) < flat_enough * spacing * (opening.width + opening.height);
  opening.shape = fills ? Opening::Shape::rectangle : Opening::Shape::polygon;
  if (std::abs(area - whole) > 1e-3 * whole)
    throw Error("opening '" + given.name + "': part '" + given.part + "' fills " + describe(area) + " m² of the " + describe(whole) +
                " m² that its convex outline encloses; it must be convex and without holes or overlaps");
}

void set_outline_2d(const OpeningCase& given, const MeshPart& part, const Vector3d& origin, Opening& opening) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const auto& triangle : part.triangles)
    for (int k = 0; k < 3; ++k) {
      const Vector3d &a = triangle[k], &b = triangle[(k + 1) % 3];
      if (a.y() * b.y() > 0 || a.y() == b.y()) continue;
      const double at = (a + a.y() / (a.y() - b.y()) * (b - a) - origin).dot(opening.up);
      low = std::min(low, at);
      high = std::max(high, at);
    }
  if (!(high > low))
    throw Error("opening '" + given.name + "': part '" + given.part + "' does not meet the plane y = 0 of a 2-D case along a line");
  opening.width = 0;
  opening.height = high - low;
  opening.centre = origin + 0.5 * (low + high) * opening.up;
  opening.outline = {origin + low * opening.up, origin + high * opening.up};
}

}  // namespace

void set_axes(const std::optional<Vector3d>& given_up, const Vector3d& against_gravity, int dimensions, Opening& opening) {
  Vector3d up = given_up.value_or(against_gravity);
  if (up.cross(opening.normal).norm() < 1e-3 * up.norm()) up = std::abs(opening.normal.x()) < 0.9 ? Vector3d::UnitX() : Vector3d::UnitY();
  if (dimensions == 2) up = std::abs(up.dot(opening.normal)) < 0.999 * up.norm() ? up : Vector3d::UnitX();
  opening.up = (up - up.dot(opening.normal) * opening.normal).normalized();
  opening.across = opening.up.cross(opening.normal);
}

void place_by_part(const OpeningCase& given, const TriangleMesh& mesh, bool is_body, const Vector3d& against_gravity, int dimensions,
                   double spacing, Opening& opening) {
  const std::string what = "opening '" + given.name + "': part '" + given.part + "' ";
  const MeshPart& part = part_of(given, mesh);
  Vector3d normal = normal_of(part), origin = Vector3d::Zero();
  for (const auto& triangle : part.triangles) origin += (triangle[0] + triangle[1] + triangle[2]) / 3.0;
  origin /= static_cast<double>(part.triangles.size());
  for (const auto& triangle : part.triangles)
    for (const Vector3d& corner : triangle)
      if (std::abs(normal.dot(corner - origin)) > flat_enough * spacing)
        throw Error(what + "is not flat: its corner at " + describe(corner) + " m is " + describe(std::abs(normal.dot(corner - origin))) +
                    " m out of its plane");
  if (dimensions == 2) {
    if (std::abs(normal.y()) > 1e-6) throw Error(what + "is not at right angles to the plane y = 0 of a 2-D case");
    normal.y() = 0;
    normal.normalize();
    origin -= origin.y() * Vector3d::UnitY();
  }
  if (!given.normal.isZero(0.0)) {
    const double along = normal.dot(given.normal.normalized());
    if (std::abs(along) < 1 - 1e-6) throw Error(what + "faces " + describe(normal) + ", not along the normal given; leave normal out");
    if (along < 0) normal = -normal;
  } else {
    const auto wound = [&](double way) { return std::abs(winding_number(mesh, origin + way * 1e-3 * spacing * normal)); };
    if ((wound(1) > wound(-1)) == is_body) normal = -normal;
  }
  if (given.up && given.up->cross(normal).norm() <= 1e-6 * given.up->norm())
    throw Error(what + "faces along up, which must be a direction within it");
  opening.normal = normal;
  set_axes(given.up, against_gravity, dimensions, opening);
  if (dimensions == 2)
    set_outline_2d(given, part, origin, opening);
  else
    set_outline_3d(given, part, origin, spacing, opening);
}

}  // namespace wavetank

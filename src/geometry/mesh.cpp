#include "wavetank/geometry/mesh.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "mesh_topology.h"
#include "polygon.h"

namespace wavetank {
namespace {

/// Solid angle of a triangle seen from the origin, signed by its turn (van Oosterom and Strackee's arctangent).
double solid_angle(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

}  // namespace

Box TriangleMesh::bounding_box() const {
  Box box;
  if (vertices.empty()) return box;
  box.min = box.max = vertices.front();
  for (const Vector3d& vertex : vertices) {
    box.min = box.min.cwiseMin(vertex);
    box.max = box.max.cwiseMax(vertex);
  }
  return box;
}

Vector3d TriangleMesh::centre_of_volume() const {
  // Tetrahedra from the middle of the box, so that a mesh far from the origin loses no digits.
  const Box box = bounding_box();
  const Vector3d middle = (box.min + box.max) / 2.0;
  double volume = 0.0;
  Vector3d moment = Vector3d::Zero();
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Vector3d a = corner(i, 0) - middle, b = corner(i, 1) - middle, c = corner(i, 2) - middle;
    const double tetrahedron = a.dot(b.cross(c)) / 6.0;
    volume += tetrahedron;
    moment += tetrahedron * (a + b + c) / 4.0;
  }
  const double scale = (box.max - box.min).norm();
  if (std::abs(volume) <= 1e-9 * scale * scale * scale) return middle;
  return middle + moment / volume;
}

double TriangleMesh::signed_volume() const {
  if (triangles.empty()) return 0;
  const Vector3d reference = corner(0, 0);  // near the mesh: keeps the digits of a mesh far from the origin
  double sum = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    sum += (corner(t, 0) - reference).dot((corner(t, 1) - reference).cross(corner(t, 2) - reference));
  }
  return sum / 6.0;
}

TriangleMesh box_mesh(const Box& box, bool open_top, const std::string& name, const Top& top) {
  TriangleMesh mesh;
  mesh.name = name;
  for (int k = 0; k < 8; ++k) {  // bit 0: x, bit 1: y, bit 2: z
    mesh.vertices.emplace_back(k & 1 ? box.max.x() : box.min.x(), k & 2 ? box.max.y() : box.min.y(), k & 4 ? box.max.z() : box.min.z());
  }
  const int faces[6][4] = {{0, 2, 3, 1}, {0, 1, 5, 4}, {1, 3, 7, 5}, {3, 2, 6, 7}, {2, 0, 4, 6}, {4, 5, 7, 6}};
  const Top sides[6] = {{2, -1}, {1, -1}, {0, 1}, {1, 1}, {0, -1}, {2, 1}};
  for (int f = 0; f < 6; ++f) {
    if (open_top && sides[f].axis == top.axis && sides[f].way == top.way) continue;
    mesh.triangles.emplace_back(faces[f][0], faces[f][1], faces[f][2]);
    mesh.triangles.emplace_back(faces[f][0], faces[f][2], faces[f][3]);
  }
  return mesh;
}

double winding_number(const TriangleMesh& mesh, const Vector3d& point) {
  double angle = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    angle += solid_angle(mesh.corner(t, 0) - point, mesh.corner(t, 1) - point, mesh.corner(t, 2) - point);
  }
  return angle / (4.0 * M_PI);
}

bool inside(const TriangleMesh& closed, const Vector3d& point) { return winding_number(closed, point) > 0.5; }

double distance(const TriangleMesh& mesh, const Vector3d& point) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    least = std::min(least, (point - nearest_on_triangle(point, mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2))).squaredNorm());
  }
  return std::sqrt(least);
}

}  // namespace wavetank

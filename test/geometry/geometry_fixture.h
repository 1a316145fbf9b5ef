#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "../common/box_case.h"
#include "../common/error_of.h"
#include "../common/scratch_directory.h"
#include "wavetank/geometry/layout.h"
#include "wavetank/geometry/mesh.h"

namespace wavetank {

/// A test with a directory of its own.
class GeometryTest : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) const { return scratch.write(name, text); }

  /// The mesh as an OBJ file.
  std::string write(const std::string& name, const TriangleMesh& mesh) const {
    std::ostringstream text;
    text.precision(17);
    for (const Vector3d& v : mesh.vertices) text << "v " << v.x() << " " << v.y() << " " << v.z() << "\n";
    for (const Vector3i& t : mesh.triangles) text << "f " << t[0] + 1 << " " << t[1] + 1 << " " << t[2] + 1 << "\n";
    return write(name, text.str());
  }

  const ScratchDirectory scratch;
  const std::filesystem::path directory = scratch.path();
};

inline std::string repository_mesh(const std::string& name) { return std::string(WAVETANK_SOURCE_DIRECTORY) + "/meshes/" + name; }

inline MeshSource source(const std::string& uri) {
  MeshSource result;
  result.uri = uri;
  return result;
}

inline BodyCase box_body(const std::string& name, const Vector3d& low, const Vector3d& high) {
  BodyCase body;
  body.name = name;
  body.shape = Box{low, high};
  return body;
}

#define EXPECT_ERROR(call, part)                                                       \
  do {                                                                                 \
    const std::string message = error_of([&] { call; });                               \
    EXPECT_NE(message.find(part), std::string::npos) << "the message is: " << message; \
  } while (false)

inline double surface_area(const TriangleMesh& mesh) {
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vector3d p = mesh.corner(t, 1) - mesh.corner(t, 0), q = mesh.corner(t, 2) - mesh.corner(t, 0);
    area += 0.5 * Vector3d(p.y() * q.z() - p.z() * q.y(), p.z() * q.x() - p.x() * q.z(), p.x() * q.y() - p.y() * q.x()).norm();
  }
  return area;
}

/// Adds the triangles of one mesh to another.
inline void append(TriangleMesh& mesh, const TriangleMesh& other) {
  const int first = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const Vector3i& t : other.triangles) mesh.triangles.emplace_back(t + Vector3i::Constant(first));
}

struct OwnerSums {
  double area = 0;
  Vector3d flux = Vector3d::Zero();  ///< Σ normal × area
  double divergence = 0;             ///< Σ centre · normal × area
  int count = 0;
};

inline OwnerSums sums_of(const Layout& layout, int owner) {
  OwnerSums sums;
  for (const WallElement& wall : layout.walls) {
    if (wall.owner != owner) continue;
    sums.area += wall.area;
    sums.flux += wall.area * wall.normal;
    sums.divergence += wall.area * wall.centre.dot(wall.normal);
    ++sums.count;
  }
  return sums;
}

inline double total(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum;
}

}  // namespace wavetank

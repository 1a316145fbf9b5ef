#include "link_shape.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "urdf_text.h"
#include "values.h"
#include "wavetank/common/error.h"

namespace wavetank::scene {
namespace {

/// Roll, pitch and yaw about fixed axes.
Vector3d angles_of(const Eigen::Matrix3d& turn) {
  const double pitch = std::asin(std::clamp(-turn(2, 0), -1.0, 1.0));
  constexpr double upright = 1e-9;  // of the pitch's cosine: roll and yaw turn about the same axis, and one of them is enough
  if (std::hypot(turn(2, 1), turn(2, 2)) < upright) return {0, pitch, std::atan2(-turn(0, 1), turn(1, 1))};
  return {std::atan2(turn(2, 1), turn(2, 2)), pitch, std::atan2(turn(1, 0), turn(0, 0))};
}

std::string length_text(double length, const std::string& name, const std::string& what) {
  if (!(length > 0) || !std::isfinite(length))
    throw Error(what + " has a shape whose " + name + " is " + number_text(length) + "; it must be a number greater than 0 (m)");
  return number_text(length);
}

/// A name that is a path is relative to the robot's file.
std::string mesh_name(const std::string& name, const std::string& directory, const std::string& what) {
  if (name.empty()) throw Error(what + " has a mesh without a file name");
  if (name.find("://") != std::string::npos || name.front() == '/') return name;
  if (!directory.empty()) return (std::filesystem::path(directory) / name).lexically_normal().string();
  throw Error(what + " has the mesh '" + name +
              "', a relative path, but the robot's description is no file that it could be relative to; give package://PACKAGE/FILE, "
              "file:///FILE or an absolute path");
}

MeshSource mesh_file(const urdf::Mesh& mesh, const std::string& directory, const std::string& what) {
  MeshSource source;
  source.uri = mesh_name(mesh.filename, directory, what);
  source.scale = {mesh.scale.x, mesh.scale.y, mesh.scale.z};
  if (!source.scale.allFinite() || (source.scale.array() == 0).any()) {
    throw Error(what + " has a mesh of scale " + number_text(mesh.scale.x) + " " + number_text(mesh.scale.y) + " " +
                number_text(mesh.scale.z) + "; it must be three numbers other than 0 (m per unit of the file; a negative one mirrors)");
  }
  return source;
}

MeshSource geometry_source(const urdf::Geometry& geometry, const std::string& directory, const std::string& what) {
  if (const auto* mesh = dynamic_cast<const urdf::Mesh*>(&geometry)) return mesh_file(*mesh, directory, what);
  MeshSource source;
  if (const auto* box = dynamic_cast<const urdf::Box*>(&geometry)) {
    source.uri = "shape://box?size=" + length_text(box->dim.x, "size along x", what) + "," + length_text(box->dim.y, "size along y", what) +
                 "," + length_text(box->dim.z, "size along z", what);
  } else if (const auto* sphere = dynamic_cast<const urdf::Sphere*>(&geometry)) {
    source.uri = "shape://sphere?radius=" + length_text(sphere->radius, "radius", what);
  } else if (const auto* cylinder = dynamic_cast<const urdf::Cylinder*>(&geometry)) {
    source.uri = "shape://cylinder?radius=" + length_text(cylinder->radius, "radius", what) +
                 "&length=" + length_text(cylinder->length, "length", what);
  } else {
    throw Error(what + " has a shape that is not known here; it must be a box, cylinder, sphere or mesh");
  }
  return source;
}

template <class Element>
MeshSource only_shape(const std::vector<Element>& elements, const std::string& kind, const Eigen::Isometry3d& place,
                      const std::string& directory, const std::string& what) {
  if (elements.size() > 1) {
    throw Error(
        what + " has " + std::to_string(elements.size()) + " " + kind +
        " elements, but a body here is one shape; make one mesh of them, or give each a link of its own and join them by fixed joints");
  }
  MeshSource source = geometry_source(*elements.front()->geometry, directory, what);
  const Eigen::Isometry3d at = place * transform_of(elements.front()->origin);
  source.translation = at.translation();
  source.rotation = angles_of(at.linear());
  return source;
}

}  // namespace

bool has_shape(const urdf::Link& link) { return !link.collision_array.empty() || !link.visual_array.empty(); }

MeshSource link_shape(const urdf::Link& link, const Eigen::Isometry3d& place, const std::string& directory, const std::string& what) {
  if (!link.collision_array.empty()) return only_shape(link.collision_array, "collision", place, directory, what);
  return only_shape(link.visual_array, "visual", place, directory, what);
}

}  // namespace wavetank::scene

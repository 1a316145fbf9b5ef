#include <assimp/config.h>
#include <assimp/scene.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <new>
#include <optional>
#include <set>
#include <unordered_map>

#include "collada_checks.h"
#include "mesh_file_access.h"
#include "mesh_topology.h"
#include "ply_reader.h"
#include "polygon.h"
#include "shape_mesh.h"
#include "stl_reader.h"
#include "wavetank/common/child_process.h"
#include "wavetank/common/ending_signals.h"
#include "wavetank/common/error.h"
#include "wavetank/geometry/mesh.h"
#include "wavetank/scene/file_path.h"

namespace wavetank {
namespace {

constexpr double merge_tolerance = 1e-6;  // of the mesh's size: above the resolution of the float32 coordinates of mesh files

Eigen::Matrix4d to_eigen(const aiMatrix4x4& m) {
  Eigen::Matrix4d result;
  result << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2, m.d3, m.d4;
  return result;
}

/// Of the vertices from `first` on.
void check_finite(const TriangleMesh& mesh, std::size_t first, const std::string& path) {
  for (std::size_t v = first; v < mesh.vertices.size(); ++v) {
    if (!mesh.vertices[v].allFinite())
      throw Error("mesh file '" + path + "': vertex " + std::to_string(v) + " is not a finite number: " + describe(mesh.vertices[v]));
  }
}

using Names = std::vector<std::string>;

/// Adds the mesh's triangles from `first` on to the parts of these names.
void add_to_parts(const std::set<std::string>& names, std::size_t first, const Names& wanted, TriangleMesh& mesh) {
  for (const std::string& name : names) {
    if (name.empty()) continue;
    auto part = std::find_if(mesh.parts.begin(), mesh.parts.end(), [&](const MeshPart& known) { return known.name == name; });
    if (part == mesh.parts.end()) part = mesh.parts.insert(part, MeshPart{name, {}});
    if (std::find(wanted.begin(), wanted.end(), name) == wanted.end()) continue;
    for (std::size_t t = first; t < mesh.triangles.size(); ++t)
      part->triangles.push_back({mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)});
  }
}

void add_node(const aiScene& scene, const aiNode& node, const Eigen::Matrix4d& parent, const std::string& path, const Names& wanted_parts,
              TriangleMesh& mesh) {
  const Eigen::Matrix4d transform = parent * to_eigen(node.mTransformation);
  for (unsigned m = 0; m < node.mNumMeshes; ++m) {
    const aiMesh& part = *scene.mMeshes[node.mMeshes[m]];
    const int first = static_cast<int>(mesh.vertices.size());
    const std::size_t first_triangle = mesh.triangles.size();
    for (unsigned v = 0; v < part.mNumVertices; ++v) {
      const aiVector3D& p = part.mVertices[v];
      mesh.vertices.emplace_back((transform * Eigen::Vector4d(p.x, p.y, p.z, 1.0)).head<3>());
    }
    check_finite(mesh, first, path);
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const aiFace& face = part.mFaces[f];
      std::vector<Vector3d> corners;
      for (unsigned k = 0; k < face.mNumIndices; ++k) {
        if (face.mIndices[k] >= part.mNumVertices) {
          throw Error("mesh file '" + path + "' is corrupt: face " + std::to_string(f) + " names a vertex that does not exist");
        }
        corners.push_back(mesh.vertices[first + static_cast<int>(face.mIndices[k])]);
      }
      if (corners.size() < 3) continue;  // points and lines bound nothing
      if (corners.size() > most_corners)
        throw Error("mesh file '" + path + "': face " + std::to_string(f) + " has " + std::to_string(corners.size()) + " corners; " +
                    std::to_string(most_corners) + " at most are allowed");
      for (const Vector3i& t : triangulate(corners)) {
        mesh.triangles.emplace_back(first + static_cast<int>(face.mIndices[t[0]]), first + static_cast<int>(face.mIndices[t[1]]),
                                    first + static_cast<int>(face.mIndices[t[2]]));
      }
    }
    const aiString material = part.mMaterialIndex < scene.mNumMaterials ? scene.mMaterials[part.mMaterialIndex]->GetName() : aiString();
    add_to_parts({node.mName.C_Str(), part.mName.C_Str(), material.C_Str()}, first_triangle, wanted_parts, mesh);
  }
  for (unsigned child = 0; child < node.mNumChildren; ++child) add_node(scene, *node.mChildren[child], transform, path, wanted_parts, mesh);
}

/// One vertex for all that lie within the tolerance of it; unused vertices go.
void merge_vertices(TriangleMesh& mesh, double tolerance) {
  const Vector3d origin = mesh.bounding_box().min;
  const double cell = 4.0 * tolerance;
  const auto key = [](std::int64_t x, std::int64_t y, std::int64_t z) { return x * 73856093LL ^ y * 19349663LL ^ z * 83492791LL; };
  std::unordered_multimap<std::int64_t, int> buckets;
  buckets.reserve(mesh.triangles.size());
  std::vector<Vector3d> kept;
  std::vector<int> index(mesh.vertices.size(), -1);
  const auto merged = [&](const Vector3d& vertex) {
    const Vector3d low = (vertex - origin).array() - tolerance, high = (vertex - origin).array() + tolerance;
    for (auto x = std::llround(std::floor(low.x() / cell)); x <= std::floor(high.x() / cell); ++x) {
      for (auto y = std::llround(std::floor(low.y() / cell)); y <= std::floor(high.y() / cell); ++y) {
        for (auto z = std::llround(std::floor(low.z() / cell)); z <= std::floor(high.z() / cell); ++z) {
          const auto range = buckets.equal_range(key(x, y, z));
          for (auto it = range.first; it != range.second; ++it) {
            if ((kept[it->second] - vertex).norm() <= tolerance) return it->second;
          }
        }
      }
    }
    const Vector3d home = (vertex - origin) / cell;
    kept.push_back(vertex);
    const int result = static_cast<int>(kept.size()) - 1;
    buckets.emplace(key(std::llround(std::floor(home.x())), std::llround(std::floor(home.y())), std::llround(std::floor(home.z()))),
                    result);
    return result;
  };
  for (Vector3i& triangle : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      int& target = index[triangle[k]];
      if (target < 0) target = merged(mesh.vertices[triangle[k]]);
      triangle[k] = target;
    }
  }
  mesh.vertices = std::move(kept);
}

/// Through assimp.
TriangleMesh import_file(const std::string& path, const Names& wanted_parts) {
  if (is_collada(path)) check_collada(path);
  Assimp::Importer importer;
  importer.SetIOHandler(new MeshFileAccess);  // the importer owns it
  // Collada: the file's axes stay as they are written, as in rviz; its unit is applied, so that coordinates are metres.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* scene = importer.ReadFile(path, 0);  // no processing: some of its steps abort the program on corrupt faces
  const std::string problem = importer.GetErrorString();
  if (problem.find("bad_alloc") != std::string::npos) throw std::bad_alloc();
  if (problem.find("vector::") != std::string::npos || problem.find("basic_string") != std::string::npos)  // of C++, not assimp's own
    throw Error("mesh file '" + path + "' is damaged: its counts do not fit what it holds");
  if (!scene || !scene->mRootNode) throw Error("mesh file '" + path + "' cannot be read: " + problem);

  TriangleMesh mesh;
  add_node(*scene, *scene->mRootNode, Eigen::Matrix4d::Identity(), path, wanted_parts, mesh);
  return mesh;
}

// ---- a mesh as bytes, from the process that reads it

template <class Value>
void put(std::string& bytes, const Value* values, std::size_t count) {
  if (count > 0) bytes.append(reinterpret_cast<const char*>(values), count * sizeof(Value));
}

void put_count(std::string& bytes, std::uint64_t count) { put(bytes, &count, 1); }

template <class Value>
void put_all(std::string& bytes, const std::vector<Value>& values) {
  put_count(bytes, values.size());
  put(bytes, values.data(), values.size());
}

std::string bytes_of(const TriangleMesh& mesh) {
  std::string bytes;
  put_all(bytes, mesh.vertices);
  put_all(bytes, mesh.triangles);
  put_count(bytes, mesh.parts.size());
  for (const MeshPart& part : mesh.parts) {
    put_all(bytes, std::vector<char>(part.name.begin(), part.name.end()));
    put_all(bytes, part.triangles);
  }
  return bytes;
}

class MeshBytes {
 public:
  explicit MeshBytes(const std::string& bytes) : bytes_(bytes) {}

  /// None of what is no mesh, the whole mesh, and nothing but the mesh.
  std::optional<TriangleMesh> mesh() {
    TriangleMesh mesh;
    take_all(mesh.vertices);
    take_all(mesh.triangles);
    mesh.parts.resize(count(2 * sizeof(std::uint64_t)));
    for (MeshPart& part : mesh.parts) {
      std::vector<char> name;
      take_all(name);
      part.name.assign(name.begin(), name.end());
      take_all(part.triangles);
    }
    if (!is_whole_ || at_ != bytes_.size()) return std::nullopt;
    const int vertices = static_cast<int>(mesh.vertices.size());
    for (const Vector3i& triangle : mesh.triangles)
      if (triangle.minCoeff() < 0 || triangle.maxCoeff() >= vertices) return std::nullopt;
    return mesh;
  }

 private:
  /// Bounded by what there is: a reader that writes over its own memory may say anything.
  std::uint64_t count(std::size_t size = 1) {
    std::uint64_t value = 0;
    if (bytes_.size() - at_ < sizeof value) {
      is_whole_ = false;
      return 0;
    }
    std::memcpy(&value, bytes_.data() + at_, sizeof value);
    at_ += sizeof value;
    if (value <= (bytes_.size() - at_) / size) return value;
    is_whole_ = false;
    return 0;
  }

  template <class Value>
  void take_all(std::vector<Value>& values) {
    values.resize(count(sizeof(Value)));
    if (values.empty()) return;
    std::memcpy(static_cast<void*>(values.data()), bytes_.data() + at_, values.size() * sizeof(Value));
    at_ += values.size() * sizeof(Value);
  }

  const std::string& bytes_;
  std::size_t at_ = 0;
  bool is_whole_ = true;
};

/// Damaged files make assimp crash, loop and take memory without end: it reads in a process of its own, which may take what a sound file
/// of that size takes a few times over, and so much in any case that another file which it names, as glTF does, has room.
TriangleMesh import_in_child(const std::string& path, const Names& wanted_parts) {
  constexpr double mebibyte = 1 << 20;
  constexpr std::uint64_t most_memory = std::uint64_t(3) << 30;
  const auto size = static_cast<double>(std::filesystem::file_size(path));
  ChildLimits limits;
  limits.memory = std::min(most_memory, static_cast<std::uint64_t>(1024 * mebibyte + 200 * size));
  limits.processor_seconds = 15 + 2 * size / mebibyte;
  limits.seconds = std::min(60 + 10 * size / mebibyte, 900.0);  // the machine may be busy
  const ChildResult result = run_in_child([&] { return bytes_of(import_file(path, wanted_parts)); }, limits);
  const std::string file = "mesh file '" + path + "' ",
                    advice = "; it is damaged, or too much for the library that reads it: export it again, best as a binary STL";
  switch (result.end) {
    case ChildResult::End::done:
      if (std::optional<TriangleMesh> mesh = MeshBytes(result.bytes).mesh()) return std::move(*mesh);
      throw Error(file + "makes its reader write over its own memory" + advice);
    case ChildResult::End::refused:
      throw Error(result.bytes.find(path) != std::string::npos ? result.bytes : file + "cannot be read: " + result.bytes);
    case ChildResult::End::out_of_memory:
      throw Error(file + "takes more than the " + std::to_string(limits.memory >> 20) + " MiB of memory that a mesh of its size may" +
                  advice);
    case ChildResult::End::out_of_time:
      throw Error(file + "takes longer to read than the " + result.bytes + " that a mesh of its size may" + advice);
    case ChildResult::End::interrupted:
      throw EndRequested(file + "was not read to its end: the program was asked to end");
    case ChildResult::End::crashed:
      break;
  }
  throw Error(file + "makes its reader crash (" + result.bytes + ")" + advice);
}

TriangleMesh read_file(const std::string& path, const Names& wanted_parts) {
  check_file("mesh", path);
  constexpr std::uintmax_t greatest_file = std::uintmax_t(1) << 30;
  if (std::filesystem::file_size(path) > greatest_file) throw Error("mesh file '" + path + "' is larger than 1 GiB; make it coarser");
  TriangleMesh mesh = is_stl(path)   ? read_stl(path)  // assimp takes few of the dialects of STL
                      : is_ply(path) ? read_ply(path)  // and reads wrong what is binary and begins with a line feed
                                     : import_in_child(path, wanted_parts);
  mesh.name = std::filesystem::path(path).filename().string();
  check_finite(mesh, 0, path);
  if (mesh.triangles.empty()) throw Error("mesh file '" + path + "' has no triangles");

  const Box box = mesh.bounding_box();
  merge_vertices(mesh, std::max(merge_tolerance * (box.max - box.min).norm(), 1e-30));
  remove_degenerate_triangles(mesh);
  remove_duplicate_triangles(mesh);
  if (mesh.triangles.empty()) throw Error("mesh file '" + path + "' has only triangles of zero area");
  return mesh;
}

void place(TriangleMesh& mesh, const MeshSource& source, const std::string& what) {
  const Eigen::Matrix3d rotation =
      (Eigen::AngleAxisd(source.rotation.z(), Vector3d::UnitZ()) * Eigen::AngleAxisd(source.rotation.y(), Vector3d::UnitY()) *
       Eigen::AngleAxisd(source.rotation.x(), Vector3d::UnitX()))
          .toRotationMatrix();
  const auto placed = [&](const Vector3d& vertex) -> Vector3d { return rotation * source.scale.cwiseProduct(vertex) + source.translation; };
  for (MeshPart& part : mesh.parts)
    for (auto& triangle : part.triangles)
      for (Vector3d& corner : triangle) corner = placed(corner);
  for (Vector3d& vertex : mesh.vertices) {
    vertex = placed(vertex);
    if (!vertex.allFinite()) throw Error(what + ": its scale, rotation or translation makes vertices that are not finite numbers");
  }
  if (source.scale.prod() < 0) {  // mirrored: what was wound outwards is to stay so
    for (Vector3i& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  }
}

}  // namespace

TriangleMesh read_mesh(const MeshSource& source, const std::string& case_directory, const ResourceResolver& resolve,
                       const Names& wanted_parts) {
  if (is_shape(source.uri)) {
    TriangleMesh mesh = shape_mesh(source.uri);
    place(mesh, source, "mesh '" + source.uri + "'");
    return mesh;
  }
  const std::string path = file_path("mesh", source.uri, case_directory, resolve);
  TriangleMesh mesh = read_file(path, wanted_parts);
  place(mesh, source, "mesh file '" + path + "'");
  return mesh;
}

}  // namespace wavetank

// The only file that sees OpenVDB: most of a minute of compilation.
#include <openvdb/openvdb.h>
#include <openvdb/tools/VolumeToMesh.h>
#include <tbb/task_arena.h>

#include <mutex>

#include "contour.h"

namespace wavetank {
namespace {

/// How much neighbouring pieces of the surface may turn to be made one: 0 none is, 1 all may be. To 0.5 a surface keeps its volume within
/// half a percent.
constexpr double coarsenings[] = {0.0, 0.05, 0.2, 0.5, 1.0};

/// Grid values are distances out of the water, as OpenVDB has them. The grid stays of no class: of one of GRID_LEVEL_SET the mesher turns
/// the triangles round.
openvdb::FloatGrid::Ptr grid_of(const std::vector<NodeValue>& values, float elsewhere) {
  openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(-elsewhere);
  openvdb::FloatGrid::Accessor accessor = grid->getAccessor();
  for (const NodeValue& each : values) accessor.setValue({each.node[0], each.node[1], each.node[2]}, -each.value);
  return grid;
}

Contour contour_of(const openvdb::tools::VolumeToMesh& mesher) {
  Contour found;
  found.vertices.reserve(mesher.pointListSize());
  for (std::size_t i = 0; i < mesher.pointListSize(); ++i) {
    const openvdb::Vec3s& point = mesher.pointList()[i];
    found.vertices.emplace_back(point.x(), point.y(), point.z());
  }
  const auto add = [&found](unsigned a, unsigned b, unsigned c) {
    found.triangles.push_back({static_cast<int>(a), static_cast<int>(b), static_cast<int>(c)});
  };
  for (std::size_t p = 0; p < mesher.polygonPoolListSize(); ++p) {
    const openvdb::tools::PolygonPool& pool = mesher.polygonPoolList()[p];
    for (std::size_t t = 0; t < pool.numTriangles(); ++t) add(pool.triangle(t)[0], pool.triangle(t)[1], pool.triangle(t)[2]);
    for (std::size_t q = 0; q < pool.numQuads(); ++q) {
      const openvdb::Vec4I& quad = pool.quad(q);
      const auto side = [&](int a, int b) { return (found.vertices[quad[a]] - found.vertices[quad[b]]).squaredNorm(); };
      const int first = side(0, 2) <= side(1, 3) ? 0 : 1;  // along the shorter diagonal
      add(quad[first], quad[first + 1], quad[first + 2]);
      add(quad[first], quad[first + 2], quad[(first + 3) % 4]);
    }
  }
  return found;
}

}  // namespace

bool can_contour() { return true; }

Contour contour(const std::vector<NodeValue>& values, float elsewhere, std::size_t most_triangles) {
  static std::once_flag once;
  std::call_once(once, [] { openvdb::initialize(); });
  Contour found;
  tbb::task_arena arena(1);  // the other processors are the solver's
  arena.execute([&] {
    const openvdb::FloatGrid::Ptr grid = grid_of(values, elsewhere);
    for (const double coarsening : coarsenings) {
      openvdb::tools::VolumeToMesh mesher(0.0, coarsening);
      mesher(*grid);
      found = contour_of(mesher);
      if (found.triangles.size() <= most_triangles) return;
    }
  });
  return found;
}

}  // namespace wavetank

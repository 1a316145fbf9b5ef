#include "decomposition.h"

#include <HACD/hacdHACD.h>

#include <algorithm>
#include <cmath>

#include "wavetank/common/error.h"

namespace wavetank {
namespace {

constexpr int samples_across = 40;  // of the longest side, for the difference in volume

bool holds(const ConvexHull& hull, const Vector3d& point) {
  return std::all_of(hull.faces.begin(), hull.faces.end(),
                     [&](const ConvexHull::Face& face) { return face.normal.dot(point) <= face.offset; });
}

}  // namespace

std::vector<ConvexHull> decompose(const TriangleMesh& mesh, double spacing, const std::string& what) {
  std::vector<HACD::Vec3<HACD::Real>> points;
  std::vector<HACD::Vec3<long>> triangles;
  for (const Vector3d& v : mesh.vertices) points.emplace_back(v.x(), v.y(), v.z());
  for (const Vector3i& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  HACD::HACD hacd;
  hacd.SetPoints(points.data());
  hacd.SetNPoints(points.size());
  hacd.SetTriangles(triangles.data());
  hacd.SetNTriangles(triangles.size());
  hacd.SetCompacityWeight(0.0001);
  hacd.SetVolumeWeight(0.0);
  hacd.SetNClusters(1);
  hacd.SetNVerticesPerCH(200);
  const Box box = mesh.bounding_box();
  hacd.SetScaleFactor(1000.0);
  hacd.SetConcavity(1000.0 * spacing / (box.max - box.min).norm());
  hacd.SetConnectDist(0);
  hacd.SetAddExtraDistPoints(true);
  hacd.SetAddNeighboursDistPoints(true);
  hacd.SetAddFacesPoints(true);
  hacd.Compute();
  std::vector<ConvexHull> parts;
  for (std::size_t c = 0; c < hacd.GetNClusters(); ++c) {
    std::vector<HACD::Vec3<HACD::Real>> corners(hacd.GetNPointsCH(c));
    std::vector<HACD::Vec3<long>> faces(hacd.GetNTrianglesCH(c));
    hacd.GetCH(c, corners.data(), faces.data());
    std::vector<Vector3d> vertices;
    for (const auto& corner : corners) vertices.emplace_back(corner.X(), corner.Y(), corner.Z());
    try {
      parts.push_back(convex_hull(vertices, what));
    } catch (const Error&) {
    }
  }
  if (parts.empty()) throw Error(what + " falls into no convex parts; list them as parts for contacts, or choose the convex hull");
  return parts;
}

VolumeDifference volume_difference(const TriangleMesh& mesh, const std::vector<ConvexHull>& parts) {
  Box box = mesh.bounding_box();
  for (const ConvexHull& part : parts) {
    const Box own = part.bounding_box();
    box.min = box.min.cwiseMin(own.min);
    box.max = box.max.cwiseMax(own.max);
  }
  const Vector3d size = box.max - box.min;
  const double step = size.maxCoeff() / samples_across;
  const Vector3i counts = (size / step).array().ceil().cast<int>().max(1);
  const Vector3d cell = size.array() / counts.cast<double>().array();
  double in_mesh = 0, lacking = 0, added = 0;
  for (int i = 0; i < counts.x(); ++i)
    for (int j = 0; j < counts.y(); ++j)
      for (int k = 0; k < counts.z(); ++k) {
        const Vector3d point = box.min + cell.cwiseProduct(Vector3d(i + 0.5, j + 0.5, k + 0.5));
        const bool in_body = inside(mesh, point);
        const bool in_part = std::any_of(parts.begin(), parts.end(), [&](const ConvexHull& part) { return holds(part, point); });
        in_mesh += in_body;
        lacking += in_body && !in_part;
        added += in_part && !in_body;
      }
  return in_mesh > 0 ? VolumeDifference{lacking / in_mesh, added / in_mesh} : VolumeDifference{};
}

}  // namespace wavetank

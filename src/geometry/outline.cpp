#include "outline.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "wavetank/common/error.h"

namespace wavetank {
namespace {

using Cut = std::pair<int, int>;  // the mesh edge that a point of the outline lies on

struct Segment {
  Cut from, to;
};

/// Vertices count as on one side or the other of the plane, never on it, so that every closed mesh has closed outlines. `on_plane_is_above`
/// says which.
std::vector<Segment> cut_triangles(const TriangleMesh& mesh, bool on_plane_is_above, std::map<Cut, Vector3d>& points) {
  const auto above = [&](int v) { return on_plane_is_above ? mesh.vertices[v].y() >= 0 : mesh.vertices[v].y() > 0; };
  std::vector<Segment> segments;
  for (const Vector3i& t : mesh.triangles) {
    Segment segment;
    int found = 0;
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      if (above(a) == above(b)) continue;
      const Cut cut = std::minmax(a, b);
      const Vector3d &p = mesh.vertices[cut.first], &q = mesh.vertices[cut.second];
      Vector3d point = p + p.y() / (p.y() - q.y()) * (q - p);
      point.y() = 0;
      points[cut] = point;
      (above(a) ? segment.from : segment.to) = cut;  // leaves above to below at `from`: the same hand in every triangle
      ++found;
    }
    if (found == 2) segments.push_back(segment);
  }
  return segments;
}

/// Joins segments that share a cut into lines.
Outline join(const std::vector<Segment>& segments, const std::map<Cut, Vector3d>& points) {
  std::map<Cut, std::vector<int>> at;
  for (int s = 0; s < static_cast<int>(segments.size()); ++s) {
    at[segments[s].from].push_back(s);
    at[segments[s].to].push_back(s);
  }
  std::vector<char> used(segments.size(), 0);
  // Where more than two segments meet, a line goes on in one of its own sense: so outlines of solids that touch keep their hand.
  const auto next_at = [&](const Cut& cut, bool onwards) {
    int found = -1;
    for (const int s : at[cut]) {
      if (used[s]) continue;
      found = s;
      if ((onwards ? segments[s].from : segments[s].to) == cut) break;
    }
    return found;
  };
  const auto follow = [&](Cut end, bool onwards, std::vector<Cut>& line) {
    for (int s = next_at(end, onwards); s >= 0; s = next_at(end, onwards)) {
      used[s] = 1;
      end = segments[s].from == end ? segments[s].to : segments[s].from;
      line.push_back(end);
    }
  };
  Outline outline;
  for (std::size_t s = 0; s < segments.size(); ++s) {
    if (used[s]) continue;
    used[s] = 1;
    std::vector<Cut> line = {segments[s].from, segments[s].to}, before;
    follow(segments[s].to, true, line);
    if (line.back() != line.front()) follow(segments[s].from, false, before);
    std::reverse(before.begin(), before.end());
    before.insert(before.end(), line.begin(), line.end());
    Polyline polyline;
    polyline.closed = before.size() > 2 && before.front() == before.back();
    if (polyline.closed) before.pop_back();
    for (const Cut& cut : before) {  // several cuts may lie on one vertex of the plane
      const Vector3d& point = points.at(cut);
      if (polyline.points.empty() || (point - polyline.points.back()).norm() > 0) polyline.points.push_back(point);
    }
    if (polyline.closed && polyline.points.size() > 1 && (polyline.points.front() - polyline.points.back()).norm() == 0)
      polyline.points.pop_back();
    if (polyline.points.size() > 1) outline.push_back(polyline);
  }
  return outline;
}

template <class Visit>
void visit_segments(const Outline& outline, Visit visit) {
  for (const Polyline& line : outline) {
    const std::size_t count = line.points.size();
    for (std::size_t k = 0; k + 1 < count + (line.closed ? 1 : 0); ++k) visit(line.points[k], line.points[(k + 1) % count]);
  }
}

}  // namespace

Outline box_outline(const Box& box, bool open_top, const Top& top) {
  const double x0 = box.min.x(), x1 = box.max.x(), z0 = box.min.z(), z1 = box.max.z();
  std::vector<Vector3d> corners = {{x0, 0, z1}, {x0, 0, z0}, {x1, 0, z0}, {x1, 0, z1}};
  // the open side is that from the last corner to the first
  const int first = top.axis == 2 ? (top.way > 0 ? 0 : 2) : (top.way > 0 ? 3 : 1);
  std::rotate(corners.begin(), corners.begin() + first, corners.end());
  return {Polyline{corners, !open_top}};
}

Outline cut_mesh(const TriangleMesh& mesh) {
  for (const bool on_plane_is_above : {true, false}) {  // a mesh that only touches the plane from one side is cut in one of the two
    std::map<Cut, Vector3d> points;
    const std::vector<Segment> segments = cut_triangles(mesh, on_plane_is_above, points);
    const Outline outline = join(segments, points);
    if (!outline.empty()) return outline;
  }
  const Box box = mesh.bounding_box();
  throw Error("mesh '" + mesh.name + "' does not meet the plane y = 0 of a two-dimensional case: its y goes from " +
              std::to_string(box.min.y()) + " to " + std::to_string(box.max.y()) + " m");
}

bool inside(const Outline& outline, const Vector3d& point) {
  double angle = 0;
  visit_segments(outline, [&](const Vector3d& a, const Vector3d& b) {
    const Vector3d p = a - point, q = b - point;
    angle += std::atan2(p.x() * q.z() - p.z() * q.x(), p.x() * q.x() + p.z() * q.z());
  });
  return std::abs(angle) > M_PI;
}

Box bounding_box(const Outline& outline) {
  Box box{Vector3d::Constant(std::numeric_limits<double>::infinity()), Vector3d::Constant(-std::numeric_limits<double>::infinity())};
  for (const Polyline& line : outline) {
    for (const Vector3d& point : line.points) {
      box.min = box.min.cwiseMin(point);
      box.max = box.max.cwiseMax(point);
    }
  }
  return box;
}

std::vector<WallTriangle> ribbons(const Outline& outline, double width, int owner) {
  const Vector3d half(0, 0.5 * width, 0);
  std::vector<WallTriangle> result;
  visit_segments(outline, [&](const Vector3d& a, const Vector3d& b) {
    result.push_back({a - half, b - half, b + half, owner});
    result.push_back({a - half, b + half, a + half, owner});
  });
  return result;
}

}  // namespace wavetank

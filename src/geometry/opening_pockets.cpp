#include "opening_pockets.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "polygon.h"
#include "wavetank/common/error.h"
#include "wavetank/geometry/opening_picture.h"

namespace wavetank {
namespace {

constexpr double flat = 1e-3;  // of the spacing: what lies nearer to a plane is in it

/// The pocket's sides, without front and back; in 2-D the lower and the upper one.
std::vector<PocketSide> lateral_sides(const Opening& opening) {
  if (opening.width == 0) {
    return {{-opening.up, -opening.up.dot(opening.outline[0])}, {opening.up, opening.up.dot(opening.outline[1])}};
  }
  std::vector<PocketSide> sides;
  const std::size_t count = opening.outline.size();
  for (std::size_t k = 0; k < count; ++k) {
    const Vector3d outwards = (opening.outline[(k + 1) % count] - opening.outline[k]).cross(opening.normal).normalized();
    sides.push_back({outwards, outwards.dot(opening.outline[k])});
  }
  return sides;
}

bool in_plane(const Opening& opening, const Vector3d& point, double spacing) {
  return std::abs(opening.normal.dot(point - opening.centre)) <= flat * spacing;
}

[[noreturn]] void throw_off_wall(const Opening& opening, double found, const std::string& whose, bool is_2d) {
  const std::string unit = is_2d ? " m" : " m²";
  throw Error(called(opening) + " does not lie in a flat wall of " + whose + ": of its " + describe(opening.area) + unit + ", " +
              describe(found) + unit + " are on one with that normal; all of it must be");
}

// ---------------------------------------------------------------- 2-D

/// Takes out what of the outline lies in the pocket; returns how much of it was in the opening's plane, m.
double cut_outline(Outline& outline, const Opening& opening, double spacing) {
  const std::vector<PocketSide> sides = sides_of_pocket(opening, spacing);
  Outline result;
  double removed = 0;
  for (const Polyline& line : outline) {
    const std::size_t count = line.points.size(), segments = line.closed ? count : count - 1;
    std::vector<Polyline> pieces(1);
    bool cut = false;
    const auto add = [&](const Vector3d& point) {
      std::vector<Vector3d>& points = pieces.back().points;
      if (points.empty() || (points.back() - point).norm() > 1e-9 * opening.height) points.push_back(point);
    };
    add(line.points[0]);
    for (std::size_t k = 0; k < segments; ++k) {
      const Vector3d &from = line.points[k], &to = line.points[(k + 1) % count];
      double enter = 0, leave = 1;
      for (const PocketSide& side : sides) {
        const double a = side.normal.dot(from) - side.offset, b = side.normal.dot(to) - side.offset;
        const double margin = 1e-6 * spacing;  // along a side is outside
        if (a > -margin && b > -margin) enter = 2;
        if (a > -margin && b <= -margin) enter = std::max(enter, a / (a - b));
        if (a <= -margin && b > -margin) leave = std::min(leave, a / (a - b));
      }
      if (enter < leave) {
        const Vector3d in = from + enter * (to - from), out = from + leave * (to - from);
        if (in_plane(opening, from, spacing) && in_plane(opening, to, spacing)) removed += (out - in).norm();
        add(in);
        pieces.emplace_back();
        add(out);
        cut = true;
      }
      add(to);
    }
    if (!cut) {
      result.push_back(line);
      continue;
    }
    if (line.closed && pieces.size() > 1) {  // the last piece goes on into the first
      Polyline& last = pieces.back();
      last.points.insert(last.points.end(), pieces.front().points.begin() + 1, pieces.front().points.end());
      pieces.erase(pieces.begin());
    }
    for (Polyline& piece : pieces)
      if (piece.points.size() > 1) result.push_back(std::move(piece));
  }
  outline = std::move(result);
  return removed;
}

// ---------------------------------------------------------------- 3-D

int vertex_at(TriangleMesh& mesh, const Vector3d& point, double tolerance) {
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if ((mesh.vertices[v] - point).norm() <= tolerance) return static_cast<int>(v);
  mesh.vertices.push_back(point);
  return static_cast<int>(mesh.vertices.size()) - 1;
}

void add_polygon(TriangleMesh& mesh, const Polygon& polygon, double tolerance) {
  std::vector<int> corners;
  for (const Vector3d& point : polygon) corners.push_back(vertex_at(mesh, point, tolerance));
  for (const Eigen::Vector3i& t : triangulate(polygon)) {
    const Vector3i triangle(corners[t[0]], corners[t[1]], corners[t[2]]);
    if (triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0]) mesh.triangles.push_back(triangle);
  }
}

/// Likewise, m².
double cut_mesh(TriangleMesh& mesh, const Opening& opening, double spacing) {
  const std::vector<PocketSide> sides = sides_of_pocket(opening, spacing);
  const double tolerance = 1e-6 * spacing;
  std::vector<Vector3i> whole;
  std::vector<Polygon> kept;
  double removed = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Polygon inside{mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)};
    const bool flat_on = std::all_of(inside.begin(), inside.end(), [&](const Vector3d& c) { return in_plane(opening, c, spacing); });
    std::vector<Polygon> outside;
    for (const PocketSide& side : sides) {
      if (inside.empty()) break;
      Polygon beyond = part_below(inside, -side.normal, -side.offset, tolerance);
      inside = part_below(inside, side.normal, side.offset, tolerance);
      if (beyond.size() > 2 && !inside.empty()) outside.push_back(std::move(beyond));
    }
    const double area = inside.size() > 2 ? vector_area(inside).norm() : 0.0;
    if (area <= 1e-9 * opening.area) {
      whole.push_back(mesh.triangles[t]);
      continue;
    }
    if (flat_on) removed += area;
    kept.insert(kept.end(), outside.begin(), outside.end());
  }
  mesh.triangles = std::move(whole);
  for (const Polygon& piece : kept) add_polygon(mesh, piece, tolerance);
  return removed;
}

void add_pocket(TriangleMesh& mesh, const Opening& opening, double spacing) {
  const Vector3d back = -opening.pocket * opening.normal;
  const std::size_t count = opening.outline.size();
  Polygon cap;
  for (std::size_t k = 0; k < count; ++k) {
    const Vector3d &a = opening.outline[k], &b = opening.outline[(k + 1) % count];
    add_polygon(mesh, {a, b, b + back, a + back}, 1e-6 * spacing);
    cap.push_back(a + back);
  }
  add_polygon(mesh, cap, 1e-6 * spacing);
}

}  // namespace

std::vector<Vector3d> drawn_outline(const Opening& opening, const TriangleMesh& wall) {
  if (opening.width > 0) return opening.outline;
  const Box bounds = wall.bounding_box();
  std::vector<Vector3d> corners{opening.outline[0], opening.outline[1], opening.outline[1], opening.outline[0]};
  for (std::size_t k = 0; k < 4; ++k) corners[k].y() = k < 2 ? bounds.min.y() : bounds.max.y();
  return corners;
}

TriangleMesh without_openings(TriangleMesh wall, int owner, const std::vector<Opening>& openings, double spacing) {
  for (const Opening& opening : openings)
    if (opening.owner == owner) cut_mesh(wall, opening, spacing);
  return wall;
}

std::string called(const Opening& opening) { return "opening '" + opening.name + "' at " + describe(opening.centre) + " m"; }

std::vector<PocketSide> sides_of_pocket(const Opening& opening, double spacing) {
  std::vector<PocketSide> sides = lateral_sides(opening);
  const double at = opening.normal.dot(opening.centre);
  sides.push_back({opening.normal, at + 2 * flat * spacing});
  sides.push_back({-opening.normal, -(at - opening.pocket)});
  return sides;
}

void open_outline(Outline& outline, const std::vector<Opening>& openings, double spacing, const std::string& whose) {
  for (const Opening& opening : openings) {
    const double removed = cut_outline(outline, opening, spacing);
    if (removed < (1 - 1e-3) * opening.area) throw_off_wall(opening, removed, whose, true);
  }
  for (const Opening& opening : openings) {
    const Vector3d back = -opening.pocket * opening.normal;
    outline.push_back({{opening.outline[0], opening.outline[0] + back, opening.outline[1] + back, opening.outline[1]}, false});
  }
}

void open_mesh(TriangleMesh& mesh, const std::vector<Opening>& openings, double spacing, const std::string& whose) {
  for (const Opening& opening : openings) {
    const double removed = cut_mesh(mesh, opening, spacing);
    if (removed < (1 - 1e-3) * opening.area) throw_off_wall(opening, removed, whose, false);
  }
  for (const Opening& opening : openings) add_pocket(mesh, opening, spacing);
}

}  // namespace wavetank

#pragma once

#include <optional>
#include <vector>

#include "wavetank/scene/case.h"

namespace wavetank {

/// A triangle of any wall. In 2-D walls are ribbons of triangles across the x–z plane.
struct WallTriangle {
  Vector3d a, b, c;
  int owner = 0;    ///< 0 the tank, 1 + i body i
  int surface = 0;  ///< of the owner's, where several solids of one mesh touch
};

/// Which walls a query is about.
enum class Walls { all, tank, bodies };

/// Finds the triangles near a place: a uniform grid over all walls, made once, that never changes.
class TriangleGrid {
 public:
  /// `tolerance`: a segment that comes nearer to a triangle than this touches it, and touching is crossing; so hairline gaps between CAD
  /// faces are shut.
  TriangleGrid(const std::vector<WallTriangle>& triangles, double cell, double tolerance);

  /// Whether the straight way between two near points (a few cells) meets a wall.
  bool crosses(const Vector3d& from, const Vector3d& to, Walls walls = Walls::all) const;

  /// The fraction of the way at which it first meets a wall.
  std::optional<double> first_crossing(const Vector3d& from, const Vector3d& to) const;

  struct Nearest {
    Vector3d point;
    double distance = 0;
  };
  /// The nearest wall point, if one is nearer than `radius` (a few cells at most).
  std::optional<Nearest> nearest(const Vector3d& point, double radius) const;

  /// Indices of triangles whose bounding boxes meet the box, each once, ascending.
  std::vector<int> overlapping(const Box& box) const;

  const std::vector<WallTriangle>& triangles() const { return triangles_; }
  double tolerance() const { return tolerance_; }

 private:
  /// A triangle's plane, its edges' planes (outwards) and its bounds: clipping a segment by them needs no other arithmetic.
  struct Prepared {
    Vector3d normal, edge_normal[3];
    double offset, edge_offset[3];
    Box bounds;
  };
  bool meets(const Prepared& triangle, const Vector3d& from, const Vector3d& to, double& entry) const;
  template <class Visit>
  void visit_cells(const Vector3d& low, const Vector3d& high, Visit visit) const;
  /// Calls visit(cell) for the cells that the triangle may pass through.
  template <class Visit>
  void visit_triangle(const Prepared& triangle, Visit visit) const;

  std::vector<WallTriangle> triangles_;
  std::vector<Prepared> prepared_;
  double tolerance_;
  Vector3d origin_;
  double cell_;
  int count_[3];
  std::vector<int> start_, content_;
};

}  // namespace wavetank

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

/// Finds the triangles near a place: a tree of boxes over all walls, made once, that never changes. What it costs to ask depends little on
/// how fine the triangles are or how far they reach.
class TriangleGrid {
 public:
  /// `tolerance`: a segment that comes nearer to a triangle than this touches it, and touching is crossing; so hairline gaps between CAD
  /// faces are shut.
  TriangleGrid(const std::vector<WallTriangle>& triangles, double tolerance);

  /// Whether the straight way between two points meets a wall.
  bool crosses(const Vector3d& from, const Vector3d& to, Walls walls = Walls::all) const;

  struct Crossing {
    double fraction = 0;  ///< of the way
    int triangle = 0;
  };
  /// Where the way first meets a wall.
  std::optional<Crossing> first_crossing(const Vector3d& from, const Vector3d& to) const;

  struct Nearest {
    Vector3d point;
    double distance = 0;
    int triangle = 0;
  };
  /// The nearest wall point, if one is nearer than `radius`.
  std::optional<Nearest> nearest(const Vector3d& point, double radius) const;

  /// Indices of triangles whose bounding boxes meet the box, each once, ascending.
  std::vector<int> overlapping(const Box& box) const;

  const std::vector<WallTriangle>& triangles() const { return triangles_; }
  const Vector3d& normal(int triangle) const { return prepared_[triangle].normal; }
  double tolerance() const { return tolerance_; }

 private:
  /// A triangle's plane, its edges' planes (outwards) and its bounds: clipping a segment by them needs no other arithmetic.
  struct Prepared {
    Vector3d normal, edge_normal[3];
    double offset, edge_offset[3];
    Box bounds;
  };
  bool meets(const Prepared& triangle, const Vector3d& from, const Vector3d& to, double& entry) const;
  /// Of the tree: about the triangles order_[first] to order_[last - 1]. Two children follow each other; a leaf has none.
  struct Node {
    Box bounds;
    int first = 0, last = 0;
    int children = -1;
  };
  void split(int node);
  /// Calls visit(triangle) for those whose bounds may_meet(bounds) is true of, until it returns true.
  template <class MayMeet, class Visit>
  void visit_triangles(MayMeet may_meet, Visit visit) const;

  std::vector<WallTriangle> triangles_;
  std::vector<Prepared> prepared_;
  double tolerance_;
  std::vector<Node> nodes_;
  std::vector<int> order_;
};

}  // namespace wavetank

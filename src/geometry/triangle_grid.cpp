#include "triangle_grid.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "polygon.h"
#include "wavetank/geometry/mesh.h"

namespace wavetank {
namespace {

constexpr int leaf_size = 4;

/// Narrows the part [enter, leave] of a segment to where its height over a plane, which goes from `first` to `last`, is not positive.
bool clip(double first, double last, double& enter, double& leave) {
  if (first > 0 && last > 0) return false;
  if (first > 0) {
    enter = std::max(enter, first / (first - last));
  } else if (last > 0) {
    leave = std::min(leave, first / (first - last));
  }
  return enter <= leave;
}

Box around(const Box& a, const Box& b) { return {a.min.cwiseMin(b.min), a.max.cwiseMax(b.max)}; }

bool meet(const Box& box, const Vector3d& low, const Vector3d& high) {
  for (int axis = 0; axis < 3; ++axis) {
    if (box.min[axis] > high[axis] || box.max[axis] < low[axis]) return false;
  }
  return true;
}

/// Which boxes a straight way passes through.
class Way {
 public:
  Way(const Vector3d& from, const Vector3d& to) : from_(from), low_(from.cwiseMin(to)), high_(from.cwiseMax(to)) {
    for (int axis = 0; axis < 3; ++axis) inverse_[axis] = to[axis] == from[axis] ? 0 : 1 / (to[axis] - from[axis]);
  }

  bool operator()(const Box& box) const {
    if (!meet(box, low_, high_)) return false;
    double enter = 0, leave = 1;
    for (int axis = 0; axis < 3; ++axis) {
      if (inverse_[axis] == 0) continue;
      const double a = (box.min[axis] - from_[axis]) * inverse_[axis], b = (box.max[axis] - from_[axis]) * inverse_[axis];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave + 1e-9;
  }

 private:
  Vector3d from_, low_, high_;
  double inverse_[3];
};

double distance_to(const Box& box, const Vector3d& point) {
  return (box.min - point).cwiseMax(point - box.max).cwiseMax(Vector3d::Zero()).norm();
}

bool selected(int owner, Walls walls) { return walls == Walls::all || (walls == Walls::tank) == (owner == 0); }

}  // namespace

TriangleGrid::TriangleGrid(const std::vector<WallTriangle>& triangles, double tolerance) : triangles_(triangles), tolerance_(tolerance) {
  prepared_.reserve(triangles_.size());
  for (const WallTriangle& t : triangles_) {
    Prepared p;
    const Vector3d* corner[3] = {&t.a, &t.b, &t.c};
    p.normal = (t.b - t.a).cross(t.c - t.a).normalized();
    p.offset = p.normal.dot(t.a);
    for (int k = 0; k < 3; ++k) {
      p.edge_normal[k] = (*corner[(k + 1) % 3] - *corner[k]).cross(p.normal).normalized();
      p.edge_offset[k] = p.edge_normal[k].dot(*corner[k]);
    }
    p.bounds.min = t.a.cwiseMin(t.b).cwiseMin(t.c).array() - tolerance;
    p.bounds.max = t.a.cwiseMax(t.b).cwiseMax(t.c).array() + tolerance;
    prepared_.push_back(p);
  }
  if (triangles_.empty()) return;
  order_.resize(triangles_.size());
  std::iota(order_.begin(), order_.end(), 0);
  nodes_.reserve(2 * triangles_.size());
  nodes_.push_back({{}, 0, static_cast<int>(order_.size()), -1});
  split(0);
}

void TriangleGrid::split(int node) {
  const int first = nodes_[node].first, last = nodes_[node].last;
  Box bounds = prepared_[order_[first]].bounds;
  for (int i = first; i < last; ++i) bounds = around(bounds, prepared_[order_[i]].bounds);
  nodes_[node].bounds = bounds;
  if (last - first <= leaf_size) return;
  int axis = 0;
  (bounds.max - bounds.min).maxCoeff(&axis);
  const auto before = [&](int a, int b) {
    const double left = prepared_[a].bounds.min[axis] + prepared_[a].bounds.max[axis];
    const double right = prepared_[b].bounds.min[axis] + prepared_[b].bounds.max[axis];
    return left < right || (left == right && a < b);
  };
  const int middle = (first + last) / 2;
  std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last, before);
  const int children = static_cast<int>(nodes_.size());
  nodes_[node].children = children;
  nodes_.push_back({{}, first, middle, -1});
  nodes_.push_back({{}, middle, last, -1});
  split(children);
  split(children + 1);
}

template <class MayMeet, class Visit>
void TriangleGrid::visit_triangles(MayMeet may_meet, Visit visit) const {
  if (nodes_.empty()) return;
  int stack[64];  // halving leaves no more levels than an int has digits
  int depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const Node& node = nodes_[stack[--depth]];
    if (!may_meet(node.bounds)) continue;
    if (node.children >= 0) {
      stack[depth++] = node.children + 1;
      stack[depth++] = node.children;
      continue;
    }
    for (int i = node.first; i < node.last; ++i)
      if (may_meet(prepared_[order_[i]].bounds) && visit(order_[i])) return;
  }
}

bool TriangleGrid::meets(const Prepared& t, const Vector3d& from, const Vector3d& to, double& entry) const {
  for (int axis = 0; axis < 3; ++axis) {
    if (std::max(from[axis], to[axis]) < t.bounds.min[axis] || std::min(from[axis], to[axis]) > t.bounds.max[axis]) return false;
  }
  double enter = 0, leave = 1;
  const double first = t.normal.dot(from) - t.offset, last = t.normal.dot(to) - t.offset;
  if (!clip(first - tolerance_, last - tolerance_, enter, leave) || !clip(-first - tolerance_, -last - tolerance_, enter, leave))
    return false;
  for (int k = 0; k < 3; ++k) {
    const double limit = t.edge_offset[k] + tolerance_;
    if (!clip(t.edge_normal[k].dot(from) - limit, t.edge_normal[k].dot(to) - limit, enter, leave)) return false;
  }
  for (int axis = 0; axis < 3; ++axis) {  // a needle's corners would otherwise reach far beyond it
    if (!clip(from[axis] - t.bounds.max[axis], to[axis] - t.bounds.max[axis], enter, leave)) return false;
    if (!clip(t.bounds.min[axis] - from[axis], t.bounds.min[axis] - to[axis], enter, leave)) return false;
  }
  entry = enter;
  return true;
}

bool TriangleGrid::crosses(const Vector3d& from, const Vector3d& to, Walls walls) const {
  bool met = false;
  visit_triangles(Way(from, to), [&](int t) {
    double entry;
    met = selected(triangles_[t].owner, walls) && meets(prepared_[t], from, to, entry);
    return met;
  });
  return met;
}

std::optional<TriangleGrid::Crossing> TriangleGrid::first_crossing(const Vector3d& from, const Vector3d& to) const {
  std::optional<Crossing> first;
  visit_triangles(Way(from, to), [&](int index) {
    const Prepared& t = prepared_[index];
    double entry;
    if (!meets(t, from, to, entry)) return false;
    const double before = t.normal.dot(from) - t.offset, after = t.normal.dot(to) - t.offset;
    const double fraction = before * after < 0 ? before / (before - after) : entry;  // of the plane itself where the way passes through it
    if (!first || fraction < first->fraction) first = Crossing{fraction, index};
    return false;
  });
  return first;
}

std::optional<TriangleGrid::Nearest> TriangleGrid::nearest(const Vector3d& point, double radius) const {
  std::optional<Nearest> best;
  const auto may_be_nearer = [&](const Box& box) { return distance_to(box, point) <= (best ? best->distance : radius); };
  visit_triangles(may_be_nearer, [&](int index) {
    const double least = best ? best->distance : radius;
    const WallTriangle& t = triangles_[index];
    const Vector3d foot = nearest_on_triangle(point, t.a, t.b, t.c);
    const double distance = (point - foot).norm();
    if (distance < least) best = Nearest{foot, distance, index};
    return false;
  });
  return best;
}

std::vector<int> TriangleGrid::overlapping(const Box& box) const {
  std::vector<int> found;
  visit_triangles([&](const Box& bounds) { return meet(bounds, box.min, box.max); },
                  [&](int index) {
                    found.push_back(index);
                    return false;
                  });
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace wavetank

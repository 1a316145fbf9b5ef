#include "triangle_grid.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "polygon.h"
#include "wavetank/geometry/mesh.h"

namespace wavetank {
namespace {

constexpr double most_cells = 8e6;

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

bool selected(int owner, Walls walls) { return walls == Walls::all || (walls == Walls::tank) == (owner == 0); }

}  // namespace

TriangleGrid::TriangleGrid(const std::vector<WallTriangle>& triangles, double cell, double tolerance)
    : triangles_(triangles), tolerance_(tolerance) {
  Box all{Vector3d::Constant(std::numeric_limits<double>::infinity()), Vector3d::Constant(-std::numeric_limits<double>::infinity())};
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
    all.min = all.min.cwiseMin(p.bounds.min);
    all.max = all.max.cwiseMax(p.bounds.max);
    prepared_.push_back(p);
  }
  origin_ = all.min;
  const Vector3d extent = all.max - all.min;
  const auto cells_with = [&extent](double side) {
    return (extent / side).array().floor().unaryExpr([](double n) { return n + 1.0; }).prod();
  };
  cell_ = cell;
  while (cells_with(cell_) > most_cells) cell_ *= 1.25;
  for (int axis = 0; axis < 3; ++axis) count_[axis] = static_cast<int>(extent[axis] / cell_) + 1;

  start_.assign(static_cast<std::size_t>(count_[0]) * count_[1] * count_[2] + 1, 0);
  for (const Prepared& p : prepared_) visit_triangle(p, [this](std::size_t c) { ++start_[c + 1]; });
  for (std::size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
  content_.resize(start_.back());
  std::vector<int> next(start_.begin(), start_.end() - 1);
  for (std::size_t t = 0; t < prepared_.size(); ++t) {
    visit_triangle(prepared_[t], [&](std::size_t c) { content_[next[c]++] = static_cast<int>(t); });
  }
}

template <class Visit>
void TriangleGrid::visit_cells(const Vector3d& low, const Vector3d& high, Visit visit) const {
  int first[3], last[3];
  for (int axis = 0; axis < 3; ++axis) {
    const double from = std::floor((low[axis] - origin_[axis]) / cell_), to = std::floor((high[axis] - origin_[axis]) / cell_);
    if (to < 0 || from >= count_[axis]) return;
    first[axis] = std::max(0, static_cast<int>(from));
    last[axis] = static_cast<int>(std::min<double>(count_[axis] - 1, to));
  }
  for (int z = first[2]; z <= last[2]; ++z) {
    for (int y = first[1]; y <= last[1]; ++y) {
      for (int x = first[0]; x <= last[0]; ++x) visit((static_cast<std::size_t>(z) * count_[1] + y) * count_[0] + x);
    }
  }
}

template <class Visit>
void TriangleGrid::visit_triangle(const Prepared& t, Visit visit) const {
  const double half = 0.5 * cell_ + tolerance_;
  // A box of half side h reaches h (|nx| + |ny| + |nz|) along n: cells farther from the plane or outside of an edge than this are not met.
  const double reach = half * t.normal.lpNorm<1>();
  const double edge_reach[3] = {half * t.edge_normal[0].lpNorm<1>(), half * t.edge_normal[1].lpNorm<1>(),
                                half * t.edge_normal[2].lpNorm<1>()};
  visit_cells(t.bounds.min, t.bounds.max, [&](std::size_t cell) {
    const std::size_t index[3] = {cell % count_[0], cell / count_[0] % count_[1], cell / count_[0] / count_[1]};
    const Vector3d place(static_cast<double>(index[0]), static_cast<double>(index[1]), static_cast<double>(index[2]));
    const Vector3d centre = origin_ + cell_ * (place.array() + 0.5).matrix();
    if (std::abs(t.normal.dot(centre) - t.offset) > reach) return;
    for (int k = 0; k < 3; ++k) {
      if (t.edge_normal[k].dot(centre) - t.edge_offset[k] > edge_reach[k]) return;
    }
    visit(cell);
  });
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
  double entry;
  visit_cells(from.cwiseMin(to), from.cwiseMax(to), [&](std::size_t cell) {
    for (int i = start_[cell]; i < start_[cell + 1] && !met; ++i) {
      const int t = content_[i];
      met = selected(triangles_[t].owner, walls) && meets(prepared_[t], from, to, entry);
    }
  });
  return met;
}

std::optional<double> TriangleGrid::first_crossing(const Vector3d& from, const Vector3d& to) const {
  std::optional<double> first;
  double entry;
  visit_cells(from.cwiseMin(to), from.cwiseMax(to), [&](std::size_t cell) {
    for (int i = start_[cell]; i < start_[cell + 1]; ++i) {
      const Prepared& t = prepared_[content_[i]];
      if (!meets(t, from, to, entry)) continue;
      const double before = t.normal.dot(from) - t.offset, after = t.normal.dot(to) - t.offset;
      const double fraction =
          before * after < 0 ? before / (before - after) : entry;  // of the plane itself where the way passes through it
      if (!first || fraction < *first) first = fraction;
    }
  });
  return first;
}

std::optional<TriangleGrid::Nearest> TriangleGrid::nearest(const Vector3d& point, double radius) const {
  std::optional<Nearest> best;
  visit_cells(point.array() - radius, point.array() + radius, [&](std::size_t cell) {
    for (int i = start_[cell]; i < start_[cell + 1]; ++i) {
      const WallTriangle& t = triangles_[content_[i]];
      const Vector3d foot = nearest_on_triangle(point, t.a, t.b, t.c);
      const double distance = (point - foot).norm();
      if (distance < (best ? best->distance : radius)) best = Nearest{foot, distance};
    }
  });
  return best;
}

std::vector<int> TriangleGrid::overlapping(const Box& box) const {
  std::vector<int> found;
  visit_cells(box.min, box.max, [&](std::size_t cell) {
    for (int i = start_[cell]; i < start_[cell + 1]; ++i) {
      const Box& bounds = prepared_[content_[i]].bounds;
      if ((bounds.min.array() <= box.max.array()).all() && (bounds.max.array() >= box.min.array()).all()) found.push_back(content_[i]);
    }
  });
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace wavetank

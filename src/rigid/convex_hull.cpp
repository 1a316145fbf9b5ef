#include "convex_hull.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "wavetank/common/error.h"

namespace wavetank {
namespace {

constexpr double on_face = 1e-7;    // of the size
constexpr double one_plane = 20.0;  // times the distance at which a point counts as on a face

struct Triangle {
  int corner[3];
  int across[3];  ///< the triangle beyond the side from corner k to corner k + 1
  Vector3d normal;
  double offset;
  std::vector<int> outside;  ///< points not yet taken in that it sees
  bool alive = true;
};

/// The quickhull algorithm: takes in the point farthest from a face, until none is outside by more than may be left out.
class Quickhull {
 public:
  Quickhull(const std::vector<Vector3d>& points, double tolerance, double left_out)
      : points_(points), tolerance_(tolerance), left_out_(std::max(tolerance, left_out)) {}

  /// Whether the points enclose anything.
  bool run() {
    if (!start()) return false;
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      if (triangles_[t].alive && !triangles_[t].outside.empty()) take_in(static_cast<int>(t));
    }
    return true;
  }
  const std::vector<Triangle>& triangles() const { return triangles_; }

 private:
  double height(const Triangle& triangle, int point) const { return triangle.normal.dot(points_[point]) - triangle.offset; }

  Triangle make(int a, int b, int c) const {
    Triangle triangle{{a, b, c}, {-1, -1, -1}, Vector3d::Zero(), 0, {}};
    triangle.normal = (points_[b] - points_[a]).cross(points_[c] - points_[a]).normalized();
    triangle.offset = triangle.normal.dot(points_[a]);
    return triangle;
  }

  template <class Measure>
  int greatest(const Measure& measure) const {
    int best = 0;
    double most = -1;
    for (std::size_t p = 0; p < points_.size(); ++p) {
      const double value = measure(points_[p]);
      if (value > most) {
        most = value;
        best = static_cast<int>(p);
      }
    }
    return best;
  }

  bool start() {
    const int a = greatest([&](const Vector3d& p) { return (p - points_[0]).squaredNorm(); });
    const int b = greatest([&](const Vector3d& p) { return (p - points_[a]).squaredNorm(); });
    const Vector3d along = (points_[b] - points_[a]).normalized();
    const int c = greatest([&](const Vector3d& p) { return (p - points_[a]).cross(along).squaredNorm(); });
    if ((points_[c] - points_[a]).cross(along).norm() <= 4 * tolerance_) return false;
    const Vector3d normal = (points_[b] - points_[a]).cross(points_[c] - points_[a]).normalized();
    const int d = greatest([&](const Vector3d& p) { return std::abs(normal.dot(p - points_[a])); });
    const double rise = normal.dot(points_[d] - points_[a]);
    if (std::abs(rise) <= 4 * tolerance_) return false;
    const std::array<int, 3> base = rise < 0 ? std::array<int, 3>{a, b, c} : std::array<int, 3>{a, c, b};
    triangles_ = {make(base[0], base[1], base[2]), make(base[1], base[0], d), make(base[2], base[1], d), make(base[0], base[2], d)};
    const int across[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    for (int t = 0; t < 4; ++t) std::copy(across[t], across[t] + 3, triangles_[t].across);
    std::vector<int> all(points_.size());
    for (std::size_t p = 0; p < all.size(); ++p) all[p] = static_cast<int>(p);
    hand_out(all, 0);
    return true;
  }

  /// Gives each point to a triangle from `first` on that sees it.
  void hand_out(const std::vector<int>& points, std::size_t first) {
    for (const int point : points) {
      for (std::size_t t = first; t < triangles_.size(); ++t) {
        if (!triangles_[t].alive || height(triangles_[t], point) <= left_out_) continue;
        triangles_[t].outside.push_back(point);
        break;
      }
    }
  }

  void take_in(int seen) {
    const Triangle& first = triangles_[seen];
    const int top =
        *std::max_element(first.outside.begin(), first.outside.end(), [&](int p, int q) { return height(first, p) < height(first, q); });
    std::vector<int> visible, queue{seen}, left_over;
    triangles_[seen].alive = false;
    while (!queue.empty()) {
      const int t = queue.back();
      queue.pop_back();
      visible.push_back(t);
      for (const int other : triangles_[t].across) {
        if (!triangles_[other].alive || height(triangles_[other], top) <= tolerance_) continue;
        triangles_[other].alive = false;
        queue.push_back(other);
      }
    }
    std::map<int, int> starting, ending;  // new triangles by the corners of their base
    const std::size_t fresh = triangles_.size();
    for (const int t : visible) {
      left_over.insert(left_over.end(), triangles_[t].outside.begin(), triangles_[t].outside.end());
      for (int k = 0; k < 3; ++k) {
        const int other = triangles_[t].across[k];
        if (!triangles_[other].alive) continue;
        const int from = triangles_[t].corner[k], to = triangles_[t].corner[(k + 1) % 3], added = static_cast<int>(triangles_.size());
        triangles_.push_back(make(from, to, top));
        triangles_[added].across[0] = other;
        for (int& back : triangles_[other].across)
          if (back == t) back = added;
        starting[from] = ending[to] = added;
      }
      triangles_[t].outside.clear();
    }
    for (std::size_t t = fresh; t < triangles_.size(); ++t) {
      triangles_[t].across[1] = starting.at(triangles_[t].corner[1]);
      triangles_[t].across[2] = ending.at(triangles_[t].corner[0]);
    }
    left_over.erase(std::remove(left_over.begin(), left_over.end(), top), left_over.end());
    hand_out(left_over, fresh);
  }

  const std::vector<Vector3d>& points_;
  double tolerance_, left_out_;
  std::vector<Triangle> triangles_;
};

/// The border of a set of triangles as one loop; empty if it is not one.
std::vector<int> border(const std::vector<Triangle>& triangles, const std::vector<int>& members, const std::vector<int>& face_of,
                        int face) {
  std::map<int, int> next;
  for (const int t : members)
    for (int k = 0; k < 3; ++k)
      if (face_of[triangles[t].across[k]] != face && !next.emplace(triangles[t].corner[k], triangles[t].corner[(k + 1) % 3]).second)
        return {};
  std::vector<int> loop;
  for (int at = next.begin()->first; loop.size() < next.size(); at = next.at(at)) {
    if (next.count(at) == 0 || (!loop.empty() && at == loop.front())) return {};
    loop.push_back(at);
  }
  return loop;
}

/// Triangles of one plane become one face.
std::vector<ConvexHull::Face> merge(const std::vector<Triangle>& triangles, const std::vector<Vector3d>& points, double tolerance) {
  std::vector<std::pair<double, int>> by_size;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const int* corner = triangles[t].corner;
    const double area = (points[corner[1]] - points[corner[0]]).cross(points[corner[2]] - points[corner[0]]).norm();
    if (triangles[t].alive) by_size.emplace_back(-area, static_cast<int>(t));
  }
  std::sort(by_size.begin(), by_size.end());
  std::vector<int> face_of(triangles.size(), -1);
  std::vector<ConvexHull::Face> faces;
  int face = 0;
  const auto add = [&](const std::vector<int>& loop, const Triangle& seed) { faces.push_back({loop, seed.normal, seed.offset}); };
  for (const auto& [size, seed] : by_size) {
    if (face_of[seed] >= 0) continue;
    std::vector<int> members{seed};
    face_of[seed] = face;
    const Triangle& plane = triangles[seed];
    for (std::size_t m = 0; m < members.size(); ++m) {
      for (const int other : triangles[members[m]].across) {
        if (face_of[other] >= 0) continue;
        const auto on_plane = [&](int corner) { return std::abs(plane.normal.dot(points[corner]) - plane.offset) <= tolerance; };
        if (!std::all_of(triangles[other].corner, triangles[other].corner + 3, on_plane)) continue;
        face_of[other] = face;
        members.push_back(other);
      }
    }
    const std::vector<int> loop = border(triangles, members, face_of, face);
    if (!loop.empty()) {
      add(loop, plane);
    } else {
      for (const int t : members) add({triangles[t].corner[0], triangles[t].corner[1], triangles[t].corner[2]}, triangles[t]);
    }
    ++face;
  }
  return faces;
}

void find_edges(ConvexHull& hull) {
  std::map<std::pair<int, int>, int> left_of;
  for (std::size_t f = 0; f < hull.faces.size(); ++f) {
    const std::vector<int>& loop = hull.faces[f].loop;
    for (std::size_t k = 0; k < loop.size(); ++k) left_of[{loop[k], loop[(k + 1) % loop.size()]}] = static_cast<int>(f);
  }
  for (const auto& [ends, left] : left_of) {
    const auto right = left_of.find({ends.second, ends.first});
    if (ends.first < ends.second && right != left_of.end()) hull.edges.push_back({ends.first, ends.second, left, right->second});
  }
}

void find_volume(ConvexHull& hull, const std::vector<Triangle>& triangles, const std::vector<Vector3d>& points) {
  const Vector3d& middle = points[triangles[0].corner[0]];
  Vector3d moment = Vector3d::Zero();
  for (const Triangle& t : triangles) {
    if (!t.alive) continue;
    const Vector3d a = points[t.corner[0]] - middle, b = points[t.corner[1]] - middle, c = points[t.corner[2]] - middle;
    const double part = a.dot(b.cross(c)) / 6;
    hull.volume += part;
    moment += part / 4 * (a + b + c);
  }
  hull.centre = middle + moment / hull.volume;
}

}  // namespace

Box ConvexHull::bounding_box() const {
  Box box{vertices.front(), vertices.front()};
  for (const Vector3d& vertex : vertices) {
    box.min = box.min.cwiseMin(vertex);
    box.max = box.max.cwiseMax(vertex);
  }
  return box;
}

ConvexHull convex_hull(const std::vector<Vector3d>& points, const std::string& what, const HullPrecision& precision) {
  if (points.empty()) throw Error(what + " has no points, so that it has no shape for contacts");
  Box box{points.front(), points.front()};
  for (const Vector3d& point : points) {
    box.min = box.min.cwiseMin(point);
    box.max = box.max.cwiseMax(point);
  }
  const double size = (box.max - box.min).norm();
  const double tolerance = std::max(on_face * size, precision.rounding);
  Quickhull quickhull(points, tolerance, precision.left_out);
  if (!(size > 0) || !quickhull.run()) throw Error(what + " is flat and encloses nothing, so that it has no shape for contacts");
  ConvexHull hull;
  hull.faces = merge(quickhull.triangles(), points, one_plane * tolerance);
  find_volume(hull, quickhull.triangles(), points);
  std::map<int, int> renumbered;
  for (ConvexHull::Face& face : hull.faces) {
    for (int& corner : face.loop) {
      const auto [entry, is_new] = renumbered.emplace(corner, static_cast<int>(hull.vertices.size()));
      if (is_new) hull.vertices.push_back(points[corner]);
      corner = entry->second;
    }
  }
  hull.faces_at.resize(hull.vertices.size());
  for (std::size_t f = 0; f < hull.faces.size(); ++f)
    for (const int corner : hull.faces[f].loop) hull.faces_at[corner].push_back(static_cast<int>(f));
  find_edges(hull);
  return hull;
}

std::vector<Vector3d> shrunk(const ConvexHull& hull, double distance) {
  std::vector<Vector3d> result;
  for (std::size_t v = 0; v < hull.vertices.size(); ++v) {
    Vector3d inwards = Vector3d::Zero();
    for (const int f : hull.faces_at[v]) inwards -= hull.faces[f].normal;
    inwards.normalize();
    double least = 1;  // by how much a step along `inwards` leaves the nearest face
    for (const int f : hull.faces_at[v]) least = std::min(least, -inwards.dot(hull.faces[f].normal));
    // Towards the middle where the corner is so sharp that the faces' mean leads nowhere.
    const Vector3d to_centre = hull.centre - hull.vertices[v];
    const double step = distance / std::max(least, 0.05);
    result.push_back(hull.vertices[v] + (step < 0.5 * to_centre.norm() ? Vector3d(step * inwards) : Vector3d(0.5 * to_centre)));
  }
  return result;
}

}  // namespace wavetank

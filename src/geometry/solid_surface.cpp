#include "wavetank/geometry/solid_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "polygon.h"
#include "triangle_grid.h"

namespace wavetank {
namespace {

// of the mesh's size: corners so near to a plane lie in it, float32 files round to a tenth of that; and how far off a piece one looks
constexpr double on_plane = 1e-6, look_off = 1e-5;

/// How often a closed mesh winds about points, by the triangles over them in a direction along which no mesh has its edges.
class Windings {
 public:
  explicit Windings(const TriangleMesh& mesh) : triangles_(mesh.triangles) {
    const Eigen::Quaterniond turn = Eigen::Quaterniond(0.83, 0.291, -0.377, 0.289).normalized();
    matrix_ = turn.toRotationMatrix();
    for (const Vector3d& vertex : mesh.vertices) turned_.push_back(matrix_ * vertex);
    low_ = high_ = turned_.front().head<2>();
    for (const Vector3d& vertex : turned_) {
      low_ = low_.cwiseMin(vertex.head<2>());
      high_ = high_.cwiseMax(vertex.head<2>());
    }
    count_ = std::clamp(static_cast<int>(std::sqrt(static_cast<double>(mesh.triangles.size()))), 1, 1000);
    cells_.resize(static_cast<std::size_t>(count_) * count_);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const Vector3i& corners = mesh.triangles[t];
      Eigen::Vector2d least = turned_[corners[0]].head<2>(), most = least;
      for (int k = 1; k < 3; ++k) {
        least = least.cwiseMin(turned_[corners[k]].head<2>());
        most = most.cwiseMax(turned_[corners[k]].head<2>());
      }
      for (int j = cell(least, 1); j <= cell(most, 1); ++j)
        for (int i = cell(least, 0); i <= cell(most, 0); ++i) cells_[j * count_ + i].push_back(static_cast<int>(t));
    }
  }

  int about(const Vector3d& point) const {
    const Vector3d p = matrix_ * point;
    if ((p.head<2>().array() < low_.array()).any() || (p.head<2>().array() > high_.array()).any()) return 0;
    int number = 0;
    for (const int t : cells_[cell(p.head<2>(), 1) * count_ + cell(p.head<2>(), 0)]) {
      const Vector3i& corners = triangles_[t];
      double side[3], sum = 0;
      bool left = true, right = true;
      for (int k = 0; k < 3; ++k) {
        const int from = corners[(k + 1) % 3], to = corners[(k + 2) % 3];
        const bool forward = from < to;  // so that both triangles of an edge find the same, to the last bit
        const Vector3d &a = turned_[forward ? from : to], &b = turned_[forward ? to : from];
        const double area = (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());
        const bool is_left = (area >= 0) == forward;
        side[k] = forward ? area : -area;
        sum += side[k];
        left = left && is_left;
        right = right && !is_left;
      }
      if (!left && !right) continue;
      const double z =
          sum != 0 ? (side[0] * turned_[corners[0]].z() + side[1] * turned_[corners[1]].z() + side[2] * turned_[corners[2]].z()) / sum
                   : turned_[corners[0]].z();
      if (z > p.z()) number += left ? 1 : -1;  // seen from above it is wound to the left: the solid ends there
    }
    return number;
  }

 private:
  int cell(const Eigen::Vector2d& place, int axis) const {
    const double width = high_[axis] - low_[axis];
    return width > 0 ? std::clamp(static_cast<int>((place[axis] - low_[axis]) / width * count_), 0, count_ - 1) : 0;
  }

  std::vector<Vector3i> triangles_;
  Eigen::Matrix3d matrix_;
  std::vector<Vector3d> turned_;
  Eigen::Vector2d low_, high_;
  int count_ = 1;
  std::vector<std::vector<int>> cells_;
};

/// A line in a triangle's plane along which another one meets it, and the plane through it that stands upright there.
struct Cut {
  Vector3d from, to, across;
};

class Splitter {
 public:
  explicit Splitter(const TriangleMesh& mesh) : mesh_(mesh) {
    const Box box = mesh.bounding_box();
    size_ = (box.max - box.min).norm();
    tolerance_ = on_plane * size_;
    std::vector<WallTriangle> triangles;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      triangles.push_back({mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2), 0});
    grid_.emplace(triangles, tolerance_);
  }

  std::vector<SurfacePiece> pieces() const {
    std::vector<std::vector<Cut>> cuts(mesh_.triangles.size());
    bool any = false;
    for (std::size_t t = 0; t < cuts.size(); ++t) {
      bool lies_on_another = false;
      cuts[t] = cuts_of(t, lies_on_another);
      any = any || lies_on_another || !cuts[t].empty();
    }
    const Windings windings(mesh_);
    if (!any && !nested(windings)) return {};
    std::vector<SurfacePiece> result;
    for (std::size_t t = 0; t < cuts.size(); ++t) {
      const Polygon triangle{mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2)};
      const Vector3d normal = vector_area(triangle).normalized();
      std::vector<Polygon> parts;
      split(triangle, normal, cuts[t], parts);
      for (Polygon& part : parts) {
        const Vector3d middle = centroid(part), off = look_off * size_ * normal;
        const int outside = windings.about(middle + off), within = windings.about(middle - off);
        const int step = (within > 0 ? 1 : 0) - (outside > 0 ? 1 : 0);
        if (step != 0) result.push_back({std::move(part), static_cast<double>(step) / (within - outside)});
      }
    }
    return result;
  }

 private:
  /// Of surfaces that do not meet: whether one of them lies within a solid without bounding it.
  bool nested(const Windings& windings) const {
    std::vector<int> root(mesh_.vertices.size());
    std::iota(root.begin(), root.end(), 0);
    const auto find = [&](int v) {
      while (root[v] != v) v = root[v] = root[root[v]];
      return v;
    };
    for (const Vector3i& t : mesh_.triangles)
      for (int k = 0; k < 3; ++k) root[find(t[k])] = find(t[(k + 1) % 3]);
    std::map<int, std::size_t> largest;  // triangle of each surface
    std::vector<double> size(mesh_.triangles.size());
    for (std::size_t t = 0; t < size.size(); ++t) {
      size[t] = vector_area({mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2)}).norm();
      const auto [entry, is_new] = largest.emplace(find(mesh_.triangles[t][0]), t);
      if (!is_new && size[t] > size[entry->second]) entry->second = t;
    }
    return largest.size() > 1 && std::any_of(largest.begin(), largest.end(), [&](const auto& entry) {
             const Polygon triangle{mesh_.corner(entry.second, 0), mesh_.corner(entry.second, 1), mesh_.corner(entry.second, 2)};
             const Vector3d off = look_off * size_ * vector_area(triangle).normalized();
             return (windings.about(centroid(triangle) + off) > 0) == (windings.about(centroid(triangle) - off) > 0);
           });
  }

  std::vector<Cut> cuts_of(std::size_t t, bool& lies_on_another) const {
    const Polygon own{mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2)};
    const Vector3d normal = vector_area(own).normalized();
    Box bounds{own[0].cwiseMin(own[1]).cwiseMin(own[2]), own[0].cwiseMax(own[1]).cwiseMax(own[2])};
    bounds.min.array() -= tolerance_;
    bounds.max.array() += tolerance_;
    std::vector<Cut> cuts;
    for (const int other : grid_->overlapping(bounds)) {
      if (other == static_cast<int>(t)) continue;
      const WallTriangle& u = grid_->triangles()[other];
      const Vector3d* corner[3] = {&u.a, &u.b, &u.c};
      double height[3];
      int in_plane = 0;
      for (int k = 0; k < 3; ++k) {
        height[k] = normal.dot(*corner[k] - own[0]);
        if (std::abs(height[k]) <= tolerance_) height[k] = 0;
        in_plane += height[k] == 0 ? 1 : 0;
      }
      if (in_plane == 3) {
        for (int k = 0; k < 3; ++k) add(*corner[k], *corner[(k + 1) % 3], own, normal, cuts);
        lies_on_another = lies_on_another || overlap(own, {u.a, u.b, u.c}, normal);
        continue;
      }
      Vector3d point[3];
      int found = 0;
      for (int k = 0; k < 3; ++k) {
        const int next = (k + 1) % 3;
        if ((height[k] < 0) == (height[next] < 0)) continue;
        point[found++] = *corner[k] + height[k] / (height[k] - height[next]) * (*corner[next] - *corner[k]);
      }
      if (found == 2) add(point[0], point[1], own, normal, cuts);
    }
    return cuts;
  }

  void add(const Vector3d& from, const Vector3d& to, const Polygon& own, const Vector3d& normal, std::vector<Cut>& cuts) const {
    if ((to - from).norm() <= 2 * tolerance_) return;
    const Cut cut{from, to, normal.cross(to - from).normalized()};
    if (length_within(own, normal, cut) > 2 * tolerance_) cuts.push_back(cut);
  }

  /// How much of a cut lies in the polygon, off its border.
  double length_within(const Polygon& polygon, const Vector3d& normal, const Cut& cut) const {
    double enter = 0, leave = 1;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Vector3d edge = polygon[(k + 1) % polygon.size()] - polygon[k];
      if (edge.norm() <= 1e-3 * tolerance_) continue;
      const Vector3d inwards = normal.cross(edge).normalized();
      const double first = inwards.dot(cut.from - polygon[k]) - 2 * tolerance_, last = inwards.dot(cut.to - polygon[k]) - 2 * tolerance_;
      if (first <= 0 && last <= 0) return 0;
      if (first < 0) enter = std::max(enter, first / (first - last));
      if (last < 0) leave = std::min(leave, first / (first - last));
    }
    return std::max(0.0, leave - enter) * (cut.to - cut.from).norm();
  }

  /// Whether two polygons of one plane have more in common than their borders.
  bool overlap(Polygon a, const Polygon& b, const Vector3d& normal) const {
    const double turn = vector_area(b).dot(normal) > 0 ? 1 : -1;
    for (std::size_t k = 0; k < b.size() && a.size() > 2; ++k) {
      const Vector3d outwards = turn * (b[(k + 1) % b.size()] - b[k]).cross(normal).normalized();
      a = part_below(a, outwards, outwards.dot(b[k]) - 2 * tolerance_, 1e-3 * tolerance_);
    }
    return a.size() > 2 && vector_area(a).norm() > tolerance_ * tolerance_;
  }

  /// Along the longest cut first, and each part by what still crosses it.
  void split(const Polygon& polygon, const Vector3d& normal, const std::vector<Cut>& cuts, std::vector<Polygon>& parts) const {
    std::vector<Cut> own;
    double longest = 2 * tolerance_;
    std::size_t first = 0;
    for (const Cut& cut : cuts) {
      const double length = length_within(polygon, normal, cut);
      if (length <= 2 * tolerance_) continue;
      if (length > longest) {
        longest = length;
        first = own.size();
      }
      own.push_back(cut);
    }
    if (own.empty()) {
      parts.push_back(polygon);
      return;
    }
    const Cut cut = own[first];
    own.erase(own.begin() + static_cast<std::ptrdiff_t>(first));
    for (const double side : {1.0, -1.0}) {
      const Polygon part = part_below(polygon, side * cut.across, side * cut.across.dot(cut.from), 0.01 * tolerance_);
      if (part.size() > 2) split(part, normal, own, parts);
    }
  }

  const TriangleMesh& mesh_;
  double size_ = 0, tolerance_ = 0;
  std::optional<TriangleGrid> grid_;
};

}  // namespace

std::vector<TriangleMesh> closed_surfaces(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, std::vector<int>> at_edge;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) at_edge[std::minmax(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3])].push_back(static_cast<int>(t));
  std::vector<int> root(mesh.triangles.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int t) {
    while (root[t] != t) t = root[t] = root[root[t]];
    return t;
  };
  for (const auto& [edge, around] : at_edge)
    if (around.size() == 2) root[find(around[0])] = find(around[1]);
  std::map<int, TriangleMesh> by_root;
  std::map<int, std::map<std::pair<int, int>, int>> balance;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const int own = find(static_cast<int>(t));
    by_root[own].triangles.push_back(mesh.triangles[t]);
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      balance[own][std::minmax(a, b)] += a < b ? 1 : -1;
    }
  }
  std::vector<TriangleMesh> surfaces;
  for (auto& [own, surface] : by_root) {
    for (const auto& [edge, count] : balance[own])
      if (count != 0) return {};
    std::map<int, int> index;  // only the vertices that it has
    surface.name = mesh.name;
    for (Vector3i& triangle : surface.triangles)
      for (int k = 0; k < 3; ++k) {
        const auto [entry, is_new] = index.emplace(triangle[k], static_cast<int>(surface.vertices.size()));
        if (is_new) surface.vertices.push_back(mesh.vertices[triangle[k]]);
        triangle[k] = entry->second;
      }
    surfaces.push_back(std::move(surface));
  }
  return surfaces;
}

class SolidTest::Windings : public wavetank::Windings {
  using wavetank::Windings::Windings;
};
SolidTest::SolidTest(const TriangleMesh& closed) : windings_(std::make_unique<Windings>(closed)) {}
SolidTest::~SolidTest() = default;
SolidTest::SolidTest(SolidTest&&) noexcept = default;
bool SolidTest::holds(const Vector3d& point) const { return windings_->about(point) > 0; }

std::vector<SurfacePiece> solid_surface(const TriangleMesh& closed) {
  if (closed.triangles.empty()) return {};
  return Splitter(closed).pieces();
}

}  // namespace wavetank

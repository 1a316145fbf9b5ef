#include "convex_cutting.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <unordered_map>

#include "wavetank/common/error.h"

namespace wavetank {
namespace {

constexpr double on_plane = 5e-6;        // of the solid's size: corners so near to a plane lie in it
constexpr double enough = 0.02;          // of the solid's volume: what the hulls may hold beyond the pieces
constexpr double enough_of_many = 0.04;  // where there are `many` parts
constexpr double enough_of_joined = 0.03;
constexpr double least_piece = 1e-7;  // of the solid's volume: smaller pieces are what rounding leaves
constexpr double of_finished = 0.3;   // how much a piece that is convex counts for a cut, against the volume that it gains
constexpr double finished = 1e-3;     // of a piece's volume
constexpr std::size_t many = 64, most = 500;
constexpr std::size_t most_planes = 24;

/// A flat face of a piece: any region of a plane, with holes and islands, by its directed borders.
struct Face {
  Vector3d normal;
  double offset = 0;
  std::vector<std::array<int, 2>> border;  ///< from and to, the face on the left seen from outside
};

struct Piece {
  std::vector<Face> faces;
  double volume = 0;
  std::optional<ConvexHull> hull;
  double excess() const { return hull ? std::max(hull->volume - volume, 0.0) : 0.0; }
};

struct Plane {
  Vector3d normal;
  double offset;
};

/// Takes out what runs along the same way to and fro.
void cancel(std::vector<std::array<int, 2>>& border) {
  std::map<std::array<int, 2>, int> count;
  for (const auto& [from, to] : border) {
    if (from == to) continue;
    if (from < to)
      ++count[{from, to}];
    else
      --count[{to, from}];
  }
  border.clear();
  for (const auto& [ends, times] : count)
    for (int k = 0; k < std::abs(times); ++k) border.push_back(times > 0 ? ends : std::array<int, 2>{ends[1], ends[0]});
}

/// Cuts solids with planes. All pieces share their corners, so that borders fit together corner by corner whatever rounding does.
class Cutter {
 public:
  Cutter(const TriangleMesh& solid, const HullPrecision& precision, const std::string& what)
      : points_(solid.vertices), precision_(precision), what_(what) {
    const Box box = solid.bounding_box();
    tolerance_ = std::max(on_plane * (box.max - box.min).norm(), 4 * precision.rounding);
    Piece whole;
    whole.faces = flat_faces(solid);
    measure(whole);
    volume_ = whole.volume;
    if (whole.hull) pieces_.push_back(std::move(whole));
  }

  std::vector<ConvexHull> run() {
    while (!pieces_.empty() && pieces_.size() < most) {
      double excess = 0;
      std::size_t worst = 0;
      for (std::size_t p = 0; p < pieces_.size(); ++p) {
        excess += pieces_[p].excess();
        if (pieces_[p].excess() > pieces_[worst].excess()) worst = p;
      }
      if (excess <= (pieces_.size() < many ? enough : enough_of_many) * volume_) break;
      std::vector<Piece> halves = best_cut(pieces_[worst]);
      if (halves.empty()) break;
      pieces_[worst] = std::move(halves.back());
      halves.pop_back();
      for (Piece& half : halves) pieces_.push_back(std::move(half));
    }
    join();
    std::vector<ConvexHull> result;
    for (Piece& piece : pieces_) result.push_back(std::move(*piece.hull));
    return result;
  }

 private:
  /// Triangles of one plane as one face.
  std::vector<Face> flat_faces(const TriangleMesh& solid) const {
    std::vector<std::pair<double, std::size_t>> by_size;
    for (std::size_t t = 0; t < solid.triangles.size(); ++t) {
      const Vector3d a = solid.corner(t, 0);
      by_size.emplace_back(-(solid.corner(t, 1) - a).cross(solid.corner(t, 2) - a).norm(), t);
    }
    std::sort(by_size.begin(), by_size.end());
    std::vector<Face> faces;
    for (const auto& [size, t] : by_size) {
      if (size == 0) continue;
      const Vector3d a = solid.corner(t, 0), b = solid.corner(t, 1), c = solid.corner(t, 2), normal = (b - a).cross(c - a).normalized();
      const auto holds = [&](const Face& face) {
        const auto near = [&](const Vector3d& p) { return std::abs(face.normal.dot(p) - face.offset) <= 0.5 * tolerance_; };
        return face.normal.dot(normal) > 0.5 && near(a) && near(b) && near(c);
      };
      auto found = std::find_if(faces.begin(), faces.end(), holds);
      if (found == faces.end()) found = faces.insert(faces.end(), Face{normal, normal.dot(a), {}});
      const Vector3i& corners = solid.triangles[t];
      for (int k = 0; k < 3; ++k) found->border.push_back({corners[k], corners[(k + 1) % 3]});
    }
    for (Face& face : faces) cancel(face.border);
    return faces;
  }

  double area(const Face& face) const {
    if (face.border.empty()) return 0;
    const Vector3d& base = points_[face.border.front()[0]];
    Vector3d sum = Vector3d::Zero();
    for (const auto& [from, to] : face.border) sum += (points_[from] - base).cross(points_[to] - base);
    return 0.5 * face.normal.dot(sum);
  }

  /// Its corners, each once.
  std::vector<int> corners(const Piece& piece) const {
    std::vector<int> result;
    for (const Face& face : piece.faces)
      for (const auto& ends : face.border) result.push_back(ends[0]);
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  }

  std::optional<ConvexHull> hull_of(const std::vector<int>& corners) const {
    std::vector<Vector3d> places;
    for (const int corner : corners) places.push_back(points_[corner]);
    try {
      return convex_hull(places, what_, precision_);
    } catch (const Error&) {  // flat
      return std::nullopt;
    }
  }

  void measure(Piece& piece) const {
    piece.faces.erase(std::remove_if(piece.faces.begin(), piece.faces.end(), [](const Face& face) { return face.border.empty(); }),
                      piece.faces.end());
    if (piece.faces.empty()) return;
    const Vector3d& base = points_[piece.faces.front().border.front()[0]];
    for (const Face& face : piece.faces) piece.volume += (face.offset - face.normal.dot(base)) * area(face) / 3;
    piece.hull = hull_of(corners(piece));
  }

  double height(const Plane& plane, int corner) const { return plane.normal.dot(points_[corner]) - plane.offset; }

  /// The piece's part below a plane and that above it; one that encloses nothing has no hull.
  std::array<Piece, 2> cut(const Piece& piece, const Plane& plane) {
    std::unordered_map<std::uint64_t, int> crossings;
    const auto above = [&](int corner) { return height(plane, corner) > tolerance_; };
    const auto crossing = [&](int low, int high) {
      if (std::abs(height(plane, low)) <= tolerance_) return low;
      const std::uint64_t key = static_cast<std::uint64_t>(std::min(low, high)) << 32 | static_cast<std::uint32_t>(std::max(low, high));
      const auto [entry, is_new] = crossings.emplace(key, static_cast<int>(points_.size()));
      if (is_new) {
        const double below = -height(plane, low), over = height(plane, high);
        const Vector3d point = points_[low] + below / (below + over) * (points_[high] - points_[low]);
        points_.push_back(point);
      }
      return entry->second;
    };
    Piece parts[2];
    Face lid{plane.normal, plane.offset, {}}, floor{-plane.normal, -plane.offset, {}};
    for (const Face& face : piece.faces) {
      std::size_t over = 0;
      bool in_plane = true;
      for (const auto& ends : face.border) {
        over += above(ends[0]) ? 1 : 0;
        in_plane = in_plane && std::abs(height(plane, ends[0])) <= tolerance_;
      }
      if (in_plane) {  // with the lid, so that what has no thickness cancels
        lid.border.insert(lid.border.end(), face.border.begin(), face.border.end());
        continue;
      }
      if (over == 0 || over == face.border.size()) {
        parts[over == 0 ? 0 : 1].faces.push_back(face);
        continue;
      }
      Face low{face.normal, face.offset, {}}, high = low;
      std::vector<std::pair<int, int>> ends;  // where the border leaves the lower part (+1) and comes back (−1)
      for (const auto& [from, to] : face.border) {
        if (above(from) == above(to)) {
          (above(from) ? high : low).border.push_back({from, to});
        } else if (above(to)) {
          const int c = crossing(from, to);
          low.border.push_back({from, c});
          high.border.push_back({c, to});
          ends.emplace_back(c, 1);
        } else {
          const int c = crossing(to, from);
          high.border.push_back({from, c});
          low.border.push_back({c, to});
          ends.emplace_back(c, -1);
        }
      }
      const Vector3d along = plane.normal.cross(face.normal);
      std::sort(ends.begin(), ends.end(), [&](const auto& a, const auto& b) {
        const double first = along.dot(points_[a.first]), second = along.dot(points_[b.first]);
        return first < second || (first == second && a.first < b.first);
      });
      int times = 0;
      for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
        times += ends[k].second;
        const std::array<int, 2> way{ends[k].first, ends[k + 1].first}, back{way[1], way[0]};
        for (int n = 0; n < std::abs(times); ++n) {
          low.border.push_back(times > 0 ? way : back);
          high.border.push_back(times > 0 ? back : way);
          lid.border.push_back(times > 0 ? back : way);
          floor.border.push_back(times > 0 ? way : back);
        }
      }
      cancel(low.border);
      cancel(high.border);
      parts[0].faces.push_back(std::move(low));
      parts[1].faces.push_back(std::move(high));
    }
    cancel(lid.border);
    cancel(floor.border);
    parts[0].faces.push_back(std::move(lid));
    parts[1].faces.push_back(std::move(floor));
    for (Piece& part : parts) measure(part);
    return {std::move(parts[0]), std::move(parts[1])};
  }

  /// Of faces that more of the piece lies before, the largest of them, and across the hull in its main directions.
  std::vector<Plane> planes(const Piece& piece) const {
    const std::vector<int> own = corners(piece);
    std::vector<std::pair<double, Plane>> found;
    for (const Face& face : piece.faces) {
      double over = 0, under = 0;
      const Plane plane{face.normal, face.offset};
      for (const int corner : own) {
        over = std::max(over, height(plane, corner));
        under = std::max(under, -height(plane, corner));
      }
      if (over <= 2 * tolerance_ || under <= 2 * tolerance_) continue;
      found.emplace_back(-over * std::abs(area(face)), plane);
    }
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<Plane> result;
    for (const auto& [weight, plane] : found) {
      const Plane& candidate = plane;
      const auto same = [&](const Plane& other) {
        return other.normal.dot(candidate.normal) > 1 - 1e-9 && std::abs(other.offset - candidate.offset) < tolerance_;
      };
      if (result.size() < most_planes && std::none_of(result.begin(), result.end(), same)) result.push_back(plane);
    }
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const Vector3d& vertex : piece.hull->vertices) spread += (vertex - piece.hull->centre) * (vertex - piece.hull->centre).transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> directions(spread);
    for (int k = 0; k < 3; ++k) {
      const Vector3d normal = directions.eigenvectors().col(k);
      result.push_back({normal, normal.dot(piece.hull->centre)});
    }
    return result;
  }

  /// The cut after which the hulls hold least beyond the pieces, and that finishes most of the piece.
  std::vector<Piece> best_cut(const Piece& piece) {
    std::vector<Piece> best;
    double best_gain = -1e300;
    for (const Plane& plane : planes(piece)) {
      const std::size_t before = points_.size();
      std::array<Piece, 2> halves = cut(piece, plane);
      double gain = 0;
      bool both = true;
      for (const Piece& half : halves) {
        both = both && half.hull && half.volume > least_piece * volume_;
        gain -= half.excess();
        if (half.excess() <= finished * half.volume) gain += of_finished * half.volume;
      }
      if (both && gain > best_gain) {
        best_gain = gain;
        best.clear();
        for (Piece& half : halves) best.push_back(std::move(half));
      } else {
        points_.resize(before);
      }
    }
    return best;
  }

  /// Takes neighbours together whose common hull holds hardly more than they do.
  void join() {
    if (pieces_.size() > many) return;
    double left = enough_of_joined * volume_;  // what may be added yet
    for (const Piece& piece : pieces_) left -= piece.excess();
    const double largest = 0.1 * enough * volume_;
    const auto joined = [&](std::size_t p, std::size_t q) {
      const Piece &a = pieces_[p], &b = pieces_[q];
      Piece both;
      const Box first = a.hull->bounding_box(), second = b.hull->bounding_box();
      for (int axis = 0; axis < 3; ++axis)
        if (first.min[axis] > second.max[axis] + tolerance_ || second.min[axis] > first.max[axis] + tolerance_) return both;
      both.volume = a.volume + b.volume;
      std::vector<Vector3d> places = a.hull->vertices;
      places.insert(places.end(), b.hull->vertices.begin(), b.hull->vertices.end());
      both.hull = convex_hull(places, what_, precision_);
      return both;
    };
    for (std::size_t p = 0; p < pieces_.size(); ++p)
      for (std::size_t q = p + 1; q < pieces_.size();) {
        Piece both = joined(p, q);
        const double more = both.hull ? both.excess() - pieces_[p].excess() - pieces_[q].excess() : 1e300;
        if (more > std::min(left, largest)) {
          ++q;
          continue;
        }
        left -= more;
        pieces_[p] = std::move(both);
        pieces_.erase(pieces_.begin() + static_cast<std::ptrdiff_t>(q));
        q = p + 1;
      }
  }

  std::vector<Vector3d> points_;
  HullPrecision precision_;
  std::string what_;
  double tolerance_ = 0, volume_ = 0;
  std::vector<Piece> pieces_;
};

}  // namespace

std::vector<ConvexHull> convex_parts(const TriangleMesh& solid, const HullPrecision& precision, const std::string& what) {
  return Cutter(solid, precision, what).run();
}

}  // namespace wavetank

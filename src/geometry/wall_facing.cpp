#include "wall_facing.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>

#include "slow_work.h"

namespace wavetank {
namespace {

constexpr double lift = 0.01;           // of the spacing: how far in front of a patch one looks about
constexpr double narrow_gap = 1.1;      // of the flood's voxels: from a wall in a narrower one no place that it has passed may be in sight
constexpr double large_piece = 3;       // of the spacing: elements are smaller
constexpr std::size_t most_cuts = 24;   // lines that split one patch
constexpr double small_element = 0.35;  // of the spacing squared: smaller elements of curved walls are joined
constexpr double joined_cosine = 0.94;  // elements that face within 20° of each other may be

/// An element in the making.
struct Facing {
  Vector3d moment = Vector3d::Zero();  ///< Σ area × centre
  Vector3d flux = Vector3d::Zero();    ///< Σ area × normal, out of the fluid
  double area = 0;
  double divergence = 0;  ///< Σ area × centre · normal
  Polygon corners;        ///< of its pieces

  void add(const Polygon& piece, const Vector3d& normal_out, double factor) {
    const double part = factor * vector_area(piece).norm();
    const Vector3d centre = centroid(piece);
    moment += part * centre;
    flux += part * normal_out;
    area += part;
    divergence += part * centre.dot(normal_out);
    corners.insert(corners.end(), piece.begin(), piece.end());
  }

  void add(const Facing& other) {
    moment += other.moment;
    flux += other.flux;
    area += other.area;
    divergence += other.divergence;
    corners.insert(corners.end(), other.corners.begin(), other.corners.end());
  }
};

class Facer {
 public:
  Facer(const OpenSpace& open, const TriangleGrid& grid, double spacing, WallSource source)
      : open_(open), grid_(grid), spacing_(spacing), source_(source) {}

  /// The part of the patch that fluid on the side of its pieces' normals (times `sign`) wets.
  Facing face(const WallPatch& patch, double sign) const {
    Facing result;
    for (const Polygon& piece : patch.pieces) {
      const Vector3d area = vector_area(piece);
      if (area.norm() <= 0) continue;
      const Vector3d to_fluid = sign * area.normalized();
      for (const Polygon& part : wet_parts(piece, to_fluid)) result.add(part, -to_fluid, patch.area_factor);
    }
    return result;
  }

  /// The parts of the piece that fluid on the side of `to_fluid` wets. Where all of it is wetted though a thin wall stands on it, that is
  /// the piece itself, or with `keep_apart` still the parts on either side.
  std::vector<Polygon> wet_parts(const Polygon& piece, const Vector3d& to_fluid, bool keep_apart = false) const {
    const std::vector<Vector3d> cuts = cutting_planes(piece, to_fluid);
    if (cuts.empty()) return wetted(piece, to_fluid) ? std::vector<Polygon>{piece} : std::vector<Polygon>{};
    std::vector<Polygon> parts;
    const bool too_many = cuts.size() >= 2 * most_cuts && vector_area(piece).norm() > spacing_ * spacing_;
    std::vector<Polygon> wet;
    if (too_many) {  // a large piece under a curved body: in halves
      parts = halves(piece);
      bool whole = true;
      for (const Polygon& half : parts) {
        const std::vector<Polygon> of_half = wet_parts(half, to_fluid, keep_apart);
        whole = whole && of_half.size() == 1 && of_half.front().size() == half.size() && of_half.front().front() == half.front();
        wet.insert(wet.end(), of_half.begin(), of_half.end());
      }
      if (whole) wet.assign(1, piece);
      return wet;
    }
    parts = split(piece, cuts);
    for (const Polygon& part : parts) {
      if (wetted(part, to_fluid)) wet.push_back(part);
    }
    if (!keep_apart && wet.size() == parts.size()) wet.assign(1, piece);
    return wet;
  }

 private:
  static Vector3d longest_side(const Polygon& piece) {
    Vector3d longest = Vector3d::Zero();
    for (std::size_t k = 0; k < piece.size(); ++k) {
      const Vector3d edge = piece[(k + 1) % piece.size()] - piece[k];
      if (edge.norm() > longest.norm()) longest = edge;
    }
    return longest;
  }

  std::vector<Polygon> halves(const Polygon& piece) const {
    const Vector3d longest = longest_side(piece);
    const double offset = longest.normalized().dot(centroid(piece));
    std::vector<Polygon> result;
    for (const double side : {1.0, -1.0}) {
      Polygon half = part_below(piece, side * longest.normalized(), side * offset, 1e-6 * spacing_);
      if (half.size() > 2) result.push_back(std::move(half));
    }
    return result;
  }

  bool wetted(const Polygon& piece, const Vector3d& to_fluid) const {
    const Vector3d centre = centroid(piece), from = centre + lift * spacing_ * to_fluid;
    // At a sharp edge another face may pass between the piece and the place in front of it.
    if (grid_.crosses(centre + 3 * grid_.tolerance() * to_fluid, from)) return false;
    for (const double ahead : {0.6, 1.0, 0.3}) {
      if (open_.reached(from, centre + ahead * spacing_ * to_fluid)) return !covered(centre, to_fluid);
    }
    return looks_out_of_gap(piece, from, to_fluid) && !covered(centre, to_fluid);
  }

  /// Whether a place just in front of the piece is in a narrow gap, and open space can be seen along that: between two owners' walls, or,
  /// of a piece so large that most of it may be elsewhere, between any.
  bool looks_out_of_gap(const Polygon& piece, const Vector3d& from, const Vector3d& to_fluid) const {
    const Vector3d ahead = narrow_gap * open_.voxel() * to_fluid;
    const auto across = grid_.first_crossing(from, from + ahead);
    if (!across) return false;
    if (grid_.triangles()[across->triangle].owner == source_.owner && longest_side(piece).norm() <= large_piece * spacing_) return false;
    const Vector3d middle = from + 0.5 * across->fraction * ahead;
    const bool flat = open_.dimensions() == 2;
    const Vector3d along = flat ? to_fluid.cross(Vector3d::UnitY()) : to_fluid.unitOrthogonal(), aside = to_fluid.cross(along);
    const int ways = flat ? 2 : 8;
    for (int k = 0; k < ways; ++k) {
      const double angle = 2 * M_PI * k / ways;
      const Vector3d step = spacing_ * (std::cos(angle) * along + (flat ? 0 : std::sin(angle)) * aside);
      for (Vector3d place = middle; open_.holds(place + step) && !grid_.crosses(place, place + step);) {
        place += step;
        if (open_.reached(place, place)) return true;
      }
    }
    return false;
  }

  /// Whether it is another solid's that lies in its plane. Water is before both, so both are behind it, and one of them is enough.
  bool covered(const Vector3d& centre, const Vector3d& to_fluid) const {
    const Vector3d margin = Vector3d::Constant(grid_.tolerance());
    for (const int t : grid_.overlapping({centre - margin, centre + margin})) {
      const WallTriangle& other = grid_.triangles()[t];
      if (comes_first(other, to_fluid, to_fluid.dot(centre)) &&
          (nearest_on_triangle(centre, other.a, other.b, other.c) - centre).norm() <= grid_.tolerance())
        return true;
    }
    return false;
  }

  /// Of two solids whose faces lie on each other the first one keeps its own.
  bool comes_first(const WallTriangle& other, const Vector3d& normal, double level) const {
    if (other.owner == 0 || std::pair(other.owner, other.surface) >= std::pair(source_.owner, source_.surface)) return false;
    return std::abs(normal.dot(other.a) - level) <= grid_.tolerance() && std::abs(normal.dot(other.b) - level) <= grid_.tolerance() &&
           std::abs(normal.dot(other.c) - level) <= grid_.tolerance();
  }

  /// Lines in which other walls cross the plane just in front of the piece; each as two vectors: a point, and the normal of the plane
  /// through the line that stands upright on the piece.
  std::vector<Vector3d> cutting_planes(const Polygon& piece, const Vector3d& to_fluid) const {
    Box bounds{piece[0], piece[0]};
    for (const Vector3d& p : piece) {
      bounds.min = bounds.min.cwiseMin(p);
      bounds.max = bounds.max.cwiseMax(p);
    }
    const Vector3d margin = Vector3d::Constant(2 * lift * spacing_);
    bounds.min -= margin;
    bounds.max += margin;
    const double level = to_fluid.dot(piece[0]) + lift * spacing_;
    std::vector<std::pair<double, std::pair<Vector3d, Vector3d>>> found;  // length inside the piece, line
    const auto add = [&](const Vector3d& from, const Vector3d& to) {
      const Vector3d across = to_fluid.cross(to - from).normalized();
      const double inside = length_inside(piece, to_fluid, from, to);
      if (inside > 1e-6 * spacing_) found.push_back({inside, {from, across}});
    };
    for (const int t : grid_.overlapping(bounds)) {
      Vector3d from, to;
      const WallTriangle& other = grid_.triangles()[t];
      if (section(other, to_fluid, level, from, to)) add(from, to);
      if (!comes_first(other, to_fluid, to_fluid.dot(piece[0]))) continue;
      add(other.a, other.b);
      add(other.b, other.c);
      add(other.c, other.a);
    }
    if (found.size() > most_cuts) {
      std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
      found.resize(most_cuts);
    }
    std::vector<Vector3d> planes;
    for (const auto& [length, line] : found) {
      planes.push_back(line.first);
      planes.push_back(line.second);
    }
    return planes;
  }

  /// The segment in which a triangle crosses the plane normal · x = level.
  static bool section(const WallTriangle& t, const Vector3d& normal, double level, Vector3d& from, Vector3d& to) {
    const Vector3d* corner[3] = {&t.a, &t.b, &t.c};
    double height[3];
    for (int k = 0; k < 3; ++k) height[k] = normal.dot(*corner[k]) - level;
    Vector3d point[3];
    int found = 0;
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3;
      if ((height[k] < 0) == (height[next] < 0)) continue;
      point[found++] = *corner[k] + height[k] / (height[k] - height[next]) * (*corner[next] - *corner[k]);
    }
    if (found != 2) return false;
    from = point[0];
    to = point[1];
    return (to - from).norm() > 0;
  }

  /// How much of a segment lies strictly inside the piece when seen along its normal.
  double length_inside(const Polygon& piece, const Vector3d& normal, const Vector3d& from, const Vector3d& to) const {
    double enter = 0, leave = 1;
    const double turn = vector_area(piece).dot(normal) > 0 ? 1 : -1;
    for (std::size_t k = 0; k < piece.size(); ++k) {
      const Vector3d edge = piece[(k + 1) % piece.size()] - piece[k];
      if (edge.norm() == 0) continue;
      const Vector3d inwards = turn * normal.cross(edge).normalized();
      const double margin = 1e-4 * spacing_;  // a wall along the piece's edge does not cut it
      const double first = inwards.dot(from - piece[k]) - margin, last = inwards.dot(to - piece[k]) - margin;
      if (first <= 0 && last <= 0) return 0;
      if (first < 0) enter = std::max(enter, first / (first - last));
      if (last < 0) leave = std::min(leave, first / (first - last));
    }
    return std::max(0.0, leave - enter) * (to - from).norm();
  }

  std::vector<Polygon> split(const Polygon& piece, const std::vector<Vector3d>& cuts) const {
    std::vector<Polygon> parts = {piece};
    for (std::size_t c = 0; c < cuts.size(); c += 2) {
      const Vector3d& normal = cuts[c + 1];
      const double offset = normal.dot(cuts[c]);
      std::vector<Polygon> next;
      for (const Polygon& part : parts) {
        for (const double side : {1.0, -1.0}) {
          Polygon half = part_below(part, side * normal, side * offset, 1e-6 * spacing_);
          if (half.size() > 2) next.push_back(std::move(half));
        }
      }
      parts = std::move(next);
    }
    return parts;
  }

  const OpenSpace& open_;
  const TriangleGrid& grid_;
  double spacing_;
  WallSource source_;
};

struct Unfinished {
  Facing facing;
  Vector3d tangent;
  bool joinable = false;
};

/// Joins small elements of curved walls that lie in one cell of the spacing and face the same way, so that a finely triangulated hull does
/// not get an element a triangle. Area vectors are added: the flux through a closed surface stays zero; and the joined element stands off
/// its pieces' mean so that their Σ area × centre · normal, three times the enclosed volume, stays as well.
void join_small(std::vector<Unfinished>& elements, double spacing, const Vector3d& origin) {
  std::unordered_map<std::int64_t, std::vector<std::size_t>> cells;
  std::vector<Unfinished> result;
  for (const Unfinished& element : elements) {
    if (!element.joinable) {
      result.push_back(element);
      continue;
    }
    const Eigen::Array3d cell = ((element.facing.moment / element.facing.area - origin) / spacing).array() + 1e-6;
    const auto at = [&cell](int axis) { return static_cast<std::int64_t>(std::floor(cell[axis])); };
    std::vector<std::size_t>& here = cells[(at(0) * 2097152 + at(1)) * 2097152 + at(2)];
    const auto fits = [&](std::size_t other) {
      const Facing& joined = result[other].facing;
      return joined.area + element.facing.area <= 1.2 * spacing * spacing &&
             joined.flux.normalized().dot(element.facing.flux.normalized()) > joined_cosine;
    };
    const auto found = std::find_if(here.begin(), here.end(), fits);
    if (found == here.end()) {
      here.push_back(result.size());
      result.push_back(element);
    } else {
      result[*found].facing.add(element.facing);
    }
  }
  elements = std::move(result);
}

/// Gives the element the sides of a rectangle of its area and of the proportions of what it stands for.
void fit_rectangle(WallElement& wall, const Polygon& corners) {
  const Vector3d axis[2] = {wall.tangent, wall.normal.cross(wall.tangent)};
  double extent[2], reach[2];
  for (int k = 0; k < 2; ++k) {
    double least = 0, most = 0;
    for (const Vector3d& corner : corners) {
      least = std::min(least, axis[k].dot(corner - wall.centre));
      most = std::max(most, axis[k].dot(corner - wall.centre));
    }
    extent[k] = most - least;
    reach[k] = std::max(most, -least);
  }
  wall.elongation = extent[0] / extent[1];
  const double half[2] = {0.5 * std::sqrt(wall.area * wall.elongation), 0.5 * std::sqrt(wall.area / wall.elongation)};
  for (int k = 0; k < 2; ++k) wall.gap[k] = std::max(reach[k] - half[k], 0.0);
}

/// The segment that a ribbon across the x–z plane stands for.
Facet segment_of(const Polygon& ribbon, const Vector3d& along) {
  Facet facet;
  double least = std::numeric_limits<double>::max(), most = -least;
  for (const Vector3d& corner : ribbon) {
    const double at = along.dot(corner);
    const Vector3d in_plane(corner.x(), 0, corner.z());
    if (at < least) facet.corners[0] = in_plane;
    if (at > most) facet.corners[1] = in_plane;
    least = std::min(least, at);
    most = std::max(most, at);
  }
  facet.corners[2] = facet.corners[1];
  return facet;
}

}  // namespace

std::vector<Facet> face_facets(const std::vector<WallPatch>& patches, WallSource source, const OpenSpace& open, const TriangleGrid& grid,
                               double spacing, int dimensions) {
  const Facer facer(open, grid, spacing, source);
  std::vector<Facet> facets;
  SlowWork work("finding the wet facets of a wall");
  for (const WallPatch& patch : patches) {
    work.tell(&patch - patches.data(), patches.size());
    for (const Polygon& piece : patch.pieces) {
      const Vector3d area = vector_area(piece);
      if (area.norm() <= 0) continue;
      const bool has_plane = patch.plane_normal.squaredNorm() > 0;
      const Vector3d plane_normal = has_plane ? patch.plane_normal : area.normalized();
      const double turn = area.dot(plane_normal) > 0 ? 1.0 : -1.0;
      for (const double sign : {1.0, -1.0}) {
        for (const Polygon& part : facer.wet_parts(piece, sign * area.normalized(), true)) {
          Facet facet;
          if (dimensions == 2) facet = segment_of(part, patch.tangent);
          facet.normal = -sign * turn * plane_normal;
          facet.plane_point = has_plane ? patch.plane_point : piece[0];
          facet.owner = source.owner;
          if (dimensions == 2) {
            facet.normal.y() = 0;
            facets.push_back(facet);
            continue;
          }
          for (const Eigen::Vector3i& t : triangulate(part)) {
            for (int k = 0; k < 3; ++k) facet.corners[k] = part[t[k]];
            facets.push_back(facet);
          }
        }
      }
    }
  }
  return facets;
}

std::vector<Facet> facets_of(const WallElement& element, int dimensions) {
  const double along = 0.5 * (dimensions == 3 ? std::sqrt(element.area * element.elongation) : element.area);
  const double across = dimensions == 3 ? 0.5 * std::sqrt(element.area / element.elongation) : 0.0;
  const Vector3d a = along * element.tangent, b = across * element.normal.cross(element.tangent);
  Facet facet;
  facet.normal = element.normal;
  facet.plane_point = element.centre;
  facet.owner = element.owner;
  if (dimensions == 2) {
    facet.corners[0] = element.centre - a;
    facet.corners[1] = facet.corners[2] = element.centre + a;
    return {facet};
  }
  std::vector<Facet> result(2, facet);
  const Vector3d corners[4] = {element.centre - a - b, element.centre + a - b, element.centre + a + b, element.centre - a + b};
  for (int k = 0; k < 3; ++k) {
    result[0].corners[k] = corners[k];
    result[1].corners[k] = corners[(k + 2) % 4];
  }
  return result;
}

std::vector<WallElement> face_walls(const std::vector<WallPatch>& patches, WallSource source, const OpenSpace& open,
                                    const TriangleGrid& grid, double spacing) {
  const Facer facer(open, grid, spacing, source);
  std::vector<Unfinished> elements;
  Vector3d origin = Vector3d::Zero();
  if (!patches.empty()) origin = patches.front().pieces.front().front();
  SlowWork work("finding the wet elements of a wall");
  for (const WallPatch& patch : patches) {
    work.tell(&patch - patches.data(), patches.size());
    for (const double sign : {1.0, -1.0}) {
      const Facing facing = facer.face(patch, sign);
      if (facing.area > 1e-9 * spacing * spacing) {
        elements.push_back({facing, patch.tangent, patch.curved && facing.area < small_element * spacing * spacing});
      }
    }
    for (const Polygon& piece : patch.pieces) origin = origin.cwiseMin(piece.front());
  }
  join_small(elements, spacing, origin);

  std::vector<WallElement> walls;
  walls.reserve(elements.size());
  for (const Unfinished& element : elements) {
    WallElement wall;
    wall.centre = element.facing.moment / element.facing.area;
    wall.area = element.facing.flux.norm();
    wall.normal = element.facing.flux / wall.area;
    wall.centre += (element.facing.divergence / wall.area - wall.centre.dot(wall.normal)) * wall.normal;
    wall.tangent = (element.tangent - wall.normal.dot(element.tangent) * wall.normal).normalized();
    wall.owner = source.owner;
    fit_rectangle(wall, element.facing.corners);
    walls.push_back(wall);
  }
  return walls;
}

}  // namespace wavetank

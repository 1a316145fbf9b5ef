#include "wavetank/geometry/thin_walls.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "triangle_grid.h"

namespace wavetank {
namespace {

constexpr double opposite = -0.8;  // cosine of the normals of two walls that stand back to back
constexpr double rounding = 1e-3;

/// Looks through walls: along the normal, out of the fluid, for a facet that faces the other way.
class Looker {
 public:
  Looker(const Layout& layout, int dimensions, double thickness)
      : facets_(layout.facets),
        moving_(layout.moving),
        dimensions_(dimensions),
        thickness_((1 - rounding) * thickness),
        tolerance_(1e-4 * layout.spacing) {
    if (!facets_.empty()) grid_.emplace(as_triangles(layout.facets, dimensions), tolerance_);
    for (const Facet& facet : facets_) {
      Box box{facet.corners[0], facet.corners[0]};
      for (const Vector3d& corner : facet.corners) {
        box.min = box.min.cwiseMin(corner);
        box.max = box.max.cwiseMax(corner);
      }
      boxes_.push_back(box);
    }
  }

  /// Facets that meet the box about the points, give or take a tolerance; ascending.
  std::vector<int> about(const Vector3d* begin, const Vector3d* end, double tolerance) const {
    if (!grid_) return {};
    Box box{*begin, *begin};
    for (const Vector3d* point = begin; point != end; ++point) {
      box.min = box.min.cwiseMin(*point);
      box.max = box.max.cwiseMax(*point);
    }
    return grid_->overlapping({box.min.array() - tolerance, box.max.array() + tolerance});
  }

  /// How thick the wall of an owner is behind a place; none if it is thicker than asked.
  std::optional<double> look(const Vector3d& place, const Vector3d& normal, int owner) const {
    std::optional<double> least;
    if (!grid_) return least;
    const Vector3d end = place + thickness_ * normal, margin = Vector3d::Constant(tolerance_);
    for (const int f : grid_->overlapping({place.cwiseMin(end) - margin, place.cwiseMax(end) + margin})) {
      const Facet& facet = facets_[f];
      const double facing = facet.normal.dot(normal);
      if (facing > opposite || (owner != facet.owner && (moves(owner) || moves(facet.owner)))) continue;  // a body on the floor is no plate
      const double depth = facet.normal.dot(facet.plane_point - place) / facing;
      if (depth < -tolerance_ || depth > std::min(thickness_, least.value_or(thickness_))) continue;
      const Vector3d hit = place + depth * normal;
      if (((hit - boxes_[f].min).array() < -tolerance_).any() || ((hit - boxes_[f].max).array() > tolerance_).any()) continue;
      if (covers(facet, hit)) least = std::max(depth, 0.0);
    }
    return least;
  }

 private:
  bool moves(int owner) const { return static_cast<std::size_t>(owner) < moving_.size() && moving_[owner]; }

  /// In 2-D a segment is a triangle without area.
  static std::vector<WallTriangle> as_triangles(const std::vector<Facet>& facets, int dimensions) {
    std::vector<WallTriangle> triangles;
    for (const Facet& facet : facets)
      triangles.push_back({facet.corners[0], facet.corners[1], facet.corners[dimensions == 2 ? 1 : 2], facet.owner});
    return triangles;
  }

  bool covers(const Facet& facet, const Vector3d& point) const {
    if (dimensions_ == 2) return true;  // the bounding box has said so
    const Vector3d turn = (facet.corners[1] - facet.corners[0]).cross(facet.corners[2] - facet.corners[0]);
    for (int k = 0; k < 3; ++k) {
      const Vector3d edge = facet.corners[(k + 1) % 3] - facet.corners[k];
      if (turn.normalized().dot(edge.cross(point - facet.corners[k])) < -tolerance_ * edge.norm()) return false;
    }
    return true;
  }

  const std::vector<Facet>& facets_;
  std::vector<bool> moving_;
  std::vector<Box> boxes_;
  int dimensions_;
  double thickness_, tolerance_;
  std::optional<TriangleGrid> grid_;
};

/// Points all over a facet, a few an edge; fewer on one that is small beside the thickness.
std::vector<Vector3d> places_on(const Facet& facet, int dimensions, double thickness) {
  double longest = 0;
  for (int k = 0; k < dimensions; ++k) longest = std::max(longest, (facet.corners[(k + 1) % dimensions] - facet.corners[k]).norm());
  const int fineness = static_cast<int>(std::ceil(6 * std::min(1.0, longest / thickness)));
  std::vector<Vector3d> places;
  for (int i = 0; i < fineness; ++i) {
    if (dimensions == 2) {
      places.push_back(facet.corners[0] + (i + 0.5) / fineness * (facet.corners[1] - facet.corners[0]));
      continue;
    }
    for (int k = 0; i + k < fineness; ++k) {
      const double a = (i + 1.0 / 3) / fineness, b = (k + 1.0 / 3) / fineness;
      places.push_back(facet.corners[0] + a * (facet.corners[1] - facet.corners[0]) + b * (facet.corners[2] - facet.corners[0]));
    }
  }
  return places;
}

/// A rim's width: its extent along the normal of the plate.
double extent_along(const Facet& facet, const Vector3d& direction) {
  double least = direction.dot(facet.corners[0]), most = least;
  for (const Vector3d& corner : facet.corners) {
    least = std::min(least, direction.dot(corner));
    most = std::max(most, direction.dot(corner));
  }
  return most - least;
}

/// Whether a facet is a rim of the plate that a thin facet is a face of: it stands on the face's edge and is as narrow as the plate.
bool is_rim(const Facet& facet, const Facet& face, double thickness, double tolerance) {
  if (facet.owner != face.owner || std::abs(facet.normal.dot(face.normal)) > 0.5 || extent_along(facet, face.normal) > thickness)
    return false;
  int shared = 0;
  for (const Vector3d& corner : facet.corners) {
    const Vector3d nearest = nearest_on_triangle(corner, face.corners[0], face.corners[1], face.corners[2]);
    shared += (nearest - corner).norm() < tolerance ? 1 : 0;
  }
  return shared >= 1;
}

/// The free edges of thin facets. Neighbours share both ends of an edge; a sheet's two sides are no neighbours.
std::vector<Brim> find_brims(const Layout& layout, const Looker& looker, const std::vector<bool>& thin, int dimensions) {
  const double tolerance = 1e-3 * layout.spacing;
  const auto same = [&](const Vector3d& a, const Vector3d& b) { return (a - b).norm() < tolerance; };
  std::vector<Brim> brims;
  for (std::size_t f = 0; f < layout.facets.size(); ++f) {
    if (!thin[f]) continue;
    const Facet& facet = layout.facets[f];
    const int ends = dimensions == 2 ? 2 : 3;
    for (int k = 0; k < ends; ++k) {
      Brim brim;
      brim.from = facet.corners[k];
      brim.to = dimensions == 2 ? brim.from : facet.corners[(k + 1) % 3];
      brim.face_normal = facet.normal;
      brim.owner = facet.owner;
      const Vector3d opposite_corner = dimensions == 2 ? facet.corners[1 - k] : facet.corners[(k + 2) % 3];
      Vector3d inwards = opposite_corner - brim.from;
      if (dimensions == 3) {
        const Vector3d way = (brim.to - brim.from).normalized();
        inwards -= way.dot(inwards) * way;
      }
      brim.inwards = inwards.normalized();
      bool goes_on = false, stands_on_wall = false;
      const Vector3d middle = 0.5 * (brim.from + brim.to);
      const Vector3d ends_of_edge[2] = {brim.from, brim.to};
      for (const int g : looker.about(ends_of_edge, ends_of_edge + 2, tolerance)) {
        if (goes_on || stands_on_wall) break;
        if (g == static_cast<int>(f)) continue;
        const Facet& other = layout.facets[g];
        int shared = 0;
        for (int c = 0; c < ends; ++c) shared += same(other.corners[c], brim.from) || same(other.corners[c], brim.to) ? 1 : 0;
        const bool neighbours = other.owner == facet.owner && shared >= (dimensions == 2 ? 1 : 2);
        if (neighbours && thin[g]) {
          const double facing = other.normal.dot(facet.normal);
          if (facing < opposite) continue;  // the sheet's other side
          goes_on = facing > 1 - 1e-9;
          brim.has_other = true;
          brim.other_normal = other.normal;
          continue;
        }
        stands_on_wall = same(nearest_on_triangle(middle, other.corners[0], other.corners[1], other.corners[2]), middle) && !thin[g];
      }
      if (!goes_on && !stands_on_wall) brims.push_back(brim);
    }
  }
  return brims;
}

}  // namespace

ThinParts find_thin_parts(const Layout& layout, int dimensions, double thickness) {
  ThinParts parts;
  const Looker looker(layout, dimensions, thickness);
  for (const Facet& facet : layout.facets) {
    bool thin = false;
    for (const Vector3d& place : places_on(facet, dimensions, thickness)) {
      const std::optional<double> found = looker.look(place, facet.normal, facet.owner);
      if (!found) continue;
      thin = true;
      if (!parts.thinnest || *found < parts.thinnest->thickness) parts.thinnest = ThinWall{facet.owner, *found, place};
    }
    parts.facets.push_back(thin);
  }
  const std::vector<bool> faces = parts.facets;
  if (parts.thinnest) {
    const double tolerance = 1e-3 * layout.spacing;
    for (std::size_t r = 0; r < faces.size(); ++r) {
      const Facet& facet = layout.facets[r];
      if (faces[r]) continue;
      for (const int f : looker.about(facet.corners, facet.corners + dimensions, tolerance))
        if (faces[f] && is_rim(facet, layout.facets[f], thickness, tolerance)) parts.facets[r] = true;
    }
  }
  if (parts.thinnest) parts.brims = find_brims(layout, looker, parts.facets, dimensions);
  for (const Facet& triangle : layout.triangles) {
    const Vector3d middle = dimensions == 2 ? Vector3d(0.5 * (triangle.corners[0] + triangle.corners[1]))
                                            : Vector3d((triangle.corners[0] + triangle.corners[1] + triangle.corners[2]) / 3.0);
    parts.triangles.push_back(parts.thinnest && looker.look(middle, triangle.normal, triangle.owner).has_value());
  }
  for (const WallElement& wall : layout.walls)
    parts.walls.push_back(parts.thinnest && looker.look(wall.centre, wall.normal, wall.owner).has_value());
  return parts;
}

}  // namespace wavetank

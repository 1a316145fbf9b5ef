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

  /// The wall behind a place.
  struct Behind {
    double depth = 0;  ///< m
    int facet = 0;     ///< that faces the other way
  };

  /// What an owner's wall has behind a place; none if it is thicker than asked.
  std::optional<Behind> look(const Vector3d& place, const Vector3d& normal, int owner) const {
    std::optional<Behind> least;
    if (!grid_) return least;
    const Vector3d end = place + thickness_ * normal, margin = Vector3d::Constant(tolerance_);
    for (const int f : grid_->overlapping({place.cwiseMin(end) - margin, place.cwiseMax(end) + margin})) {
      const Facet& facet = facets_[f];
      const double facing = facet.normal.dot(normal);
      if (facing > opposite || (owner != facet.owner && (moves(owner) || moves(facet.owner)))) continue;  // a body on the floor is no plate
      const double depth = facet.normal.dot(facet.plane_point - place) / facing;
      if (depth < -tolerance_ || depth > (least ? least->depth : thickness_)) continue;
      const Vector3d hit = place + depth * normal;
      if (((hit - boxes_[f].min).array() < -tolerance_).any() || ((hit - boxes_[f].max).array() > tolerance_).any()) continue;
      if (covers(facet, hit)) least = Behind{std::max(depth, 0.0), f};
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

bool is_at_edge(const Facet& facet, const std::vector<FreeEdge>& edges, int dimensions, double tolerance) {
  return std::any_of(edges.begin(), edges.end(), [&](const FreeEdge& edge) {
    return edge.owner == facet.owner && std::any_of(facet.corners, facet.corners + dimensions, [&](const Vector3d& corner) {
             return (nearest_on_triangle(corner, edge.from, edge.to, edge.to) - corner).norm() < tolerance;
           });
  });
}

/// The edge of a facet after its corner k (2-D: the end k of a segment).
struct FacetEdge {
  Vector3d from, to, middle;
  Vector3d inwards;  ///< unit, in the facet's plane from the edge onto it

  FacetEdge(const Facet& facet, int k, int dimensions) : from(facet.corners[k]), to(dimensions == 2 ? from : facet.corners[(k + 1) % 3]) {
    middle = 0.5 * (from + to);
    inwards = (dimensions == 2 ? facet.corners[1 - k] : facet.corners[(k + 2) % 3]) - from;
    if (dimensions == 3) {
      const Vector3d way = (to - from).normalized();
      inwards -= way.dot(inwards) * way;
    }
    inwards.normalize();
  }
};

/// What a thin part does at an edge of one of its facets.
enum class EdgeKind {
  inner,   ///< it goes on
  closed,  ///< another wall stands there, or it turns towards the water
  outer    ///< it ends, or turns away from the water
};

/// Finds the free edges of thin facets.
class EdgeFinder {
 public:
  EdgeFinder(const Layout& layout, const std::vector<Thin>& thin, const Looker& looker, int dimensions)
      : facets_(layout.facets),
        moving_(layout.moving),
        thin_(thin),
        looker_(looker),
        dimensions_(dimensions),
        tolerance_(1e-3 * layout.spacing) {}

  std::vector<FreeEdge> find() const {
    std::vector<FreeEdge> found, others;
    add_edges(found, [&](int f, int k) { return is_free(f, k); });
    add_edges(others, [&](int f, int k) { return !is_free(f, k) && is_across_rim(f, k, found); });
    found.insert(found.end(), others.begin(), others.end());
    return found;
  }

 private:
  static constexpr double same_way = 0.85;       // cosine of the normals of two facets of one curved face
  static constexpr double towards_water = -0.1;  // of a neighbour's way from the edge, along the normal

  template <class Wanted>
  void add_edges(std::vector<FreeEdge>& edges, Wanted wanted) const {
    for (std::size_t f = 0; f < facets_.size(); ++f) {
      if (thin_[f] != Thin::yes) continue;
      for (int k = 0; k < ends(); ++k) {
        const FacetEdge edge(facets_[f], k, dimensions_);
        if (wanted(static_cast<int>(f), k)) edges.push_back({edge.from, edge.to, facets_[f].owner});
      }
    }
  }

  /// Where a slanting side ends at a rim, nothing need lie behind it: the other side's end is then the one that was found.
  bool is_across_rim(int f, int k, const std::vector<FreeEdge>& edges) const {
    if (kind(f, k) != EdgeKind::outer) return false;
    const FacetEdge edge(facets_[f], k, dimensions_);
    const std::vector<int> near = looker_.about(&edge.middle, &edge.middle + 1, tolerance_);
    return std::any_of(near.begin(), near.end(), [&](int g) {
      return thin_[g] == Thin::rim && facets_[g].owner == facets_[f].owner && distance(facets_[g], edge.middle) < tolerance_ &&
             is_at_edge(facets_[g], edges, dimensions_, tolerance_);
    });
  }

  int ends() const { return dimensions_ == 2 ? 2 : 3; }
  bool moves(int owner) const { return static_cast<std::size_t>(owner) < moving_.size() && moving_[owner]; }

  double distance(const Facet& facet, const Vector3d& place) const {
    return (nearest_on_triangle(place, facet.corners[0], facet.corners[1], facet.corners[dimensions_ == 2 ? 1 : 2]) - place).norm();
  }

  /// The edge of a facet on which a place lies; -1: inside of it.
  int edge_at(const Facet& facet, const Vector3d& place) const {
    for (int k = 0; k < ends(); ++k) {
      const Vector3d from = facet.corners[k], to = dimensions_ == 2 ? from : facet.corners[(k + 1) % 3];
      if ((nearest_on_triangle(place, from, to, to) - place).norm() < tolerance_) return k;
    }
    return -1;
  }

  EdgeKind kind(int f, int k) const {
    const Facet& facet = facets_[f];
    const FacetEdge edge(facet, k, dimensions_);
    EdgeKind found = EdgeKind::outer;
    for (const int g : looker_.about(&edge.middle, &edge.middle + 1, tolerance_)) {
      const Facet& other = facets_[g];
      if (g == f || distance(other, edge.middle) > tolerance_) continue;
      if (other.owner != facet.owner) {
        if (!moves(other.owner) && !moves(facet.owner)) found = EdgeKind::closed;
        continue;  // else it may be left: the solver looks where the other one is
      }
      const double facing = other.normal.dot(facet.normal);
      const int at = edge_at(other, edge.middle);
      if (facing < opposite) continue;  // the other side of the sheet
      if (facing > same_way && (at < 0 || FacetEdge(other, at, dimensions_).inwards.dot(edge.inwards) < 0)) {
        if (thin_[g] != Thin::no) return EdgeKind::inner;
        continue;
      }
      if (at < 0 || FacetEdge(other, at, dimensions_).inwards.dot(facet.normal) < towards_water) found = EdgeKind::closed;
    }
    return found;
  }

  /// Both sides of the part end here.
  bool is_free(int f, int k) const {
    if (kind(f, k) != EdgeKind::outer) return false;
    const FacetEdge edge(facets_[f], k, dimensions_);
    const std::optional<Looker::Behind> behind =
        looker_.look(edge.middle + 2 * tolerance_ * edge.inwards, facets_[f].normal, facets_[f].owner);
    if (!behind) return false;
    const Facet& other = facets_[behind->facet];
    const Vector3d across = edge.middle + behind->depth * facets_[f].normal;
    for (int m = 0; m < ends(); ++m) {
      const FacetEdge back(other, m, dimensions_);
      const Vector3d nearest = nearest_on_triangle(across, back.from, back.to, back.to);
      if ((nearest - across).norm() < behind->depth + 4 * tolerance_ && kind(behind->facet, m) == EdgeKind::outer) return true;
    }
    return false;
  }

  const std::vector<Facet>& facets_;
  const std::vector<bool>& moving_;
  const std::vector<Thin>& thin_;
  const Looker& looker_;
  int dimensions_;
  double tolerance_;
};

}  // namespace

ThinParts find_thin_parts(const Layout& layout, int dimensions, double thickness) {
  ThinParts parts;
  const Looker looker(layout, dimensions, thickness);
  for (const Facet& facet : layout.facets) {
    Thin thin = Thin::no;
    for (const Vector3d& place : places_on(facet, dimensions, thickness)) {
      const std::optional<Looker::Behind> found = looker.look(place, facet.normal, facet.owner);
      if (!found) continue;
      thin = Thin::yes;
      if (!parts.thinnest || found->depth < parts.thinnest->thickness) parts.thinnest = ThinWall{facet.owner, found->depth, place};
    }
    parts.facets.push_back(thin);
  }
  const double tolerance = 1e-3 * layout.spacing;
  const std::vector<Thin> faces = parts.facets;
  if (parts.thinnest) {
    for (std::size_t r = 0; r < faces.size(); ++r) {
      const Facet& facet = layout.facets[r];
      if (faces[r] != Thin::no) continue;
      for (const int f : looker.about(facet.corners, facet.corners + dimensions, tolerance))
        if (faces[f] == Thin::yes && is_rim(facet, layout.facets[f], thickness, tolerance)) parts.facets[r] = Thin::rim;
    }
    parts.free_edges = EdgeFinder(layout, parts.facets, looker, dimensions).find();
    // about the thickness both sides may be thin without ending as such: what joins them there is a solid's end, like any other wall
    for (std::size_t r = 0; r < faces.size(); ++r)
      if (parts.facets[r] == Thin::rim && !is_at_edge(layout.facets[r], parts.free_edges, dimensions, tolerance))
        parts.facets[r] = Thin::no;
  }
  const auto on_rim = [&](const Vector3d& centre, const Vector3d& normal, int owner) {
    for (const int f : looker.about(&centre, &centre + 1, tolerance)) {
      const Facet& facet = layout.facets[f];
      if (parts.facets[f] == Thin::rim && facet.owner == owner && facet.normal.dot(normal) > 0.99) return true;
    }
    return false;
  };
  const auto piece = [&](const Vector3d& centre, const Vector3d& normal, int owner) {
    if (!parts.thinnest) return Thin::no;
    if (looker.look(centre, normal, owner)) return Thin::yes;
    return on_rim(centre, normal, owner) ? Thin::rim : Thin::no;
  };
  for (const Facet& triangle : layout.triangles) {
    const Vector3d middle = dimensions == 2 ? Vector3d(0.5 * (triangle.corners[0] + triangle.corners[1]))
                                            : Vector3d((triangle.corners[0] + triangle.corners[1] + triangle.corners[2]) / 3.0);
    parts.triangles.push_back(piece(middle, triangle.normal, triangle.owner));
  }
  for (const WallElement& wall : layout.walls) parts.walls.push_back(piece(wall.centre, wall.normal, wall.owner));
  return parts;
}

}  // namespace wavetank

#include "wall_arrays.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "wall_cells.h"

namespace wavetank {
namespace {

/// The fields of walls, filled one wall after the other.
template <class Real>
class Fields {
 public:
  /// `together`: all fields of a wall; else a field of all walls.
  Fields(int fields, int walls, bool together, const Discretisation& d)
      : from_field_(together ? 1 : walls),
        from_wall_(together ? fields : 1),
        d_(d),
        values_(static_cast<std::size_t>(fields) * walls, Real(0)) {}
  void set(int field, int s, double value) {
    values_[static_cast<std::size_t>(field) * from_field_ + static_cast<std::size_t>(s) * from_wall_] = static_cast<Real>(value);
  }
  void set_place(int field, int s, const Vector3d& place) { set_vector(field, s, place - d_.origin); }
  void set_vector(int field, int s, const Vector3d& vector) {
    for (int axis = 0; axis < 3; ++axis) set(field + axis, s, vector[axis]);
  }
  const std::vector<Real>& values() const { return values_; }

 private:
  int from_field_, from_wall_;
  const Discretisation& d_;
  std::vector<Real> values_;
};

/// The list may end before the walls do: a lid is not thin.
double thin_value(const std::vector<Thin>& thin, int s) {
  return static_cast<std::size_t>(s) < thin.size() ? static_cast<double>(thin[s]) : 0.0;
}

bool comes_first(const Vector3d& a, const Vector3d& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

/// Up to this size seven points on a facet give γ to 1.5e-5 and ∫ W dS to 1e-3 of that over a wall.
constexpr double longest_small_edge = 1.25;  // h

bool is_small(const Facet& facet, double smoothing_length) {
  double longest = 0;
  for (int k = 0; k < 3; ++k) longest = std::max(longest, (facet.corners[(k + 1) % 3] - facet.corners[k]).norm());
  return longest < longest_small_edge * smoothing_length;
}

/// The edges that two large facets of one plane and one owner have in common, both of which are always seen whole.
class InnerEdges {
 public:
  InnerEdges() = default;
  InnerEdges(const std::vector<Facet>& facets, const std::vector<FacetPiece>& pieces, double smoothing_length) {
    std::vector<bool> whole(facets.size(), true);
    for (const FacetPiece& piece : pieces) whole[piece.facet] = false;
    for (std::size_t f = 0; f < facets.size(); ++f) {
      if (!whole[f] || is_small(facets[f], smoothing_length)) continue;
      const Facet facet = turned_left(facets[f], 3);
      for (int k = 0; k < 3; ++k) {
        Uses& uses = uses_[key(facet, k)];
        ++uses.count;
        uses.turn += comes_first(facet.corners[k], facet.corners[(k + 1) % 3]) ? 1 : -1;
      }
    }
  }
  bool contains(const Facet& facet, int k) const {
    const auto found = uses_.find(key(facet, k));
    return found != uses_.end() && found->second.count == 2 && found->second.turn == 0;
  }

 private:
  using Key = std::array<double, 13>;
  static Key key(const Facet& facet, int k) {
    const Vector3d* first = &facet.corners[k];
    const Vector3d* last = &facet.corners[(k + 1) % 3];
    if (comes_first(*last, *first)) std::swap(first, last);
    Key key;
    auto next = key.begin();
    for (const Vector3d* vector : {first, last, &facet.normal, &facet.plane_point}) next = std::copy_n(vector->data(), 3, next);
    *next = facet.owner;
    return key;
  }
  struct Uses {
    int count = 0;
    int turn = 0;  ///< 0 when one facet lies on either side
  };
  std::map<Key, Uses> uses_;
};

/// Base, direction, length and sign of each edge: the first three are the edge's own, whichever of its two facets asks.
template <class Real>
void set_edges(const Facet& facet, int s, int dimensions, const InnerEdges& inner, Fields<Real>& fields) {
  for (int k = 0; k < (dimensions == 3 ? 3 : 1); ++k) {
    const Vector3d from = facet.corners[k], to = facet.corners[(k + 1) % 3];
    const bool forward = comes_first(from, to);
    const int edge = field::wall_edges + field::edge_count * k;
    fields.set_place(edge, s, forward ? from : to);
    fields.set_vector(edge + 3, s, (forward ? to - from : from - to).normalized());
    fields.set(edge + 6, s, (to - from).norm());
    if (dimensions == 3) fields.set(edge + 7, s, (forward ? 1.0 : -1.0) * (inner.contains(facet, k) ? 2.0 : 1.0));
  }
}

}  // namespace

Facet turned_left(Facet facet, int dimensions) {
  const Vector3d turn = (facet.corners[1] - facet.corners[0]).cross(facet.corners[2] - facet.corners[0]);
  if (dimensions == 3 && turn.dot(facet.normal) < 0) std::swap(facet.corners[1], facet.corners[2]);
  return facet;
}

template <class Real>
WallArrays<Real>::WallArrays(const compute::Device& device, const std::vector<WallElement>& elements, const std::vector<Thin>& thin,
                             const Discretisation& d)
    : kind(WallKind::rectangles), count(static_cast<int>(elements.size())), stride(std::max(count, 1)), list(device, 1) {
  std::vector<Vector3d> centres;
  for (const WallElement& element : elements) centres.push_back(element.centre);
  const CellOrder cells = sorted_by_cell(centres, d);
  Fields<Real> values(field::wall_rectangle_count, std::max(count, 1), false, d);
  for (int s = 0; s < count; ++s) {
    const WallElement& element = elements[cells.order[s]];
    values.set_place(field::wall_x, s, element.centre);
    values.set_vector(field::wall_normal_x, s, element.normal);
    values.set(field::wall_owner, s, element.owner);
    values.set(field::wall_thin, s, thin_value(thin, cells.order[s]));
    values.set_vector(field::wall_tangent_x, s, element.tangent);
    values.set(field::wall_area, s, element.area);
    values.set(field::wall_half_along, s, 0.5 * (d.dimensions == 3 ? std::sqrt(element.area * element.elongation) : element.area));
    values.set(field::wall_half_across, s, d.dimensions == 3 ? 0.5 * std::sqrt(element.area / element.elongation) : 0.0);
    values.set(field::wall_gap_along, s, element.gap[0]);
    values.set(field::wall_gap_across, s, element.gap[1]);
  }
  fields = compute::Buffer<Real>(device, values.values());
  starts = compute::Buffer<int>(device, cells.begin);
  for (int s = 0; s < count; ++s) {
    Facet place;
    for (Vector3d& corner : place.corners) corner = elements[cells.order[s]].centre;
    place.normal = elements[cells.order[s]].normal;
    place.owner = elements[cells.order[s]].owner;
    shapes.push_back(place);
  }
}

template <class Real>
WallArrays<Real>::WallArrays(const compute::Device& device, const std::vector<Facet>& wholes, const std::vector<FacetPiece>& pieces,
                             const std::vector<Thin>& thin_wholes, WallKind given, const Discretisation& d)
    : kind(given), count(static_cast<int>(wholes.size() + pieces.size())), list(device, 1) {
  const int edges = d.dimensions == 3 ? 3 : 1;
  const bool whole = kind == WallKind::facets;
  const int field_count = whole ? field::wall_edges + edges * field::edge_count : static_cast<int>(field::wall_triangle_count);
  stride = whole ? field_count : std::max(count, 1);
  const InnerEdges inner = whole && d.dimensions == 3 ? InnerEdges(wholes, pieces, d.smoothing_length) : InnerEdges();
  std::vector<Facet> facets = wholes;
  std::vector<Thin> thin = thin_wholes;
  for (const FacetPiece& piece : pieces) {
    facets.push_back(piece.shape);
    if (!thin.empty()) thin.push_back(thin_wholes[piece.facet]);
  }
  std::vector<Vector3d> centres;
  for (const Facet& facet : facets) centres.push_back(middle_of(facet, d.dimensions));
  const CellOrder cells = whole ? facets_by_cell(wholes, d) : sorted_by_cell(centres, d);
  Fields<Real> values(field_count, std::max(count, 1), whole, d);
  for (int s = 0; s < count; ++s) {
    const int source = whole ? s : cells.order[s];
    const Facet facet = turned_left(facets[source], d.dimensions);
    shapes.push_back(facet);
    values.set_vector(field::wall_normal_x, s, facet.normal);
    values.set(field::wall_owner, s, facet.owner);
    values.set(field::wall_thin, s, thin_value(thin, source));
    values.set_place(field::wall_x, s, whole ? facet.plane_point : centres[source]);
    const Vector3d a = facet.corners[1] - facet.corners[0], b = facet.corners[2] - facet.corners[0];
    if (whole) {
      values.set(field::wall_area, s, d.dimensions == 3 && is_small(facet, d.smoothing_length) ? 0.5 * a.cross(b).norm() : 0.0);
      set_edges(facet, s, d.dimensions, inner, values);
      continue;
    }
    values.set(field::wall_area, s, d.dimensions == 3 ? 0.5 * a.cross(b).norm() : a.norm());
    for (int k = 0; k < 3; ++k) values.set_vector(field::wall_corners + 3 * k, s, facet.corners[k] - centres[source]);
  }
  fields = compute::Buffer<Real>(device, values.values());
  starts = compute::Buffer<int>(device, cells.begin);
  if (whole && !cells.order.empty()) list = compute::Buffer<int>(device, cells.order);
}

template struct WallArrays<float>;
template struct WallArrays<double>;

}  // namespace wavetank

#include "case_walls.h"

#include <algorithm>

#include "build_options.h"
#include "hidden_walls.h"

namespace wavetank {
namespace {

Layout walls_and_lid(const Layout& layout) {
  Layout result;
  result.walls = layout.walls;
  result.facets = layout.facets;
  result.pieces = layout.pieces;
  result.triangles = layout.triangles;
  result.lid = layout.lid;
  result.up = layout.up;
  return result;
}

/// Those of a list that are in sight, and of their marks.
template <class Wall, class Mark, class InSight>
void keep(std::vector<Wall>& walls, std::vector<Mark>& marks, const InSight& in_sight) {
  std::size_t kept = 0;
  for (std::size_t w = 0; w < walls.size(); ++w) {
    if (!in_sight(walls[w])) continue;
    if (w < marks.size()) marks[kept] = marks[w];
    walls[kept++] = walls[w];
  }
  walls.resize(kept);
  marks.resize(std::min(marks.size(), kept));
}

}  // namespace

CaseWalls::CaseWalls(const Case& scene, const Layout& layout, const Discretisation& discretisation)
    : dimensions_(scene.dimensions),
      discretisation_(discretisation),
      kind_(kind_of(scene.numerics.walls)),
      thin_(find_thin_parts(layout, scene.dimensions, discretisation.support)),
      closed_(walls_and_lid(layout)) {
  for (std::size_t f = 0; f < layout.facets.size(); ++f)
    if (thin_.facets[f] != Thin::no) thin_facets_.push_back(layout.facets[f]);
  in_sight_ = closed_;
  in_sight_.pieces.clear();
  thin_in_sight_ = thin_;
  if (layout.intruding.empty()) return;
  const HiddenWalls hidden(layout, scene.dimensions);
  const std::vector<WallPose> at_rest(layout.meshes.size());
  in_sight_.facets.clear();
  thin_in_sight_.facets.clear();
  const auto add = [&](const Facet& shape, int whole) {
    in_sight_.facets.push_back(shape);
    thin_in_sight_.facets.push_back(thin_.facets[whole]);
  };
  for (std::size_t f = 0; f < layout.facets.size(); ++f)
    if (!hidden.concerns(layout.facets[f].owner)) add(layout.facets[f], static_cast<int>(f));
  for (const int s : hidden.facets_in_sight(at_rest)) {
    const int after = s - static_cast<int>(layout.facets.size());
    if (after < 0)
      add(layout.facets[s], s);
    else
      add(layout.pieces[after].shape, layout.pieces[after].facet);
  }
  const auto facet_in_sight = [&](const Facet& facet) { return !hidden.hides(facet, at_rest); };
  keep(in_sight_.triangles, thin_in_sight_.triangles, facet_in_sight);
  keep(in_sight_.walls, thin_in_sight_.walls, [&](const WallElement& wall) {
    Facet place;
    for (Vector3d& corner : place.corners) corner = wall.centre;
    place.normal = wall.normal;
    place.owner = wall.owner;
    return facet_in_sight(place);
  });
}

template <class Real>
WallArrays<Real> CaseWalls::arrays(const compute::Device& device) const {
  return arrays<Real>(device, closed_, thin_, {});
}

template <class Real>
WallArrays<Real> CaseWalls::arrays_at_start(const compute::Device& device, bool own, const std::vector<WallElement>& lid) const {
  return own ? arrays<Real>(device, in_sight_, thin_in_sight_, lid) : arrays<Real>(device, Layout(), ThinParts(), lid);
}

template <class Real>
WallArrays<Real> CaseWalls::arrays(const compute::Device& device, const Layout& own, const ThinParts& thin,
                                   const std::vector<WallElement>& lid) const {
  if (kind_ == WallKind::rectangles) {
    std::vector<WallElement> elements = own.walls;
    elements.insert(elements.end(), lid.begin(), lid.end());
    return WallArrays<Real>(device, elements, thin.walls, discretisation_);
  }
  // triangles stand for the pressure at their centre and stay small; facets are exact at any size, and cost by their number
  const bool whole = kind_ == WallKind::facets;
  std::vector<Facet> facets = whole ? own.facets : own.triangles;
  for (const WallElement& element : whole ? joined_rectangles(lid, discretisation_.spacing, dimensions_) : lid) {
    const std::vector<Facet> parts = facets_of(element, dimensions_);
    facets.insert(facets.end(), parts.begin(), parts.end());
  }
  return WallArrays<Real>(device, facets, whole ? own.pieces : std::vector<FacetPiece>(), whole ? thin.facets : thin.triangles, kind_,
                          discretisation_);
}

std::vector<WallElement> CaseWalls::supporting_lid() const {
  std::vector<WallElement> lid;
  for (const WallElement& element : closed_.lid)
    if (element.normal.dot(closed_.up) < 0.05) lid.push_back(element);
  return lid;
}

template WallArrays<float> CaseWalls::arrays(const compute::Device&) const;
template WallArrays<double> CaseWalls::arrays(const compute::Device&) const;
template WallArrays<float> CaseWalls::arrays_at_start(const compute::Device&, bool, const std::vector<WallElement>&) const;
template WallArrays<double> CaseWalls::arrays_at_start(const compute::Device&, bool, const std::vector<WallElement>&) const;

}  // namespace wavetank

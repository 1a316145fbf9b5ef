#include "case_walls.h"

#include "build_options.h"

namespace wavetank {
namespace {

Layout walls_and_lid(const Layout& layout) {
  Layout result;
  result.walls = layout.walls;
  result.facets = layout.facets;
  result.triangles = layout.triangles;
  result.lid = layout.lid;
  result.up = layout.up;
  return result;
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
}

template <class Real>
WallArrays<Real> CaseWalls::arrays(const compute::Device& device, bool own, const std::vector<WallElement>& lid) const {
  if (kind_ == WallKind::rectangles) {
    std::vector<WallElement> elements = closed_.walls;
    elements.insert(elements.end(), lid.begin(), lid.end());
    return WallArrays<Real>(device, elements, thin_.walls, discretisation_);
  }
  std::vector<Facet> facets;
  if (own) facets = kind_ == WallKind::facets ? closed_.facets : closed_.triangles;
  // triangles stand for the pressure at their centre and stay small; facets are exact at any size, and cost by their number
  const bool whole = kind_ == WallKind::facets;
  for (const WallElement& element : whole ? joined_rectangles(lid, discretisation_.spacing, dimensions_) : lid) {
    const std::vector<Facet> parts = facets_of(element, dimensions_);
    facets.insert(facets.end(), parts.begin(), parts.end());
  }
  const std::vector<Thin> none;
  const std::vector<Thin>& thin = kind_ == WallKind::facets ? thin_.facets : thin_.triangles;
  return WallArrays<Real>(device, facets, own ? thin : none, kind_, discretisation_);
}

std::vector<WallElement> CaseWalls::supporting_lid() const {
  std::vector<WallElement> lid;
  for (const WallElement& element : closed_.lid)
    if (element.normal.dot(closed_.up) < 0.05) lid.push_back(element);
  return lid;
}

template WallArrays<float> CaseWalls::arrays(const compute::Device&, bool, const std::vector<WallElement>&) const;
template WallArrays<double> CaseWalls::arrays(const compute::Device&, bool, const std::vector<WallElement>&) const;

}  // namespace wavetank

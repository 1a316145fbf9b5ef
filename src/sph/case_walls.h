#pragma once

#include <optional>
#include <vector>

#include "wall_arrays.h"
#include "wavetank/geometry/thin_walls.h"

namespace wavetank {

/// The walls and the lid of a case, from which the arrays on the device are made: those of the run, and those of what comes before it.
class CaseWalls {
 public:
  CaseWalls(const Case& settled_case, const Layout& layout, const Discretisation& discretisation);

  WallKind kind() const { return kind_; }
  const ThinParts& thin() const { return thin_; }
  const std::vector<Facet>& thin_facets() const { return thin_facets_; }
  const std::vector<Facet>& facets() const { return closed_.facets; }

  /// All of the case's own walls, for the run.
  template <class Real>
  WallArrays<Real> arrays(const compute::Device& device) const;
  /// What is before the run: the lid, with or without the case's own walls that are in sight at the start.
  template <class Real>
  WallArrays<Real> arrays_at_start(const compute::Device& device, bool own, const std::vector<WallElement>& lid) const;
  const std::vector<WallElement>& lid() const { return closed_.lid; }
  /// The walls as pieces of about the spacing, whatever the elements are.
  const std::vector<WallElement>& pieces() const { return closed_.walls; }
  /// Of the lid what holds the water up or to the side, as settling needs it.
  std::vector<WallElement> supporting_lid() const;

 private:
  template <class Real>
  WallArrays<Real> arrays(const compute::Device& device, const Layout& own, const ThinParts& thin,
                          const std::vector<WallElement>& lid) const;

  int dimensions_;
  Discretisation discretisation_;
  WallKind kind_;
  ThinParts thin_;
  std::vector<Facet> thin_facets_;
  Layout closed_;    ///< the walls and the lid alone
  Layout in_sight_;  ///< at the start, likewise
  ThinParts thin_in_sight_;
};

}  // namespace wavetank

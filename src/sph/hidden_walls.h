#pragma once

#include <optional>
#include <vector>

#include "moving_walls.h"
#include "wavetank/geometry/layout.h"
#include "wavetank/geometry/solid_surface.h"

namespace wavetank {

/// Tells of walls whether they lie inside a body that moves against theirs, or face to face with it, where no water reaches them.
class HiddenWalls {
 public:
  HiddenWalls(const Layout& layout, int dimensions);

  /// Of the facets that may be hidden those that are in sight; of one that is so in part its pieces, numbered after all facets.
  std::vector<int> facets_in_sight(const std::vector<WallPose>& poses) const;

  /// Whether walls of the owner may ever be hidden.
  bool concerns(int owner) const { return owner < static_cast<int>(by_.size()) && !by_[owner].empty(); }
  /// Whether the middle of a wall, given as at rest, is hidden while its owner and the others are where the poses have them.
  bool hides(const Facet& wall, const std::vector<WallPose>& poses) const;

 private:
  int dimensions_;
  double look_off_;                   ///< m, off the wall
  std::vector<std::vector<int>> by_;  ///< of each owner, those in which its walls may lie
  std::vector<std::optional<SolidTest>> solids_;
  std::vector<Facet> facets_;
  std::vector<FacetPiece> pieces_;
};

}  // namespace wavetank

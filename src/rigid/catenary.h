#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <vector>

namespace wavetank {

/// A line that hangs by its own weight between an anchor and a top, at rest: the elastic catenary, in part on a level bed at its anchor.
struct Catenary {
  double length = 0;      ///< m, unstretched
  double weight = 0;      ///< N/m of that, in the water; > 0
  double compliance = 0;  ///< 1/N, of 1/EA; 0: it does not stretch
  bool bed = true;        ///< it cannot hang below its anchor
};

/// What pulls at its ends, N.
struct CatenaryPull {
  double horizontal = 0;       ///< everywhere on the line
  double vertical = 0;         ///< at its top, downwards on what it holds
  double anchor_vertical = 0;  ///< at the anchor, upwards on it
  double lying = 0;            ///< m of the unstretched line that lie on the bed

  double tension() const { return Eigen::Vector2d(horizontal, vertical).norm(); }
  double anchor_tension() const { return Eigen::Vector2d(horizontal, anchor_vertical).norm(); }
};

/// The pull of a line whose top is `span` (m, ≥ 0) beside and `rise` (m) above its anchor; the bed bears what is below it. None for a line
/// without compliance that is too short. H. M. Irvine, Cable Structures, MIT Press 1981, chapter 1; with the bed, J. M. Jonkman, NREL
/// TP-500-41958, 2007, section 2.6.
std::optional<CatenaryPull> catenary_pull(const Catenary& line, double span, double rise);

/// Places on that line, (beside, above) its anchor, m: `count` of them from the anchor to the top, evenly along it.
std::vector<Eigen::Vector2d> catenary_shape(const Catenary& line, double span, double rise, const CatenaryPull& pull, int count);

}  // namespace wavetank

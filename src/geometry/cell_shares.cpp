#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "fluid_filling.h"
#include "slow_work.h"

namespace wavetank {
namespace {

constexpr float least_share = 0.4f, most_share = 2.0f;  // beyond these the sums over particles of two sizes suffer

// So many particles beside a place are asked, the nearest first; what they do not see is behind the wall. Behind what a cell's own particle
// does not see there is mostly nothing.
constexpr int most_asked = 5, most_asked_behind = 2;

/// Places all over a cell, each for as much of it, as offsets from its middle over its sides: a lattice of rank 1 in one corner of the cell
/// and its images in the others, so that a cell and its mirror image are cut alike. Of a layer that a plane wall cuts the volume comes out
/// to 0.016 of a spacing, if the wall stands along an axis, and to 0.053 at 45°, where all cells are cut alike (of strides tried, the
/// best).
std::vector<Vector3d> places_in_cell(bool flat) {
  const int count = 16, stride[3] = {1, 3, 5};
  std::vector<Vector3d> places;
  for (int m = 0; m < count; ++m)
    for (int corner = 0; corner < 8; ++corner) {
      if (flat && (corner & 2) != 0) continue;
      Vector3d place;
      for (int axis = 0; axis < 3; ++axis)
        place[axis] = ((corner >> axis & 1) != 0 ? 0.5 : -0.5) * (m * stride[axis] % count + 0.5) / count;
      places.push_back(place);
    }
  return places;
}

/// Gives the wet part of one cell to particles: its own where it sees that part, else the nearest that does in a cell beside it.
class CellSharing {
 public:
  CellSharing(const Basin& basin, FilledRegion& region) : basin_(basin), region_(region), places_(places_in_cell(region.step.y() == 0)) {}

  void share(int i, int j, int k) {
    const std::size_t cell = region_.index(i, j, k);
    const bool has_own = region_.filled[cell] != 0;
    if (!has_own && is_over_surface(i, j, k)) return;
    const Vector3d middle = middle_of(i, j, k), sides = sides_of(cell);
    const auto wall = basin_.grid->nearest(middle, 0.5 * sides.norm() * (1 + 1e-6));
    if (!wall || is_a_side(wall->point - middle, wall->distance, sides)) return;
    find_neighbours(i, j, k);
    if (!has_own && neighbours_.empty()) return;
    const double part = 1.0 / static_cast<double>(places_.size());
    if (has_own) region_.share[cell] -= 1;
    for (const Vector3d& place_in_cell : places_) {
      const Vector3d offset = place_in_cell.cwiseProduct(sides), place = middle + offset;
      const bool before_wall = offset.norm() < wall->distance && region_.position[cell] == middle;  // no need to look
      if (has_own && (before_wall || sees(cell, place))) {
        region_.share[cell] += static_cast<float>(part);
      } else if (const auto other = nearest_that_sees(place, has_own ? most_asked_behind : most_asked)) {
        region_.share[*other] += static_cast<float>(part * sides.z() / sides_of(*other).z());
      }
    }
  }

 private:
  bool is_curved() const { return !region_.curved.height.empty(); }

  Vector3d middle_of(int i, int j, int k) const {
    Vector3d middle = region_.centre(i, j, k);
    if (is_curved()) middle.z() = region_.curved.middle[region_.index(i, j, k)];
    return middle;
  }

  Vector3d sides_of(std::size_t cell) const {
    Vector3d sides = region_.step;
    if (is_curved()) sides.z() *= region_.curved.stretch[cell];
    return sides;
  }

  bool is_over_surface(int i, int j, int k) const {
    if (!is_curved()) return !region_.surface.wets(region_.centre(i, j, k));
    const int top = region_.curved.top[region_.column(i, j)];
    return top >= 0 && k > top;
  }

  /// Below the surface over the particle of a cell.
  bool wets(std::size_t cell, const Vector3d& place) const {
    return is_curved() ? place.z() < region_.curved.height[cell % region_.curved.height.size()] : region_.surface.wets(place);
  }

  /// Whether a wall in that way does no more than to bound the cell.
  static bool is_a_side(const Vector3d& way, double distance, const Vector3d& sides) {
    int axis = 0;
    way.cwiseAbs().maxCoeff(&axis);
    return std::abs(way[axis]) > 0.999 * distance && distance > 0.499 * sides[axis];
  }

  bool sees(std::size_t cell, const Vector3d& place) const { return !basin_.grid->crosses(region_.position[cell], place); }

  void find_neighbours(int i, int j, int k) {
    neighbours_.clear();
    for (int n = 0; n < 27; ++n) {
      const int a = i + n % 3 - 1, b = j + n / 3 % 3 - 1, c = k + n / 9 - 1;
      if (n == 13 || a < 0 || b < 0 || c < 0 || a >= region_.count[0] || b >= region_.count[1] || c >= region_.count[2]) continue;
      if (region_.filled[region_.index(a, b, c)]) neighbours_.push_back(region_.index(a, b, c));
    }
  }

  std::optional<std::size_t> nearest_that_sees(const Vector3d& place, int asked) {
    const auto few = neighbours_.begin() + std::min<std::ptrdiff_t>(asked, static_cast<std::ptrdiff_t>(neighbours_.size()));
    std::partial_sort(neighbours_.begin(), few, neighbours_.end(), [&](std::size_t a, std::size_t b) {
      const double to_a = (region_.position[a] - place).squaredNorm(), to_b = (region_.position[b] - place).squaredNorm();
      return to_a < to_b || (to_a == to_b && a < b);
    });
    const auto found = std::find_if(neighbours_.begin(), few, [&](std::size_t other) { return wets(other, place) && sees(other, place); });
    return found == few || is_too_narrow_for_particles(basin_, region_, place) ? std::nullopt : std::optional(*found);
  }

  const Basin& basin_;
  FilledRegion& region_;
  std::vector<Vector3d> places_;
  std::vector<std::size_t> neighbours_;  ///< of the cell in hand, that have particles
};

}  // namespace

void share_cells(const Basin& basin, FilledRegion& region) {
  region.share.assign(region.filled.size(), 1.0f);
  CellSharing sharing(basin, region);
  SlowWork work("finding the water beside walls");
  for (int k = 0; k < region.count[2]; ++k)
    for (int j = 0; j < region.count[1]; ++j)
      for (int i = 0; i < region.count[0]; ++i) {
        work.tell(region.index(i, j, k), region.share.size());
        sharing.share(i, j, k);
      }
  for (float& share : region.share) share = std::clamp(share, least_share, most_share);
}

}  // namespace wavetank

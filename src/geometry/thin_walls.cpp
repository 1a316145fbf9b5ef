#include "wavetank/geometry/thin_walls.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace wavetank {
namespace {

constexpr double rounding = 1e-3;
constexpr double opposite = -0.8;  // cosine of the normals of two elements that stand back to back

}  // namespace

std::optional<ThinWall> thinnest_wall(const Layout& layout, double thickness) {
  const double cell = thickness;
  const auto key = [](std::int64_t i, std::int64_t j, std::int64_t k) { return (i * 2097152 + j) * 2097152 + k; };
  const auto index = [&](double place, double from) { return static_cast<std::int64_t>(std::floor((place - from) / cell)); };
  const Vector3d& origin = layout.domain.min;
  std::unordered_map<std::int64_t, std::vector<std::size_t>> cells;
  for (std::size_t s = 0; s < layout.walls.size(); ++s) {
    const Vector3d& c = layout.walls[s].centre;
    cells[key(index(c.x(), origin.x()), index(c.y(), origin.y()), index(c.z(), origin.z()))].push_back(s);
  }
  std::optional<ThinWall> thinnest;
  const auto compare = [&](const WallElement& front, const WallElement& back) {
    if (front.normal.dot(back.normal) > opposite) return;
    const Vector3d through = back.centre - front.centre;
    const double depth = front.normal.dot(through);  // normals point out of the fluid, so into the wall
    if (depth < -1e-6 * layout.spacing || depth > (1 - rounding) * thickness) return;
    if ((through - depth * front.normal).norm() > layout.spacing) return;
    if (!thinnest || depth < thinnest->thickness) thinnest = ThinWall{front.owner, std::max(depth, 0.0), front.centre};
  };
  for (const WallElement& front : layout.walls) {
    const std::int64_t at[3] = {index(front.centre.x(), origin.x()), index(front.centre.y(), origin.y()),
                                index(front.centre.z(), origin.z())};
    for (std::int64_t i = at[0] - 1; i <= at[0] + 1; ++i) {
      for (std::int64_t j = at[1] - 1; j <= at[1] + 1; ++j) {
        for (std::int64_t k = at[2] - 1; k <= at[2] + 1; ++k) {
          const auto found = cells.find(key(i, j, k));
          if (found == cells.end()) continue;
          for (const std::size_t s : found->second) compare(front, layout.walls[s]);
        }
      }
    }
  }
  return thinnest;
}

}  // namespace wavetank

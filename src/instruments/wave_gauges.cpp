#include "wavetank/instruments/wave_gauges.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "wavetank/instruments/filled.h"

namespace wavetank {
namespace {

/// With the way to the tank's top as z: x, y, z stay where that is up along z.
Vector3d upright(const Vector3d& v, const Top& top) { return {v[(top.axis + 1) % 3], v[(top.axis + 2) % 3], top.way * v[top.axis]}; }

/// Where the line through a place along the top's axis meets the tank's walls, upwards.
struct Crossing {
  double height = 0;      ///< towards the top
  bool is_floor = false;  ///< water stands on it; else it hangs over water
};

/// Whether the line goes through a facet (2-D: a segment), whose plane is not upright, and at which height.
std::optional<double> height_on(const Facet& facet, const Vector3d& place, const Top& top, int dimensions) {
  const Vector3d a = upright(facet.corners[0], top), b = upright(facet.corners[1], top), c = upright(facet.corners[2], top);
  const double x = upright(place, top).x(), y = upright(place, top).y();
  constexpr double hair = 1e-9;
  if (dimensions == 2) {
    const int across = top.axis == 0 ? 1 : 0;  // of the plane's two directions the one that is not the top's
    const double run = b[across] - a[across];
    if (std::abs(run) < 1e-14) return std::nullopt;
    const double along = ((across == 0 ? x : y) - a[across]) / run;
    if (along < -hair || along > 1.0 + hair) return std::nullopt;
    return a.z() + along * (b.z() - a.z());
  }
  const double area = (b.x() - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (b.y() - a.y());
  if (std::abs(area) < 1e-14) return std::nullopt;
  const double beta = ((x - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (y - a.y())) / area;
  const double gamma = ((b.x() - a.x()) * (y - a.y()) - (x - a.x()) * (b.y() - a.y())) / area;
  if (beta < -hair || gamma < -hair || beta + gamma > 1.0 + hair) return std::nullopt;
  return a.z() + beta * (b.z() - a.z()) + gamma * (c.z() - a.z());
}

std::vector<Crossing> crossings(const Layout& layout, const Vector3d& place, const Top& top, int dimensions) {
  std::vector<Crossing> found;
  for (const Facet& facet : layout.facets) {
    if (facet.owner != 0) continue;
    if (const std::optional<double> height = height_on(facet, place, top, dimensions))
      found.push_back({*height, top.way * facet.normal[top.axis] < 0});
  }
  std::sort(found.begin(), found.end(), [](const Crossing& a, const Crossing& b) { return a.height < b.height; });
  return found;
}

constexpr double standing = 0.5;  ///< of the kernel just over a floor: so full, water stands on it; less is a film or spray

}  // namespace

WaveGauges::WaveGauges(const Case& scene, const Layout& layout, const Solver& solver, const RigidWorld& world)
    : world_(world), interval_(0.25 * layout.spacing), top_(top_of(scene)) {
  std::vector<SolidBody> fixed;
  if (!scene.instruments.wave_gauges.empty())
    for (SolidBody& body : solid_bodies(scene, layout)) (world.moves(body.owner) ? moving_ : fixed).push_back(std::move(body));
  for (const WaveGaugeCase& gauge : scene.instruments.wave_gauges) {
    Line line;
    line.begin = places_.size();
    Vector3d place = gauge.position;
    if (scene.dimensions == 2) place.y() = 0;
    const std::vector<Crossing> walls = crossings(layout, place, top_, scene.dimensions);
    const auto lowest = std::find_if(walls.begin(), walls.end(), [](const Crossing& wall) { return wall.is_floor; });
    line.floor = lowest == walls.end() ? top_.way * top_.bottom_of(layout.domain) : lowest->height;
    for (const Crossing& wall : walls)
      if (wall.is_floor && wall.height > line.floor + 0.5 * interval_) line.shelves.push_back(wall.height);
    const int count = static_cast<int>(std::floor((top_.way * top_.of(layout.domain) - line.floor) / interval_)) + 1;
    for (int k = 0; k < count; ++k) {
      const double height = line.floor + k * interval_;
      place[top_.axis] = top_.way * height;
      places_.push_back(place);
      // above what hangs over water, up to the next floor, is the tank's own wall
      const auto above = std::find_if(walls.begin(), walls.end(), [&](const Crossing& wall) { return wall.height > height; });
      const bool in_wall = above != walls.begin() && !std::prev(above)->is_floor && above != walls.end() && above->is_floor;
      open_.push_back(!in_wall &&
                      std::none_of(fixed.begin(), fixed.end(), [&](const SolidBody& body) { return body.contains(places_.back()); }));
    }
    line.end = places_.size();
    lines_.push_back(std::move(line));
  }
  points_ = solver.make_points(places_);
}

std::vector<double> WaveGauges::read(Solver& solver) const {
  std::vector<double> levels;
  if (lines_.empty()) return levels;
  const std::vector<PointValue> values = solver.evaluate(*points_);
  const std::vector<char> open = without_bodies(open_, places_, moving_, world_);
  for (const Line& line : lines_) {
    // from the top down: water that stands on a body or a shelf is what the gauge sees, whatever is below
    double column = 0, above = 0, water_above = 0;
    std::optional<double> stood_on;
    auto shelf = line.shelves.rbegin();
    for (std::size_t k = line.end; !stood_on && k-- > line.begin;) {
      const double height = top_.way * places_[k][top_.axis];
      for (; shelf != line.shelves.rend() && *shelf > height && !stood_on; ++shelf) {
        column += std::max(height + interval_ - *shelf, 0.0) * above;
        above = 0;
        if (water_above > standing) stood_on = *shelf;
      }
      if (stood_on) break;
      if (open[k]) water_above = filled(values[k]);
      const bool stands = !open[k] && water_above > standing;
      const double here = open[k] ? water_above : stands ? 1.0 : 0.0;
      if (k + 1 < line.end) column += 0.5 * interval_ * (here + above);
      above = here;
      if (stands) stood_on = height;
    }
    levels.push_back(top_.way * (stood_on.value_or(line.floor) + column));
  }
  return levels;
}

}  // namespace wavetank

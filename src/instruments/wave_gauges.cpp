#include "wavetank/instruments/wave_gauges.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wavetank {
namespace {

/// Heights at which the vertical line through (x, y) meets the mesh.
std::vector<double> crossings(const TriangleMesh& mesh, double x, double y) {
  std::vector<double> heights;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vector3d a = mesh.corner(t, 0), b = mesh.corner(t, 1), c = mesh.corner(t, 2);
    const double area = (b.x() - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (b.y() - a.y());
    if (std::abs(area) < 1e-14) continue;  // upright: the line lies in it or misses it
    const double beta = ((x - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (y - a.y())) / area;
    const double gamma = ((b.x() - a.x()) * (y - a.y()) - (x - a.x()) * (b.y() - a.y())) / area;
    if (beta < -1e-9 || gamma < -1e-9 || beta + gamma > 1.0 + 1e-9) continue;
    heights.push_back(a.z() + beta * (b.z() - a.z()) + gamma * (c.z() - a.z()));
  }
  return heights;
}

/// The floor under a gauge: the lowest wall of the tank that bounds the open space from below. A tank with thick walls has its outer skin
/// below that: a sampled wall element marks the wetted one.
double floor_height(const Layout& layout, double x, double y) {
  double floor = layout.domain.min.z();
  double nearest = std::numeric_limits<double>::max();
  std::vector<double> heights;
  if (!layout.meshes.empty()) heights = crossings(layout.meshes[0], x, y);
  for (const WallElement& wall : layout.walls) {
    if (wall.owner != 0 || wall.normal.z() > -0.3) continue;
    const double away = std::hypot(wall.centre.x() - x, wall.centre.y() - y);
    if (away < nearest) {
      nearest = away;
      floor = wall.centre.z();
    }
  }
  // the mesh's own height there is exact where an element's centre beside the line, on a slope, is not
  double best = std::numeric_limits<double>::max(), exact = floor;
  for (const double height : heights)
    if (std::abs(height - floor) < best) {
      best = std::abs(height - floor);
      exact = height;
    }
  return best < 2.0 * layout.spacing ? exact : floor;
}

bool within(const Box& box, const Vector3d& point) {
  return (point.array() > box.min.array()).all() && (point.array() < box.max.array()).all();
}

}  // namespace

WaveGauges::WaveGauges(const Case& scene, const Layout& layout, const Solver& solver, const RigidWorld& world)
    : world_(world), interval_(0.25 * layout.spacing) {
  std::vector<Solid> fixed;
  for (std::size_t b = 0; b < scene.bodies.size() && !scene.instruments.wave_gauges.empty(); ++b) {
    const Box* box = std::get_if<Box>(&scene.bodies[b].shape);
    Solid solid{1 + b, layout.meshes[1 + b], box != nullptr, box != nullptr ? *box : layout.meshes[1 + b].bounding_box()};
    if (scene.dimensions == 2) {
      solid.box.min.y() = -std::numeric_limits<double>::infinity();
      solid.box.max.y() = std::numeric_limits<double>::infinity();
    }
    (world.moves(solid.owner) ? moving_ : fixed).push_back(std::move(solid));
  }
  for (const WaveGaugeCase& gauge : scene.instruments.wave_gauges) {
    Line line;
    line.begin = places_.size();
    const double y = scene.dimensions == 2 ? 0.0 : gauge.position.y();
    line.floor = floor_height(layout, gauge.position.x(), y);
    const int count = static_cast<int>(std::floor((layout.domain.max.z() - line.floor) / interval_)) + 1;
    for (int k = 0; k < count; ++k) {
      places_.emplace_back(gauge.position.x(), y, line.floor + k * interval_);
      open_.push_back(std::none_of(fixed.begin(), fixed.end(), [&](const Solid& solid) { return contains(solid, places_.back()); }));
    }
    line.end = places_.size();
    lines_.push_back(line);
  }
  points_ = solver.make_points(places_);
}

bool WaveGauges::contains(const Solid& solid, const Vector3d& point) const {
  return within(solid.box, point) && (solid.is_box || inside(solid.mesh, point));
}

std::vector<char> WaveGauges::open_now() const {
  std::vector<char> open = open_;
  for (const Solid& solid : moving_) {
    const RigidState state = world_.state_in_tank(solid.owner);
    const Quaterniond back = state.orientation.conjugate();
    for (std::size_t k = 0; k < places_.size(); ++k)
      if (open[k] && contains(solid, back * (places_[k] - state.position) + world_.reference(solid.owner))) open[k] = 0;
  }
  return open;
}

std::vector<double> WaveGauges::read(Solver& solver) const {
  std::vector<double> levels;
  if (lines_.empty()) return levels;
  const std::vector<PointValue> values = solver.evaluate(*points_);
  const std::vector<char> open = open_now();
  // how much of the kernel the fluid fills, the walls' share apart: 1 in the fluid, 1/2 on its surface, 0 in the air
  const auto filling = [&](std::size_t k) {
    if (values[k].shepard < 0.1) return 0.0;
    return std::min(values[k].filling / std::min(values[k].shepard, 1.0), 1.0);
  };
  for (const Line& line : lines_) {
    double column = 0, above = 0, water_above = 0;
    for (std::size_t k = line.end; k-- > line.begin;) {
      // a body counts as water where water stands on it
      if (open[k]) water_above = filling(k);
      const double here = open[k] ? water_above : water_above > 0.5 ? 1.0 : 0.0;
      if (k + 1 < line.end) column += 0.5 * interval_ * (here + above);
      above = here;
    }
    levels.push_back(line.floor + column);
  }
  return levels;
}

}  // namespace wavetank

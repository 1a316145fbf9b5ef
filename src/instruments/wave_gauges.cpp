#include "wavetank/instruments/wave_gauges.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wavetank {
namespace {

/// With the axis of the tank's top as z: x, y, z stay where that is z.
Vector3d upright(const Vector3d& v, int axis) { return {v[(axis + 1) % 3], v[(axis + 2) % 3], v[axis]}; }

/// Where the line along the axis through the place meets the mesh: coordinates along the axis.
std::vector<double> crossings(const TriangleMesh& mesh, const Vector3d& place, int axis) {
  const double x = upright(place, axis).x(), y = upright(place, axis).y();
  std::vector<double> heights;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vector3d a = upright(mesh.corner(t, 0), axis), b = upright(mesh.corner(t, 1), axis), c = upright(mesh.corner(t, 2), axis);
    const double area = (b.x() - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (b.y() - a.y());
    if (std::abs(area) < 1e-14) continue;  // upright: the line lies in it or misses it
    const double beta = ((x - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (y - a.y())) / area;
    const double gamma = ((b.x() - a.x()) * (y - a.y()) - (x - a.x()) * (b.y() - a.y())) / area;
    if (beta < -1e-9 || gamma < -1e-9 || beta + gamma > 1.0 + 1e-9) continue;
    heights.push_back(a.z() + beta * (b.z() - a.z()) + gamma * (c.z() - a.z()));
  }
  return heights;
}

/// The floor under a gauge, as its coordinate along the axis: the lowest wall of the tank that bounds the open space from below. A tank
/// with thick walls has its outer skin below that: a sampled wall element marks the wetted one.
double floor_height(const Layout& layout, const Vector3d& place, const Top& top) {
  double floor = top.bottom_of(layout.domain);
  double nearest = std::numeric_limits<double>::max();
  std::vector<double> heights;
  if (!layout.meshes.empty()) heights = crossings(layout.meshes[0], place, top.axis);
  for (const WallElement& wall : layout.walls) {
    if (wall.owner != 0 || top.way * wall.normal[top.axis] > -0.3) continue;
    const double away = upright(wall.centre - place, top.axis).head<2>().norm();
    if (away < nearest) {
      nearest = away;
      floor = wall.centre[top.axis];
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
    : world_(world), interval_(0.25 * layout.spacing), way_(top_of(scene).way) {
  const Top top = top_of(scene);
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
    Vector3d place = gauge.position;
    if (scene.dimensions == 2) place.y() = 0;
    line.floor = floor_height(layout, place, top);
    const int count = static_cast<int>(std::floor(way_ * (top.of(layout.domain) - line.floor) / interval_)) + 1;
    for (int k = 0; k < count; ++k) {
      place[top.axis] = line.floor + way_ * k * interval_;
      places_.push_back(place);
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
    levels.push_back(line.floor + way_ * column);
  }
  return levels;
}

}  // namespace wavetank

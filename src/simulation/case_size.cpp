#include "wavetank/simulation/case_size.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <numeric>

#include "wavetank/common/log.h"
#include "wavetank/rigid/draught.h"

namespace wavetank {
namespace {

constexpr double fewest_over_depth = 4;  ///< particles

/// Water on one upright line, of one free surface; bodies in it and on it do not count.
struct WaterColumn {
  double bottom = 0, top = 0;  ///< m
  int cell[2] = {0, 0};        ///< of the floor plan
};

/// The columns of all water, on a floor plan of one and a half spacings.
std::vector<WaterColumn> water_columns(const Layout& layout) {
  const double cell = 1.5 * layout.spacing, gap = 1.75 * layout.spacing, half = 0.5 * layout.spacing;
  const Vector3d& up = layout.up;
  const Vector3d beside = std::abs(up.x()) < 0.9 ? Vector3d::UnitX() : Vector3d::UnitY();
  const Vector3d along = (beside - up.dot(beside) * up).normalized(), across = up.cross(along);
  std::map<std::array<int, 2>, std::vector<std::pair<double, double>>> heights;  // of particles along `up`, and their levels
  for (std::size_t i = 0; i < layout.particles.size() - layout.beyond; ++i) {
    const Vector3d from_corner = layout.particles[i] - layout.domain.min;
    heights[{static_cast<int>(std::floor(along.dot(from_corner) / cell)), static_cast<int>(std::floor(across.dot(from_corner) / cell))}]
        .emplace_back(up.dot(layout.particles[i]), layout.levels[i]);
  }
  std::vector<WaterColumn> columns;
  for (auto& column : heights) {
    const std::array<int, 2>& place = column.first;
    std::vector<std::pair<double, double>>& particles = column.second;  // by name: C++17 captures no structured bindings
    std::sort(particles.begin(), particles.end());
    for (std::size_t begin = 0; begin < particles.size();) {
      std::size_t end = begin + 1;
      const auto goes_on = [&] {  // in boxes one upon the other, or on the other side of a body
        const auto& [low, low_level] = particles[end - 1];
        const auto& [high, high_level] = particles[end];
        return high - low < gap || std::abs(high_level - low_level) < half;
      };
      while (end < particles.size() && goes_on()) ++end;
      const auto& [highest, level] = particles[end - 1];
      columns.push_back({particles[begin].first - std::clamp(level - highest, 0.0, half), level, {place[0], place[1]}});
      begin = end;
    }
  }
  return columns;
}

/// Which of the waters that are joined side by side each column belongs to: the index of one of its columns.
std::vector<std::size_t> waters(const std::vector<WaterColumn>& columns) {
  std::vector<std::size_t> parent(columns.size());
  std::iota(parent.begin(), parent.end(), std::size_t(0));
  const auto root = [&](std::size_t c) {
    while (parent[c] != c) c = parent[c] = parent[parent[c]];
    return c;
  };
  std::map<std::array<int, 2>, std::vector<std::size_t>> at;
  for (std::size_t c = 0; c < columns.size(); ++c) at[{columns[c].cell[0], columns[c].cell[1]}].push_back(c);
  for (std::size_t c = 0; c < columns.size(); ++c) {
    for (const auto& step : {std::array<int, 2>{1, 0}, std::array<int, 2>{0, 1}}) {
      const auto beside = at.find({columns[c].cell[0] + step[0], columns[c].cell[1] + step[1]});
      if (beside == at.end()) continue;
      for (const std::size_t other : beside->second)
        if (columns[other].bottom < columns[c].top && columns[c].bottom < columns[other].top) parent[root(other)] = root(c);
    }
  }
  std::vector<std::size_t> owner(columns.size());
  for (std::size_t c = 0; c < columns.size(); ++c) owner[c] = root(c);
  return owner;
}

/// Shores are shallow everywhere: what counts is how deep each water is over all but a quarter of its surface.
double least_depth(const Layout& layout) {
  const std::vector<WaterColumn> columns = water_columns(layout);
  const std::vector<std::size_t> water = waters(columns);
  std::map<std::size_t, std::vector<double>> depths;
  for (std::size_t c = 0; c < columns.size(); ++c) depths[water[c]].push_back(columns[c].top - columns[c].bottom);
  double least = 0;
  for (auto& [ignored, of_one] : depths) {
    const auto quarter = of_one.begin() + static_cast<std::ptrdiff_t>(of_one.size() / 4);
    std::nth_element(of_one.begin(), quarter, of_one.end());
    if (least == 0 || *quarter < least) least = *quarter;
  }
  return least;
}

/// Nothing but its weight and the water decides where a body comes to lie.
bool floats_alone(const Case& scene, std::size_t body) {
  const BodyCase& it = scene.bodies[body];
  const bool down = scene.gravity.z() < 0 && scene.gravity.x() == 0 && scene.gravity.y() == 0;
  const auto holds = [&](const JointCase& joint) { return joint.child == it.name || joint.parent == it.name; };
  return down && it.motion == Motion::free && it.rigid.moorings.empty() && it.rigid.forces.empty() &&
         std::none_of(scene.joints.begin(), scene.joints.end(), holds);
}

std::optional<double> draught_of(const Case& scene, std::size_t body, const TriangleMesh& mesh, double displaced) {
  const auto* box = std::get_if<Box>(&scene.bodies[body].shape);
  if (box == nullptr) return draught(mesh, displaced, scene.dimensions);
  const Vector3d size = box->max - box->min;
  const double depth = displaced / (size.x() * (scene.dimensions == 2 ? 1.0 : size.y()));
  return depth <= size.z() ? std::optional<double>(depth) : std::nullopt;
}

std::string rounded(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

}  // namespace

CaseSize size_of(const Case& scene, const Layout& layout, const RigidWorld& world) {
  CaseSize size;
  // without what is in the pockets behind openings
  size.water_volume = std::accumulate(layout.volumes.begin(), layout.volumes.end() - static_cast<std::ptrdiff_t>(layout.beyond), 0.0);
  size.water_mass = scene.fluid.density * size.water_volume;
  size.least_depth = least_depth(layout);
  for (std::size_t o = 0; o < world.count(); ++o) {
    const Box box = layout.meshes[o].bounding_box();
    OwnerSize owner;
    owner.name = o == 0 ? "tank" : scene.bodies[o - 1].name;
    owner.size = o == 0 ? Vector3d(layout.domain.max - layout.domain.min) : Vector3d(box.max - box.min);
    owner.volume = world.properties(o).volume;
    owner.mass = world.properties(o).mass;
    const auto* tank = std::get_if<BoxTank>(&scene.tank.shape);
    if (o == 0 && tank != nullptr) owner.volume = tank->size.x() * tank->size.z() * (scene.dimensions == 2 ? 1.0 : tank->size.y());
    if (o > 0) {
      owner.floats_alone = floats_alone(scene, o - 1);
      if (owner.floats_alone) owner.draught = draught_of(scene, o - 1, layout.meshes[o], owner.mass / scene.fluid.density);
      Vector3d extent = owner.size;
      if (scene.dimensions == 2) extent.y() = extent.x();
      if (!size.least_extent || extent.minCoeff() < *size.least_extent) {
        size.least_extent = extent.minCoeff();
        size.thinnest_body = owner.name;
      }
    }
    size.owners.push_back(owner);
  }
  return size;
}

void tell_of_shallow_water(const Layout& layout) {
  if (layout.particles.size() == layout.beyond) return;  // all of it comes later
  const double depth = least_depth(layout);
  if (!(depth < (fewest_over_depth - 0.01) * layout.spacing)) return;
  log(LogLevel::warning, "the water is only " + rounded(depth / layout.spacing) + " spacings deep (" + rounded(depth) +
                             " m) over a quarter of " + "its surface or more: fewer than " + rounded(fewest_over_depth) +
                             " particles over its depth cannot tell how it moves; choose a smaller fluid/spacing than " +
                             rounded(layout.spacing) + " m");
}

}  // namespace wavetank

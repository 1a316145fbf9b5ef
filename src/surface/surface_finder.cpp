#include "wavetank/surface/surface_finder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "contour.h"
#include "wall_distances.h"
#include "wavetank/common/error.h"

namespace wavetank {
namespace {

constexpr float half_full = 0.5F;
/// By which the filling changes over a spacing at the water's surface: distances from walls count as much.
constexpr float slope = 0.5F;
/// In the air: as far below the surface's value as the inside of the water is above it.
constexpr float dry = -0.5F;
/// Of the particles that would fill it, in a block deep in the water.
constexpr double least_packed = 0.5;

/// Of a case in 2-D: how far layers of nodes about its plane are apart, in spacings. Four lie within the slab, one on either side outside.
constexpr double between_layers = 0.3;
/// What a contour of such a grid takes off a ball, by its flat triangles and by vertices within cells: as if it were so much more blurred,
/// in spacings².
constexpr double blur_of_contour = 0.2;

float value_of(float filling, float walls) { return std::clamp(std::min(filling - half_full, slope * walls), dry, -dry); }

/// Where the particles are, by blocks of two nodes along each direction.
class Blocks {
 public:
  Blocks(const std::vector<Eigen::Vector3f>& particles, const NodeGrid& grid, int dimensions) : flat_(dimensions == 2) {
    std::vector<Node> blocks;
    blocks.reserve(particles.size());
    first_.fill(std::numeric_limits<int>::max());
    Node last;
    last.fill(std::numeric_limits<int>::min());
    for (const Eigen::Vector3f& particle : particles) {
      const Eigen::Vector3d where = grid.in_cells(particle.cast<double>());
      Node block;
      for (int axis = 0; axis < 3; ++axis) {
        block[axis] = is_flat(axis) ? 0 : static_cast<int>(std::floor(where[axis] + 0.5)) >> 1;
        first_[axis] = std::min(first_[axis], block[axis]);
        last[axis] = std::max(last[axis], block[axis]);
      }
      blocks.push_back(block);
    }
    if (particles.empty()) return;
    for (int axis = 0; axis < 3; ++axis) {  // a border of one block
      first_[axis] -= is_flat(axis) ? 0 : 1;
      size_[axis] = last[axis] - first_[axis] + (is_flat(axis) ? 1 : 2);
    }
    counts_.assign(static_cast<std::size_t>(size_[0]) * size_[1] * size_[2], 0);
    for (const Node& block : blocks) ++counts_[index({block[0] - first_[0], block[1] - first_[1], block[2] - first_[2]})];
  }

  int count() const { return static_cast<int>(counts_.size()); }
  int particles_in(int block) const { return counts_[block]; }
  /// Whether any or all of the block and those around it fulfil a condition.
  template <class Condition>
  bool any_about(int block, const Condition& condition) const {
    const Node at = place(block);
    for (int z = std::max(at[2] - 1, 0); z <= std::min(at[2] + 1, size_[2] - 1); ++z)
      for (int y = std::max(at[1] - 1, 0); y <= std::min(at[1] + 1, size_[1] - 1); ++y)
        for (int x = std::max(at[0] - 1, 0); x <= std::min(at[0] + 1, size_[0] - 1); ++x)
          if (condition(index({x, y, z}))) return true;
    return false;
  }
  template <class Action>
  void for_nodes(int block, const Action& action) const {
    const Node at = place(block);
    for (int z = 0; z < 2; ++z)
      for (int y = 0; y < (flat_ ? 1 : 2); ++y)
        for (int x = 0; x < 2; ++x)
          action(Node{2 * (at[0] + first_[0]) + x, flat_ ? 0 : 2 * (at[1] + first_[1]) + y, 2 * (at[2] + first_[2]) + z});
  }
  /// Whether the block is at the border, where blocks around it are missing.
  bool is_border(int block) const {
    const Node at = place(block);
    for (int axis = 0; axis < 3; ++axis)
      if (!is_flat(axis) && (at[axis] == 0 || at[axis] == size_[axis] - 1)) return true;
    return false;
  }

 private:
  bool is_flat(int axis) const { return flat_ && axis == 1; }
  int index(const Node& at) const { return (at[2] * size_[1] + at[1]) * size_[0] + at[0]; }
  Node place(int block) const { return {block % size_[0], block / size_[0] % size_[1], block / (size_[0] * size_[1])}; }

  bool flat_;
  Node first_{}, size_{};
  std::vector<int> counts_;
};

}  // namespace

bool can_find_surface() { return can_contour(); }

struct SurfaceFinder::Parts {
  explicit Parts(const Simulation& simulation);

  /// In spacings, of all walls where they are now.
  float to_walls(const Node& node, const std::vector<std::optional<RigidState>>& moved) const;
  std::vector<std::optional<RigidState>> moved_owners(const RigidWorld& world) const;
  Contour contour_of(const std::vector<NodeValue>& values) const;
  std::vector<float> sharpened(const WaterField& field) const;
  std::vector<NodeValue> slab(const std::vector<NodeValue>& plane) const;
  std::vector<Eigen::Vector3f> spray(const WaterField& field) const;
  HeightMap height_map(const std::vector<NodeValue>& values) const;

  int dimensions;
  double blur;  ///< variance of the kernel along an axis, with what the contour adds, spacings²
  Top top;
  Box domain;
  NodeGrid grid;
  std::vector<bool> moving;
  std::vector<Vector3d> references;
  std::array<bool, 3> periodic;
  std::vector<std::unique_ptr<WallDistances>> walls;  ///< of each owner, where the layout has it
  std::size_t most_triangles = 0;
};

SurfaceFinder::Parts::Parts(const Simulation& simulation)
    : dimensions(simulation.scene().dimensions),
      blur(blur_of_contour + (dimensions == 2 ? 5.0 / 72 : 1.0 / 15) * std::pow(simulation.scene().numerics.support.value_or(3), 2)),
      top(top_of(simulation.scene())),
      domain(simulation.layout().domain) {
  const Layout& layout = simulation.layout();
  grid.cell = layout.spacing;
  grid.origin = domain.min + Vector3d::Constant(0.5 * grid.cell);  // walls along the axes lie between nodes
  if (dimensions == 2) grid.origin.y() = 0;
  moving = layout.moving;
  for (int axis = 0; axis < 3; ++axis) periodic[axis] = simulation.scene().tank.periodic[axis];
  for (std::size_t o = 0; o < simulation.bodies().count(); ++o) {
    references.push_back(simulation.bodies().reference(o));
    walls.push_back(std::make_unique<WallDistances>(layout.facets, static_cast<int>(o), dimensions, grid));
  }
}

std::vector<std::optional<RigidState>> SurfaceFinder::Parts::moved_owners(const RigidWorld& world) const {
  std::vector<std::optional<RigidState>> moved(walls.size());
  for (std::size_t o = 1; o < walls.size(); ++o)
    if (moving[o]) moved[o] = world.state_in_tank(o);
  return moved;
}

float SurfaceFinder::Parts::to_walls(const Node& node, const std::vector<std::optional<RigidState>>& moved) const {
  float least = WallDistances::reach;
  const Vector3d place = grid.place(node);
  for (std::size_t o = 0; o < walls.size(); ++o) {
    const Vector3d given = moved[o] ? moved[o]->orientation.conjugate() * (place - moved[o]->position) + references[o] : place;
    const Box& box = walls[o]->box();
    if ((given.array() < box.min.array()).any() || (given.array() > box.max.array()).any()) continue;
    least = std::min(least, moved[o] ? walls[o]->at(given) : walls[o]->at(node));
  }
  for (int axis = 0; axis < 3; ++axis)  // where the water goes on at the other end
    if (periodic[axis])
      least = std::min(least, static_cast<float>(std::min(place[axis] - domain.min[axis], domain.max[axis] - place[axis]) / grid.cell));
  return least;
}

/// The filling less half the blur's variance times its Laplacian: without what that rounds off where the surface is curved.
std::vector<float> SurfaceFinder::Parts::sharpened(const WaterField& field) const {
  constexpr float in_walls = -1;
  NodeValues<float> known(0);
  for (std::size_t n = 0; n < field.nodes.size(); ++n) known[field.nodes[n]] = field.walls[n] > 0 ? field.filling[n] : in_walls;
  std::vector<float> result = field.filling;
  for (std::size_t n = 0; n < field.nodes.size(); ++n) {
    if (field.walls[n] <= 0) continue;
    float laplacian = 0;
    for (int axis = 0; axis < 3; ++axis)
      for (const int way : {-1, 1}) {
        if (dimensions == 2 && axis == 1) continue;
        Node beside = field.nodes[n];
        beside[axis] += way;
        const float value = known.at(beside);
        if (value != in_walls) laplacian += value - field.filling[n];
      }
    result[n] -= static_cast<float>(0.5 * blur) * laplacian;
  }
  return result;
}

Contour SurfaceFinder::Parts::contour_of(const std::vector<NodeValue>& values) const {
  Contour found = contour(values, dry, most_triangles);
  for (int step = 2; found.triangles.size() > most_triangles; step *= 2) {
    std::vector<NodeValue> fewer;
    for (const NodeValue& each : values)
      if (each.node[0] % step == 0 && each.node[1] % step == 0 && each.node[2] % step == 0)
        fewer.push_back({{each.node[0] / step, each.node[1] / step, each.node[2] / step}, each.value});
    found = contour(fewer, dry, most_triangles);
    for (Eigen::Vector3f& vertex : found.vertices) vertex *= static_cast<float>(step);
  }
  return found;
}

/// Values fall off across its faces so that they pass through 0 there, whatever they are in the plane.
std::vector<NodeValue> SurfaceFinder::Parts::slab(const std::vector<NodeValue>& plane) const {
  constexpr double within = 0.5 - 1.5 * between_layers, beyond = between_layers - within;
  std::vector<NodeValue> values;
  for (const NodeValue& each : plane) {
    const float outside = each.value > 0 ? static_cast<float>(-each.value * beyond / within) : each.value;
    for (int layer = -2; layer <= 3; ++layer)
      values.push_back({{each.node[0], layer, each.node[2]}, layer >= -1 && layer <= 2 ? each.value : outside});
  }
  return values;
}

/// Particles where the water between the nodes about them, leaving out those in walls, is not half full.
std::vector<Eigen::Vector3f> SurfaceFinder::Parts::spray(const WaterField& field) const {
  constexpr float in_walls = -1;
  NodeValues<float> filling(0);
  for (std::size_t n = 0; n < field.nodes.size(); ++n) filling[field.nodes[n]] = field.walls[n] > 0 ? field.filling[n] : in_walls;
  std::vector<Eigen::Vector3f> found;
  for (const Eigen::Vector3f& particle : field.particles) {
    const Eigen::Vector3f where = grid.in_cells(particle.cast<double>()).cast<float>();
    const Eigen::Vector3f low = where.array().floor(), part = where - low;
    float sum = 0, weights = 0;
    for (int k = 0; k < 8; ++k) {
      float weight = 1;
      Node node;
      for (int axis = 0; axis < 3; ++axis) {
        const bool is_far = (k >> axis & 1) != 0;
        weight *= is_far ? part[axis] : 1 - part[axis];
        node[axis] = static_cast<int>(low[axis]) + (is_far ? 1 : 0);
      }
      if (weight <= 0) continue;
      const float value = filling.at(node);
      if (value == in_walls) continue;
      sum += weight * value;
      weights += weight;
    }
    if (weights > 0 && sum < half_full * weights) found.push_back(particle);
  }
  return found;
}

HeightMap SurfaceFinder::Parts::height_map(const std::vector<NodeValue>& values) const {
  // the two directions across the top's axis; in 2-D there is one
  const int down_rows = dimensions == 2 ? 2 - top.axis : std::min((top.axis + 1) % 3, (top.axis + 2) % 3);
  const int along_row = 3 - top.axis - down_rows;
  const auto nodes_along = [&](int axis) {
    return dimensions == 2 && axis == 1 ? 1 : static_cast<int>(std::ceil((domain.max[axis] - domain.min[axis]) / grid.cell - 1e-6));
  };
  HeightMap map;
  map.rows = nodes_along(down_rows);
  map.columns = nodes_along(along_row);
  map.resolution = grid.cell;
  map.first = grid.origin + grid.cell * ((map.rows - 1) * Vector3d::Unit(down_rows) + (map.columns - 1) * Vector3d::Unit(along_row));
  map.first[top.axis] = 0;
  map.heights.assign(static_cast<std::size_t>(map.rows) * map.columns, std::numeric_limits<float>::quiet_NaN());
  NodeValues<float> known(dry);
  for (const NodeValue& each : values) known[each.node] = each.value;
  for (const NodeValue& each : values) {
    const int row = map.rows - 1 - each.node[down_rows], column = map.columns - 1 - each.node[along_row];
    if (each.value < 0 || row < 0 || row >= map.rows || column < 0 || column >= map.columns) continue;
    Node over = each.node;
    over[top.axis] += top.way;
    const float above = known.at(over);
    if (above >= 0) continue;
    const float part = each.value / (each.value - above);
    const auto height = static_cast<float>(grid.place(each.node)[top.axis] + top.way * part * grid.cell);
    float& highest = map.heights[static_cast<std::size_t>(row) * map.columns + column];
    if (!(static_cast<float>(top.way) * (height - highest) <= 0)) highest = height;
  }
  return map;
}

SurfaceFinder::SurfaceFinder(const Simulation& simulation, std::size_t most_triangles) : parts_(std::make_unique<Parts>(simulation)) {
  if (!can_find_surface()) throw Error(why_no_surface);
  parts_->most_triangles = most_triangles;
}

SurfaceFinder::~SurfaceFinder() = default;

WaterField SurfaceFinder::look_at(const Simulation& simulation) const {
  const Parts& parts = *parts_;
  WaterField field;
  field.time = simulation.state().time;
  field.particles = simulation.places();
  const auto moved = parts.moved_owners(simulation.bodies());
  const Blocks blocks(field.particles, parts.grid, parts.dimensions);
  std::vector<char> is_near(blocks.count()), is_packed(blocks.count());
  std::vector<std::array<float, 8>> walls(blocks.count());
  for (int b = 0; b < blocks.count(); ++b) {
    is_near[b] = static_cast<char>(blocks.any_about(b, [&](int other) { return blocks.particles_in(other) > 0; }));
    if (!is_near[b]) continue;
    double room = 0;  // in spacings³, that is not behind walls
    int k = 0;
    blocks.for_nodes(b, [&](const Node& node) {
      walls[b][k] = parts.to_walls(node, moved);
      room += std::clamp(walls[b][k] + 0.5, 0.0, 1.0);
      ++k;
    });
    is_packed[b] = static_cast<char>(blocks.particles_in(b) >= least_packed * room);
  }
  std::vector<std::size_t> asked;
  std::vector<Vector3d> places;
  for (int b = 0; b < blocks.count(); ++b) {
    if (!is_near[b]) continue;
    const bool is_deep = !blocks.is_border(b) && !blocks.any_about(b, [&](int other) { return is_packed[other] == 0; });
    int k = 0;
    blocks.for_nodes(b, [&](const Node& node) {
      const float to_walls = walls[b][k++];
      if (to_walls <= -1) return;
      if (!is_deep && to_walls > 0) {
        asked.push_back(field.nodes.size());
        places.push_back(parts.grid.place(node));
      }
      field.nodes.push_back(node);
      field.walls.push_back(to_walls);
    });
  }
  field.filling.assign(field.nodes.size(), 1.0F);
  const std::vector<float> filling = places.empty() ? std::vector<float>() : simulation.filling(places);
  for (std::size_t n = 0; n < asked.size(); ++n) field.filling[asked[n]] = filling[n];
  return field;
}

WaterSurface SurfaceFinder::find(const WaterField& field) const {
  const Parts& parts = *parts_;
  std::vector<NodeValue> values;
  values.reserve(field.nodes.size());
  const std::vector<float> filling = parts.sharpened(field);
  for (std::size_t n = 0; n < field.nodes.size(); ++n) values.push_back({field.nodes[n], value_of(filling[n], field.walls[n])});
  Contour found = parts.contour_of(parts.dimensions == 2 ? parts.slab(values) : values);
  WaterSurface surface;
  surface.time = field.time;
  for (const Eigen::Vector3f& vertex : found.vertices) {
    Eigen::Vector3d place = parts.grid.origin + parts.grid.cell * vertex.cast<double>();
    if (parts.dimensions == 2) place.y() = between_layers * parts.grid.cell * (vertex.y() - 0.5);
    surface.vertices.push_back(place.cast<float>());
  }
  surface.triangles = std::move(found.triangles);
  surface.spray = parts.spray(field);
  surface.heights = parts.height_map(values);
  return surface;
}

}  // namespace wavetank

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
/// Of the particles that would fill it, in a block deep in the water. More than half: a cavity of two layers of nodes may take half of two
/// blocks each. Not much more: few blocks of disordered water would be deep.
constexpr double least_packed = 0.7;

/// Of a case in 2-D: how far layers of nodes about its plane are apart, in spacings. Four lie within the slab, one on either side outside.
constexpr double between_layers = 0.3;
/// What a contour of such a grid takes off a ball, by its flat triangles and by vertices within cells: as if it were so much more blurred,
/// in spacings².
constexpr double blur_of_contour = 0.2;

/// Of a few bytes each.
constexpr double most_blocks = 2e8;

float value_of(float filling, float walls) { return std::clamp(std::min(filling - half_full, slope * walls), dry, -dry); }

Node moved_along(Node node, int axis, int way) {
  node[axis] += way;
  return node;
}

/// Where the particles are, by blocks of two nodes along each direction. All are finite, and not far away.
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
    double count = 1;
    for (int axis = 0; axis < 3; ++axis) {  // a border of one block
      first_[axis] -= is_flat(axis) ? 0 : 1;
      size_[axis] = last[axis] - first_[axis] + (is_flat(axis) ? 1 : 2);
      count *= size_[axis];
    }
    if (count > most_blocks) throw Error("the water lies too far apart for a surface: raise fluid/spacing");
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

  void leave_out_lost(std::vector<Eigen::Vector3f>& particles) const;
  /// In spacings, of all walls where they are now.
  float to_walls(const Node& node, const std::vector<std::optional<RigidState>>& moved) const;
  float to_walls_at_rest(const Node& node) const;
  float to_wall(std::size_t owner, const Node& node, const Vector3d& place, const std::vector<std::optional<RigidState>>& moved) const;
  std::vector<std::optional<RigidState>> moved_owners(const RigidWorld& world) const;
  float to_openings(const Vector3d& place, const std::vector<std::optional<RigidState>>& moved, bool in_moving_owners) const;
  void leave_out_beyond(const std::vector<std::optional<RigidState>>& moved, std::vector<Eigen::Vector3f>& particles) const;
  Vector3d as_given(const Vector3d& place, std::size_t owner, const std::vector<std::optional<RigidState>>& moved) const;
  Contour contour_of(const std::vector<NodeValue>& values) const;
  std::vector<float> drawn_to_walls(const WaterField& field, const NodeValues<int>& numbers) const;
  std::vector<float> sharpened(const WaterField& field, const std::vector<float>& filling, const NodeValues<int>& numbers) const;
  std::vector<NodeValue> slab(const std::vector<NodeValue>& plane) const;
  std::vector<Eigen::Vector3f> spray(const WaterField& field, const std::vector<float>& sharpened, const NodeValues<int>& numbers) const;
  HeightMap height_map(const std::vector<NodeValue>& values, const NodeValues<int>& numbers) const;

  int dimensions;
  double blur;  ///< variance of the kernel along an axis, with what the contour adds, spacings²
  Top top;
  Box domain;
  Box reach;  ///< of the solver's grid, and a margin: what is farther away is lost
  NodeGrid grid;
  std::vector<Opening> openings;
  std::vector<bool> moving;
  std::vector<Vector3d> references;
  std::array<bool, 3> periodic;
  std::vector<std::unique_ptr<WallDistances>> walls;                                 ///< of each owner, where the layout has it
  bool any_moves = false;                                                            ///< of the owners
  mutable NodeValues<float> walls_at_rest{std::numeric_limits<float>::quiet_NaN()};  ///< as far as they were asked for; of look_at alone
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
  reach = with_pockets(domain, layout.openings, dimensions);
  (top.way > 0 ? reach.max : reach.min)[top.axis] += top.way * (domain.max[top.axis] - domain.min[top.axis]);
  reach.min.array() -= WallDistances::reach * grid.cell;
  reach.max.array() += WallDistances::reach * grid.cell;
  openings = layout.openings;
  moving = layout.moving;
  any_moves = std::any_of(moving.begin() + 1, moving.end(), [](bool moves) { return moves; });
  for (int axis = 0; axis < 3; ++axis) periodic[axis] = simulation.scene().tank.periodic[axis];
  for (std::size_t o = 0; o < simulation.bodies().count(); ++o) {
    references.push_back(simulation.bodies().reference(o));
    walls.push_back(std::make_unique<WallDistances>(layout.facets, static_cast<int>(o), dimensions, grid));
  }
}

/// Those beyond the solver's grid, also where a coordinate is not finite.
void SurfaceFinder::Parts::leave_out_lost(std::vector<Eigen::Vector3f>& particles) const {
  const Eigen::Array3f least = reach.min.cast<float>(), most = reach.max.cast<float>();
  const auto is_lost = [&](const Eigen::Vector3f& at) { return !((at.array() >= least).all() && (at.array() <= most).all()); };
  particles.erase(std::remove_if(particles.begin(), particles.end(), is_lost), particles.end());
}

std::vector<std::optional<RigidState>> SurfaceFinder::Parts::moved_owners(const RigidWorld& world) const {
  std::vector<std::optional<RigidState>> moved(walls.size());
  for (std::size_t o = 1; o < walls.size(); ++o)
    if (moving[o]) moved[o] = world.state_in_tank(o);
  return moved;
}

/// Where a place was beside the owner before that moved: in the layout's coordinates.
Vector3d SurfaceFinder::Parts::as_given(const Vector3d& place, std::size_t owner,
                                        const std::vector<std::optional<RigidState>>& moved) const {
  if (!moved[owner]) return place;
  Vector3d given = moved[owner]->orientation.conjugate() * (place - moved[owner]->position) + references[owner];
  if (dimensions == 2) given.y() = 0;  // but for rounding it is; walls are known in that plane alone
  return given;
}

float SurfaceFinder::Parts::to_walls(const Node& node, const std::vector<std::optional<RigidState>>& moved) const {
  float& at_rest = walls_at_rest[node];
  if (std::isnan(at_rest)) at_rest = to_walls_at_rest(node);
  float least = at_rest;
  if (!any_moves) return least;
  const Vector3d place = grid.place(node);
  for (std::size_t o = 0; o < walls.size(); ++o)
    if (moving[o]) least = std::min(least, to_wall(o, node, place, moved));
  return std::min(least, to_openings(place, moved, true));
}

/// Of those that never move, of openings in these, and where the water goes on at the tank's other end.
float SurfaceFinder::Parts::to_walls_at_rest(const Node& node) const {
  const std::vector<std::optional<RigidState>> none(walls.size());
  const Vector3d place = grid.place(node);
  float least = WallDistances::reach;
  for (std::size_t o = 0; o < walls.size(); ++o)
    if (!moving[o]) least = std::min(least, to_wall(o, node, place, none));
  for (int axis = 0; axis < 3; ++axis)
    if (periodic[axis])
      least = std::min(least, static_cast<float>(std::min(place[axis] - domain.min[axis], domain.max[axis] - place[axis]) / grid.cell));
  return std::min(least, to_openings(place, none, false));
}

float SurfaceFinder::Parts::to_wall(std::size_t owner, const Node& node, const Vector3d& place,
                                    const std::vector<std::optional<RigidState>>& moved) const {
  const Vector3d given = as_given(place, owner, moved);
  const Box& box = walls[owner]->box();
  if ((given.array() < box.min.array()).any() || (given.array() > box.max.array()).any()) return WallDistances::reach;
  return moved[owner] ? walls[owner]->at(given) : walls[owner]->at(node);
}

/// In spacings, to the nearest opening in owners that move, or in those that do not, as if it were a wall: negative in the pocket behind
/// it, whose water is not the tank's.
float SurfaceFinder::Parts::to_openings(const Vector3d& place, const std::vector<std::optional<RigidState>>& moved,
                                        bool in_moving_owners) const {
  double least = WallDistances::reach;
  for (const Opening& opening : openings) {
    if (moving[opening.owner] != in_moving_owners) continue;
    const Vector3d way = (as_given(place, opening.owner, moved) - opening.centre) / grid.cell;
    const double before = way.dot(opening.normal);
    if (before < -opening.pocket / grid.cell - 1 || before > least) continue;
    const auto beside = [&](const Vector3d& axis, double length) {
      return std::max(std::abs(way.dot(axis)) - 0.5 * length / grid.cell, 0.0);
    };
    const double aside = std::hypot(dimensions == 2 ? 0.0 : beside(opening.across, opening.width), beside(opening.up, opening.height));
    if (before >= 0)
      least = std::min(least, std::hypot(before, aside));
    else if (aside < 0.5)
      least = std::min(least, before);
  }
  return static_cast<float>(least);
}

void SurfaceFinder::Parts::leave_out_beyond(const std::vector<std::optional<RigidState>>& moved,
                                            std::vector<Eigen::Vector3f>& particles) const {
  if (openings.empty()) return;
  const auto is_beyond = [&](const Eigen::Vector3f& at) {
    const Vector3d place = at.cast<double>();
    return to_openings(place, moved, false) < 0 || to_openings(place, moved, true) < 0;
  };
  particles.erase(std::remove_if(particles.begin(), particles.end(), is_beyond), particles.end());
}

/// Particles stand up to 0.9 spacings off a wall where the surface meets it, not half a one, so that the kernel finds less water there, by
/// 0.08 at most at rest. Nodes next to a wall take that from those behind them, as seen from the wall.
std::vector<float> SurfaceFinder::Parts::drawn_to_walls(const WaterField& field, const NodeValues<int>& numbers) const {
  constexpr float most = 0.08F;
  std::vector<float> result = field.filling;
  for (std::size_t n = 0; n < field.nodes.size(); ++n) {
    if (field.walls[n] <= 0 || field.walls[n] >= 1) continue;
    int behind = -1;
    float farthest = field.walls[n] + 0.5F;
    for (int axis = 0; axis < 3; ++axis)
      for (const int way : {-1, 1}) {
        if (dimensions == 2 && axis == 1) continue;
        const int beside = numbers.at(moved_along(field.nodes[n], axis, way));
        if (beside < 0 || field.walls[beside] <= farthest) continue;
        farthest = field.walls[beside];
        behind = beside;
      }
    if (behind >= 0) result[n] += std::clamp(field.filling[behind] - field.filling[n], 0.0F, most);
  }
  return result;
}

/// The filling less half the blur's variance times its Laplacian: without what that rounds off where the surface is curved.
std::vector<float> SurfaceFinder::Parts::sharpened(const WaterField& field, const std::vector<float>& filling,
                                                   const NodeValues<int>& numbers) const {
  std::vector<float> result = filling;
  for (std::size_t n = 0; n < field.nodes.size(); ++n) {
    if (field.walls[n] <= 0) continue;
    float laplacian = 0;
    for (int axis = 0; axis < 3; ++axis)
      for (const int way : {-1, 1}) {
        if (dimensions == 2 && axis == 1) continue;
        const int beside = numbers.at(moved_along(field.nodes[n], axis, way));
        if (beside < 0)
          laplacian -= filling[n];
        else if (field.walls[beside] > 0)
          laplacian += filling[beside] - filling[n];
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

/// Particles where the water between the nodes about them, leaving out those in walls, is not half full. By the same filling as the mesh,
/// so that each is in one of the two.
std::vector<Eigen::Vector3f> SurfaceFinder::Parts::spray(const WaterField& field, const std::vector<float>& sharpened,
                                                         const NodeValues<int>& numbers) const {
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
      const int number = numbers.at(node);
      if (number >= 0 && field.walls[number] <= 0) continue;
      if (number >= 0) sum += weight * sharpened[number];
      weights += weight;
    }
    if (weights > 0 && sum < half_full * weights) found.push_back(particle);
  }
  return found;
}

HeightMap SurfaceFinder::Parts::height_map(const std::vector<NodeValue>& values, const NodeValues<int>& numbers) const {
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
  for (const NodeValue& each : values) {
    const int row = map.rows - 1 - each.node[down_rows], column = map.columns - 1 - each.node[along_row];
    if (each.value < 0 || row < 0 || row >= map.rows || column < 0 || column >= map.columns) continue;
    const int over = numbers.at(moved_along(each.node, top.axis, top.way));
    const float above = over < 0 ? dry : values[over].value;
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
  parts.leave_out_lost(field.particles);
  const auto moved = parts.moved_owners(simulation.bodies());
  const Blocks blocks(field.particles, parts.grid, parts.dimensions);
  parts.leave_out_beyond(moved, field.particles);
  std::vector<char> is_near(blocks.count()), is_packed(blocks.count());
  std::vector<std::array<float, 8>> walls;  // of the near ones
  for (int b = 0; b < blocks.count(); ++b) {
    is_near[b] = static_cast<char>(blocks.any_about(b, [&](int other) { return blocks.particles_in(other) > 0; }));
    if (!is_near[b]) continue;
    double room = 0;  // in spacings³, that is not behind walls
    int k = 0;
    walls.emplace_back();
    blocks.for_nodes(b, [&](const Node& node) {
      walls.back()[k] = parts.to_walls(node, moved);
      room += std::clamp(walls.back()[k] + 0.5, 0.0, 1.0);
      ++k;
    });
    is_packed[b] = static_cast<char>(blocks.particles_in(b) >= least_packed * room);
  }
  std::size_t near = 0;
  std::vector<std::size_t> asked;
  std::vector<Vector3d> places;
  for (int b = 0; b < blocks.count(); ++b) {
    if (!is_near[b]) continue;
    const bool is_deep = !blocks.is_border(b) && !blocks.any_about(b, [&](int other) { return is_packed[other] == 0; });
    int k = 0;
    blocks.for_nodes(b, [&](const Node& node) {
      const float to_walls = walls[near][k++];
      if (to_walls <= -1) return;
      if (!is_deep && to_walls > 0) {
        asked.push_back(field.nodes.size());
        places.push_back(parts.grid.place(node));
      }
      field.nodes.push_back(node);
      field.walls.push_back(to_walls);
    });
    ++near;
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
  NodeValues<int> numbers(-1);  // of the field's nodes
  for (std::size_t n = 0; n < field.nodes.size(); ++n) numbers[field.nodes[n]] = static_cast<int>(n);
  const std::vector<float> filling = parts.sharpened(field, parts.drawn_to_walls(field, numbers), numbers);
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
  surface.spray = parts.spray(field, filling, numbers);
  surface.heights = parts.height_map(values, numbers);
  return surface;
}

}  // namespace wavetank

#include "wall_sampling.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "planar_regions.h"

namespace wavetank {
namespace {

constexpr double sliver = 0.1;        // of a cell: smaller clipped pieces join a neighbouring cell
constexpr double straight = 1e-6;     // rad
constexpr double curved_turn = 0.35;  // rad: lines that turn less at a corner are curved there

/// The grid that is laid over a flat region.
struct CellGrid {
  Eigen::Vector2d min, side;
  int count[2];
};

CellGrid lay_grid(const PlanarRegion& region, double spacing) {
  const Eigen::Vector2d size = region.max - region.min;
  // Across a strip narrower than the spacing the cells are shortened as well, to stay nearly square; but not on facets of a curved wall,
  // which are joined.
  const double shortest = std::min(size.x(), size.y());
  const double cell = region.curved ? spacing : std::min(spacing, std::max(shortest, 0.25 * spacing));
  CellGrid grid;
  grid.min = region.min;
  for (int axis = 0; axis < 2; ++axis) {
    grid.count[axis] = cells_in(size[axis], cell);
    grid.side[axis] = size[axis] / grid.count[axis];
  }
  return grid;
}

Vector3d in_space(const PlanarRegion& region, const Eigen::Vector2d& p) {
  return region.origin + p.x() * region.along + p.y() * region.across;
}

/// Cells low to high of a grid.
struct CellRange {
  int low[2], high[2];
  bool empty() const { return low[0] > high[0] || low[1] > high[1]; }
};

/// The cells that may lie within the box.
CellRange cells_within(const PlanarRegion& region, const CellGrid& grid, const std::optional<Box>& within) {
  CellRange range{{0, 0}, {grid.count[0] - 1, grid.count[1] - 1}};
  if (!within) return range;
  const Vector3d axes[2] = {region.along, region.across};
  const Vector3d middle = 0.5 * (within->min + within->max) - region.origin, half = 0.5 * (within->max - within->min);
  for (int axis = 0; axis < 2; ++axis) {
    const double centre = axes[axis].dot(middle), reach = axes[axis].cwiseAbs().dot(half);
    const double low = (centre - reach - grid.min[axis]) / grid.side[axis], high = (centre + reach - grid.min[axis]) / grid.side[axis];
    range.low[axis] = static_cast<int>(std::clamp(std::floor(low), 0.0, static_cast<double>(grid.count[axis])));
    range.high[axis] = static_cast<int>(std::clamp(std::floor(high), -1.0, grid.count[axis] - 1.0));
  }
  const Vector3d normal = region.along.cross(region.across);
  if (std::abs(normal.dot(middle)) > normal.cwiseAbs().dot(half)) range.high[0] = -1;  // its plane passes by
  return range;
}

void add_rectangle(const PlanarRegion& region, double spacing, const std::optional<Box>& within, std::vector<WallPatch>& patches) {
  const CellGrid grid = lay_grid(region, spacing);
  const CellRange range = cells_within(region, grid, within);
  const Eigen::Vector2d size = region.max - region.min;
  const auto corner = [&](int i, int j) {
    return in_space(region, {grid.min.x() + size.x() * i / grid.count[0], grid.min.y() + size.y() * j / grid.count[1]});
  };
  for (int j = range.low[1]; j <= range.high[1]; ++j) {
    for (int i = range.low[0]; i <= range.high[0]; ++i) {
      patches.push_back({{{corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)}},
                         region.along,
                         region.area / (size.x() * size.y()),
                         Vector3d::Zero(),
                         Vector3d::Zero(),
                         region.curved});
    }
  }
}

double area_of(const std::vector<Polygon>& pieces) {
  double area = 0;
  for (const Polygon& piece : pieces) area += vector_area(piece).norm();
  return area;
}

/// What of a polygon lies in the range's cells.
Polygon part_in(Polygon polygon, const CellGrid& grid, const CellRange& range, double tolerance) {
  for (int axis = 0; axis < 2; ++axis) {
    const Vector3d along = Vector3d::Unit(axis);
    if (range.low[axis] > 0) polygon = part_below(polygon, -along, -(grid.min[axis] + range.low[axis] * grid.side[axis]), tolerance);
    if (range.high[axis] + 1 < grid.count[axis])
      polygon = part_below(polygon, along, grid.min[axis] + (range.high[axis] + 1) * grid.side[axis], tolerance);
  }
  return polygon;
}

/// Pieces of the region's triangles by grid cell.
std::map<long, std::vector<Polygon>> clip_to_cells(const PlanarRegion& region, const CellGrid& grid, const CellRange& within) {
  std::map<long, std::vector<Polygon>> cells;
  const double tolerance = 1e-9 * grid.side.maxCoeff();
  for (const FlatTriangle& t : region.triangles) {
    const auto range = [&](int axis, int& low, int& high) {
      const double least = std::min({t[0][axis], t[1][axis], t[2][axis]}), most = std::max({t[0][axis], t[1][axis], t[2][axis]});
      low = std::clamp(static_cast<int>(std::floor((least - grid.min[axis]) / grid.side[axis] + 1e-9)), 0, grid.count[axis] - 1);
      high = std::clamp(static_cast<int>(std::floor((most - grid.min[axis]) / grid.side[axis] - 1e-9)), low, grid.count[axis] - 1);
      low = std::max(low, within.low[axis]);
      high = std::min(high, within.high[axis]);
    };
    int low[2], high[2];
    range(1, low[1], high[1]);
    Polygon rest;
    for (const Eigen::Vector2d& p : t) rest.emplace_back(p.x(), p.y(), 0.0);
    rest = part_in(std::move(rest), grid, within, tolerance);
    // Rows are cut off one after the other, and cells off each row: what is left over never gets lost at the last cut.
    for (int j = low[1]; j <= high[1] && !rest.empty(); ++j) {
      const double top = grid.min.y() + (j + 1) * grid.side.y();
      Polygon row = j == high[1] ? rest : part_below(rest, Vector3d::UnitY(), top, tolerance);
      rest = j == high[1] ? Polygon() : part_below(rest, -Vector3d::UnitY(), -top, tolerance);
      range(0, low[0], high[0]);
      for (int i = low[0]; i <= high[0] && !row.empty(); ++i) {
        const double right = grid.min.x() + (i + 1) * grid.side.x();
        const Polygon piece = i == high[0] ? row : part_below(row, Vector3d::UnitX(), right, tolerance);
        row = i == high[0] ? Polygon() : part_below(row, -Vector3d::UnitX(), -right, tolerance);
        if (piece.size() < 3) continue;
        Polygon placed;
        for (const Vector3d& p : piece) placed.push_back(in_space(region, {p.x(), p.y()}));
        cells[static_cast<long>(j) * grid.count[0] + i].push_back(placed);
      }
    }
  }
  return cells;
}

/// Cells of which little is left join the fullest of their four neighbours.
void join_slivers(std::map<long, std::vector<Polygon>>& cells, const CellGrid& grid) {
  std::map<long, double> area;
  for (const auto& [cell, pieces] : cells) area[cell] = area_of(pieces);
  const double least = sliver * grid.side.x() * grid.side.y();
  for (const auto& [cell, own] : area) {
    if (own >= least) continue;
    const long i = cell % grid.count[0], j = cell / grid.count[0];
    long best = -1;
    const auto consider = [&](bool exists, long other) {
      if (exists && area.count(other) && area[other] >= least && (best < 0 || area[other] > area[best])) best = other;
    };
    consider(i > 0, cell - 1);
    consider(i + 1 < grid.count[0], cell + 1);
    consider(j > 0, cell - grid.count[0]);
    consider(j + 1 < grid.count[1], cell + grid.count[0]);
    if (best < 0) continue;
    std::vector<Polygon>& target = cells[best];
    target.insert(target.end(), cells[cell].begin(), cells[cell].end());
    cells.erase(cell);
  }
}

void add_clipped(const PlanarRegion& region, double spacing, const std::optional<Box>& within, std::vector<WallPatch>& patches) {
  CellGrid grid = lay_grid(region, spacing);
  const Eigen::Vector2d size = region.max - region.min;
  if (region.area <= spacing * spacing && size.maxCoeff() <= 2 * spacing) {  // a facet smaller than a cell stays whole
    grid.count[0] = grid.count[1] = 1;
    grid.side = size;
  }
  const CellRange range = cells_within(region, grid, within);
  if (range.empty()) return;
  const bool whole = range.low[0] == 0 && range.low[1] == 0 && range.high[0] + 1 == grid.count[0] && range.high[1] + 1 == grid.count[1];
  std::map<long, std::vector<Polygon>> cells = clip_to_cells(region, grid, range);
  join_slivers(cells, grid);
  double sampled = 0;
  for (const auto& [cell, pieces] : cells) sampled += area_of(pieces);
  const double factor = whole ? region.area / sampled : 1.0;
  for (auto& [cell, pieces] : cells)
    patches.push_back({std::move(pieces), region.along, factor, Vector3d::Zero(), Vector3d::Zero(), region.curved});
}

double turn(const Vector3d& before, const Vector3d& after) {
  return std::acos(std::clamp(before.normalized().dot(after.normalized()), -1.0, 1.0));
}

/// The line without its points that lie within straight runs.
Polyline without_straight_points(const Polyline& line) {
  const int count = static_cast<int>(line.points.size());
  Polyline result;
  result.closed = line.closed;
  for (int k = 0; k < count; ++k) {
    const bool end = !line.closed && (k == 0 || k == count - 1);
    const Vector3d& here = line.points[k];
    const Vector3d before = here - line.points[(k + count - 1) % count], after = line.points[(k + 1) % count] - here;
    // the sine, not acos of a cosine near one, resolves small turns
    if (end || before.dot(after) <= 0 || before.cross(after).norm() > straight * before.norm() * after.norm())
      result.points.push_back(here);
  }
  return result;
}

/// The outer edges of a flat region as one loop without points on straight runs; empty if there are holes or more than one loop.
Polygon outline_of(const PlanarRegion& region) {
  using Corner = std::pair<double, double>;
  std::map<Corner, Corner> next;  // along outer edges, turning left
  std::set<std::pair<Corner, Corner>> edges;
  for (const FlatTriangle& t : region.triangles)
    for (int k = 0; k < 3; ++k) edges.insert({{t[k].x(), t[k].y()}, {t[(k + 1) % 3].x(), t[(k + 1) % 3].y()}});
  for (const auto& [from, to] : edges) {
    if (edges.count({to, from}) != 0) continue;
    if (!next.emplace(from, to).second) return {};  // two loops touch
  }
  if (next.empty()) return {};
  Polygon loop;
  Corner at = next.begin()->first;
  for (std::size_t k = 0; k < next.size(); ++k) {
    loop.emplace_back(at.first, at.second, 0.0);
    const auto found = next.find(at);
    if (found == next.end()) return {};
    at = found->second;
    if (at == next.begin()->first && k + 1 < next.size()) return {};
  }
  Polygon corners;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Vector3d before = loop[k] - loop[(k + loop.size() - 1) % loop.size()], after = loop[(k + 1) % loop.size()] - loop[k];
    if (before.dot(after) <= 0 || before.cross(after).norm() > straight * before.norm() * after.norm()) corners.push_back(loop[k]);
  }
  return corners;
}

/// A flat region cut anew, into as few triangles as its outline allows: how finely a mesh cuts a flat wall says nothing.
std::vector<FlatTriangle> in_few_triangles(const PlanarRegion& region) {
  const Polygon outline = outline_of(region);
  if (outline.size() < 3 || outline.size() >= region.triangles.size() + 2) return region.triangles;
  std::vector<FlatTriangle> result;
  double area = 0;
  for (const Eigen::Vector3i& t : triangulate(outline)) {
    FlatTriangle triangle;
    for (int k = 0; k < 3; ++k) triangle[k] = outline[t[k]].head<2>();
    const Eigen::Vector2d a = triangle[1] - triangle[0], b = triangle[2] - triangle[0];
    const double part = 0.5 * (a.x() * b.y() - a.y() * b.x());
    if (!(part > 0)) return region.triangles;  // the outline touches itself
    area += part;
    result.push_back(triangle);
  }
  return std::abs(area - region.area) <= 1e-6 * region.area ? result : region.triangles;
}

/// The pieces low to high of a straight run of `cells` that may lie within the box.
void pieces_within(const Vector3d& from, const Vector3d& way, const std::optional<Box>& within, int cells, int& low, int& high) {
  low = 0;
  high = cells - 1;
  if (!within) return;
  double enter = 0, leave = 1;
  for (const int axis : {0, 2}) {
    if (way[axis] == 0) continue;
    const double a = (within->min[axis] - from[axis]) / way[axis], b = (within->max[axis] - from[axis]) / way[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  low = static_cast<int>(std::min(std::floor(enter * cells), static_cast<double>(cells)));
  high = static_cast<int>(std::min(std::floor(leave * cells), cells - 1.0));
}

}  // namespace

std::vector<WallPatch> sample_mesh(const TriangleMesh& mesh, double spacing, const std::optional<Box>& within) {
  std::vector<WallPatch> patches;
  for (const PlanarRegion& region : planar_regions(mesh)) {
    if (region.is_rectangle()) {
      add_rectangle(region, spacing, within, patches);
    } else {
      add_clipped(region, spacing, within, patches);
    }
  }
  return patches;
}

std::vector<WallPatch> sample_outline(const Outline& outline, double spacing, const std::optional<Box>& within) {
  const Vector3d half(0, 0.5 * spacing, 0);
  std::vector<WallPatch> patches;
  for (const Polyline& given : outline) {
    const Polyline line = without_straight_points(given);
    const int count = static_cast<int>(line.points.size()), sides = line.closed ? count : count - 1;
    const auto side = [&](int k) { return Vector3d(line.points[(k + 1) % count] - line.points[k % count]); };
    const auto curved_at = [&](int k) {  // at the corner between side k − 1 and side k
      if (!line.closed && (k == 0 || k == sides)) return false;
      return turn(side((k + count - 1) % count), side(k % count)) < curved_turn;
    };
    for (int k = 0; k < sides; ++k) {
      const Vector3d from = line.points[k], way = side(k);
      const bool curved = curved_at(k) || curved_at(k + 1);
      const int cells = cells_in(way.norm(), spacing);
      int low, high;
      pieces_within(from, way, within, cells, low, high);
      for (int i = low; i <= high; ++i) {
        const Vector3d a = from + way * i / cells, b = from + way * (i + 1) / cells;
        patches.push_back({{{a - half, b - half, b + half, a + half}}, way.normalized(), 1.0, Vector3d::Zero(), Vector3d::Zero(), curved});
      }
    }
  }
  return patches;
}

std::vector<WallPatch> whole_facets(const TriangleMesh& mesh) {
  std::vector<WallPatch> patches;
  for (const PlanarRegion& region : planar_regions(mesh)) {
    for (const FlatTriangle& t : in_few_triangles(region)) {
      WallPatch patch;
      patch.pieces = {{in_space(region, t[0]), in_space(region, t[1]), in_space(region, t[2])}};
      patch.tangent = region.along;
      patch.plane_point = region.origin;
      patch.plane_normal = region.along.cross(region.across);
      patches.push_back(patch);
    }
  }
  return patches;
}

std::vector<WallPatch> whole_facets(const Outline& outline, double width) {
  const Vector3d half(0, 0.5 * width, 0);
  std::vector<WallPatch> patches;
  for (const Polyline& given : outline) {
    const Polyline line = without_straight_points(given);
    const std::size_t count = line.points.size(), sides = line.closed ? count : count - 1;
    for (std::size_t k = 0; k < sides; ++k) {
      const Vector3d a = line.points[k], b = line.points[(k + 1) % count];
      WallPatch patch;
      patch.pieces = {{a - half, b - half, b + half, a + half}};
      patch.tangent = (b - a).normalized();
      patch.plane_point = a;
      patch.plane_normal = patch.tangent.cross(Vector3d::UnitY());
      patches.push_back(patch);
    }
  }
  return patches;
}

}  // namespace wavetank

#include "openings.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "opening_parts.h"
#include "opening_pockets.h"
#include "polygon.h"
#include "wavetank/common/error.h"
#include "wavetank/common/expression.h"

namespace wavetank {
namespace {

constexpr double narrowest = 2;         // spacings
constexpr double least_part = 0.35;     // of a cell: less of one is given to its neighbour
constexpr double beside_opening = 1.2;  // spacings: water so near to an opening's front stands before it

// ---------------------------------------------------------------- place and lattice

void set_outline(const OpeningCase& given, int dimensions, double spacing, Opening& opening) {
  const auto corner = [&](double across, double up) -> Vector3d { return opening.centre + across * opening.across + up * opening.up; };
  if (given.diameter) {
    const double pi = std::acos(-1.0), radius = 0.5 * *given.diameter;
    opening.shape = Opening::Shape::disc;
    opening.width = opening.height = *given.diameter;
    const int sides = std::clamp(4 * static_cast<int>(std::lround(pi * radius / (2 * spacing))), 12, 64);
    const double outer = radius * std::sqrt(2 * pi / (sides * std::sin(2 * pi / sides)));  // the disc's area
    for (int k = 0; k < sides; ++k)
      opening.outline.push_back(corner(outer * std::cos(2 * pi * (k + 0.5) / sides), outer * std::sin(2 * pi * (k + 0.5) / sides)));
    return;
  }
  const double width = dimensions == 2 ? 0 : (*given.size)[0], height = (*given.size)[1];
  opening.width = width;
  opening.height = height;
  if (dimensions == 2) {
    opening.outline = {corner(0, -0.5 * height), corner(0, 0.5 * height)};
    return;
  }
  for (const auto& [x, y] : {std::pair(-0.5, -0.5), std::pair(0.5, -0.5), std::pair(0.5, 0.5), std::pair(-0.5, 0.5)})
    opening.outline.push_back(corner(x * width, y * height));
}

/// Of the lattice, so that a level is between two of its rows.
void set_cells(int axis, double length, double fitted, double spacing, Opening& opening) {
  const double step = fitted / cells_in(fitted, spacing);
  opening.first_edge[axis] = -0.5 * length;
  opening.cell_size[axis] = step;
  opening.cells[axis] = std::max(1, static_cast<int>(std::ceil(length / step - 1e-6)));
}

/// The part of a cell that is within the outline: its area and its centre.
Opening::Column part_of_cell(const Opening& opening, int i, int j) {
  Opening::Column part;
  const double low = opening.first_edge[1] + j * opening.cell_size[1];
  if (opening.width == 0) {
    const double high = std::min(low + opening.cell_size[1], 0.5 * opening.height);
    part.area = high - low;
    part.place = opening.centre + 0.5 * (low + high) * opening.up;
    return part;
  }
  const double left = opening.first_edge[0] + i * opening.cell_size[0];
  Polygon cell;
  for (const auto& [x, y] : {std::pair(0, 0), std::pair(1, 0), std::pair(1, 1), std::pair(0, 1)})
    cell.push_back(opening.centre + (left + x * opening.cell_size[0]) * opening.across + (low + y * opening.cell_size[1]) * opening.up);
  const std::size_t sides = opening.outline.size();
  for (std::size_t k = 0; k < sides && !cell.empty(); ++k) {
    const Vector3d edge = opening.outline[(k + 1) % sides] - opening.outline[k];
    const Vector3d outwards = edge.cross(opening.normal).normalized();
    cell = part_below(cell, outwards, outwards.dot(opening.outline[k]), 1e-9 * opening.height);
  }
  if (cell.size() < 3) return part;
  part.area = vector_area(cell).norm();
  part.place = centroid(cell);
  return part;
}

/// Columns of about a cell; slivers at the edge of the outline go to the fullest cell beside them, on their side of the level.
void set_columns(const std::function<bool(const Vector3d&)>& is_high, Opening& opening) {
  const int across = opening.cells[0], up = opening.cells[1];  // C++17 captures no names of structured bindings
  std::vector<Opening::Column> parts;
  for (int j = 0; j < up; ++j)
    for (int i = 0; i < across; ++i) parts.push_back(part_of_cell(opening, i, j));
  const double whole = opening.cell_size[1] * (opening.width == 0 ? 1.0 : opening.cell_size[0]);
  const auto beside = [&](int i, int j) {
    const int own = j * across + i;
    int best = -1;
    for (int dj = -1; dj <= 1; ++dj)
      for (int di = -1; di <= 1; ++di) {
        if (i + di < 0 || i + di >= across || j + dj < 0 || j + dj >= up || (di == 0 && dj == 0)) continue;
        const int other = (j + dj) * across + i + di;
        if (parts[other].area < least_part * whole || (parts[own].area > 0 && is_high(parts[own].place) != is_high(parts[other].place)))
          continue;
        if (best < 0 || parts[other].area > parts[best].area * (1 + 1e-9)) best = other;
      }
    return best;
  };
  std::vector<int> goes_to(parts.size());
  for (int j = 0; j < up; ++j)
    for (int i = 0; i < across; ++i) {
      const int own = j * across + i, other = parts[own].area < least_part * whole ? beside(i, j) : -1;
      goes_to[own] = other < 0 ? own : other;
    }
  opening.column_of.assign(parts.size(), -1);
  for (std::size_t c = 0; c < parts.size(); ++c) {
    if (goes_to[c] != static_cast<int>(c) || parts[c].area <= 0) continue;
    opening.column_of[c] = static_cast<int>(opening.columns.size());
    opening.columns.push_back(parts[c]);
  }
  for (std::size_t c = 0; c < parts.size(); ++c) {
    if (opening.column_of[c] >= 0) continue;
    if (goes_to[c] == static_cast<int>(c)) continue;  // beside the outline
    opening.column_of[c] = opening.column_of[goes_to[c]];
    if (parts[c].area <= 0) continue;
    Opening::Column& column = opening.columns[opening.column_of[c]];
    const double area = column.area + parts[c].area;
    column.place = (column.area * column.place + parts[c].area * parts[c].place) / area;
    column.area = area;
  }
  for (const Opening::Column& column : opening.columns) opening.area += column.area;
}

/// The water of the fill before an opening.
struct WaterBefore {
  struct Particle {
    Vector3d place;
    double level = 0;  ///< m along `up`
  };
  std::vector<Particle> particles;

  const Particle* nearest(const Vector3d& place, double radius) const {
    const Particle* found = nullptr;
    double least = radius;
    for (const Particle& particle : particles) {
      const double distance = (particle.place - place).norm();
      if (distance < least) least = distance, found = &particle;
    }
    return found;
  }
};

WaterBefore water_before(const Opening& opening, double spacing, const std::vector<FilledRegion>& regions, const Vector3d& up) {
  WaterBefore water;
  for (const FilledRegion& region : regions)
    for (std::size_t c = 0; c < region.filled.size(); ++c) {
      if (!region.filled[c]) continue;
      const Vector3d way = region.position[c] - opening.centre;
      const double before = opening.normal.dot(way);
      if (before < 0 || before > beside_opening * spacing || (way - before * opening.normal).norm() > opening.width + opening.height)
        continue;
      double level = region.surface.normal == up ? region.surface.height : up.dot(region.position[c]);
      if (!region.curved.height.empty()) level = region.curved.height[c % region.curved.height.size()];  // over this column
      water.particles.push_back({region.position[c], level});
    }
  return water;
}

/// Whether water beyond the opening is there at the start whatever is before it, at a height along `up`, m; a record is taken to hold it.
bool held_from_beyond(const OpeningCase& given, double height, int way) {
  if (given.kind == OpeningKind::outlet) return given.level && height < way * *given.level;
  if (given.kind != OpeningKind::pressure) return false;
  return given.head.empty() || height < way * Expression(given.head, Expression::Of::time).at(0.0);
}

Opening place_opening(const OpeningCase& given, const Case& checked, const Basin& basin, double spacing,
                      const std::vector<FilledRegion>& regions, const std::vector<const TriangleMesh*>& meshes) {
  Opening opening;
  opening.name = given.name;
  for (std::size_t b = 0; b < checked.bodies.size(); ++b)
    if (checked.bodies[b].name == given.body) opening.owner = static_cast<int>(b) + 1;
  if (given.part.empty()) {
    opening.centre = given.centre;
    opening.normal = given.normal.normalized();
    set_axes(given.up, basin.up, checked.dimensions, opening);
    set_outline(given, checked.dimensions, spacing, opening);
  } else {
    place_by_part(given, *meshes[opening.owner], opening.owner > 0, basin.up, checked.dimensions, spacing, opening);
  }
  if (opening.height < narrowest * spacing || (checked.dimensions == 3 && opening.width < narrowest * spacing))
    throw Error(called(opening) + " is narrower than two spacings of " + describe(spacing) +
                " m; make it larger, or fluid/spacing smaller");
  const double support = checked.numerics.support.value_or(checked.dimensions == 2 ? 4.0 : 3.0);
  opening.rows = static_cast<int>(std::ceil(support - 1e-9)) + 1;
  opening.depth = opening.rows * spacing;
  opening.pocket = opening.depth + spacing;

  const bool along_axis = basin.up == basin.top.normal();
  if (!along_axis && (given.level || given.kind == OpeningKind::pressure))
    throw Error(called(opening) + " has a level or a head, which is for gravity along an axis; leave it out");
  const auto height_of = [&](const Vector3d& place) { return basin.up.dot(place); };
  const auto along_up = [&](double coordinate) { return basin.top.way * coordinate; };
  const WaterBefore water = water_before(opening, spacing, regions, basin.up);

  std::optional<double> level;  // along `up`, that the lattice is fitted to
  if (given.level) {
    level = along_up(*given.level);
  } else if (given.kind != OpeningKind::inlet) {
    for (const WaterBefore::Particle& particle : water.particles) level = std::max(level.value_or(particle.level), particle.level);
  }
  const double bottom = height_of(opening.centre) - 0.5 * opening.height;
  const bool upright = opening.up.dot(basin.up) > 1 - 1e-9 && opening.shape == Opening::Shape::rectangle;
  const bool fits = level && upright && *level > bottom + 0.5 * spacing && *level < bottom + opening.height;
  set_cells(1, opening.height, fits ? *level - bottom : opening.height, spacing, opening);
  if (checked.dimensions == 3) set_cells(0, opening.width, opening.width, spacing, opening);
  set_columns([&](const Vector3d& place) { return fits && height_of(place) > *level; }, opening);

  for (Opening::Column& column : opening.columns) {
    const double height = height_of(column.place);
    if (given.kind == OpeningKind::inlet) {
      column.wet = !given.level || height < along_up(*given.level);
    } else {
      const WaterBefore::Particle* before = water.nearest(column.place + 0.5 * spacing * opening.normal, spacing);
      column.wet = (before != nullptr && height < before->level) || held_from_beyond(given, height, basin.top.way);
    }
  }
  const bool all_dry = std::none_of(opening.columns.begin(), opening.columns.end(), [](const Opening::Column& c) { return c.wet; });
  if (given.kind == OpeningKind::inlet && all_dry)
    throw Error(called(opening) + " has its level, " + describe(*given.level) + " m, below it, so that nothing comes in; raise the level");
  return opening;
}

/// In the lattice; row −1 is before the opening.
Vector3d in_row(const Opening& opening, const Opening::Column& column, int k, double spacing) {
  return column.place - (k + 0.5) * spacing * opening.normal;
}

}  // namespace

void check_overlaps(const std::vector<Opening>& openings, double spacing) {
  for (std::size_t o = 0; o < openings.size(); ++o)
    for (std::size_t other = 0; other < openings.size(); ++other) {
      if (other == o) continue;
      const std::vector<PocketSide> sides = sides_of_pocket(openings[other], spacing);
      for (const Opening::Column& column : openings[o].columns)
        for (int k = 0; k <= openings[o].rows; ++k) {
          const Vector3d place = in_row(openings[o], column, k, spacing);
          if (!std::all_of(sides.begin(), sides.end(), [&](const PocketSide& side) { return side.normal.dot(place) < side.offset; }))
            continue;
          throw Error(called(openings[o]) + " overlaps opening '" + openings[other].name + "', or the pockets of " +
                      describe(openings[o].pocket) + " m behind them do, about " + describe(place) + " m; move one of them");
        }
    }
}

std::vector<Opening> place_openings(const Case& checked, const Basin& basin, double spacing, const std::vector<FilledRegion>& regions,
                                    const std::vector<const TriangleMesh*>& meshes) {
  std::vector<Opening> openings;
  for (const OpeningCase& given : checked.openings) openings.push_back(place_opening(given, checked, basin, spacing, regions, meshes));
  return openings;
}

namespace {

/// Of a column's part of the pocket: its rows, what is beside it by more than the guard leaves a particle in a wall, and just behind the
/// back.
std::vector<Vector3d> places_behind(const Opening& opening, const Opening::Column& column, double spacing) {
  constexpr double beside = 0.6;  // of a cell, from a column's middle: within the outline, or hardly outside
  std::vector<double> depths;
  for (int k = 0; k <= opening.rows; ++k) depths.push_back((k + 0.5) * spacing);
  depths.push_back(opening.pocket + 0.1 * spacing);
  std::vector<Vector3d> places;
  for (const double depth : depths)
    for (const double across : {-beside, 0.0, beside})
      for (const double up : {-beside, 0.0, beside}) {
        if (opening.width == 0 && across != 0) continue;
        const Vector3d aside = across * opening.cell_size[0] * opening.across + up * opening.cell_size[1] * opening.up;
        places.push_back(column.place + aside - depth * opening.normal);
      }
  return places;
}

}  // namespace

void check_openings(const std::vector<Opening>& openings, const Basin& basin, const OpenSpace& closed, double spacing) {
  for (const Opening& opening : openings) {
    const std::string behind = called(opening) + " takes a pocket of " + describe(opening.pocket) + " m behind it, which ";
    for (const Opening::Column& column : opening.columns) {
      const Vector3d front = in_row(opening, column, -1, spacing);
      for (const Solid& solid : basin.solids)
        if (solid.contains(front))
          throw Error(called(opening) + " opens into body '" + solid.name +
                      "'; water must be able to come to it from the side of its normal");
      if (!closed.reached(front, front))
        throw Error(called(opening) + " opens where no water can come to, about " + describe(front) +
                    " m; its normal must point into the water");
      if (opening.owner > 0 &&
          basin.grid->crosses(in_row(opening, column, 0, spacing), column.place - opening.pocket * opening.normal, Walls::tank))
        throw Error(behind + "passes through a wall of the tank; make the body thicker, or move it");
      for (const Vector3d& place : places_behind(opening, column, spacing)) {
        if (closed.reached(place, place))
          throw Error(behind + "meets the space that water can reach, about " + describe(place) +
                      " m; there must be nothing behind an "
                      "opening but what is solid, or the outside of the tank");
        for (std::size_t b = 0; b < basin.solids.size(); ++b)
          if (static_cast<int>(b) + 1 != opening.owner && basin.solids[b].contains(place))
            throw Error(behind + "meets body '" + basin.solids[b].name + "' about " + describe(place) + " m; move one of them");
      }
    }
  }
}

std::vector<Vector3d> fronts_of(const std::vector<Opening>& openings, double spacing) {
  std::vector<Vector3d> fronts;
  for (const Opening& opening : openings)
    for (const Opening::Column& column : opening.columns) fronts.push_back(in_row(opening, column, -1, spacing));
  return fronts;
}

Box with_pockets(Box box, const std::vector<Opening>& openings, int dimensions) {
  for (const Opening& opening : openings)
    for (const Vector3d& corner : opening.outline)
      for (const Vector3d& point : {corner, Vector3d(corner - opening.pocket * opening.normal)}) {
        box.min = box.min.cwiseMin(point);
        box.max = box.max.cwiseMax(point);
      }
  if (dimensions == 2) box.min.y() = box.max.y() = 0;
  return box;
}

void add_water_beyond(const std::vector<FilledRegion>& regions, Layout& layout) {
  const std::size_t before_all = layout.particles.size();
  for (const Opening& opening : layout.openings) {
    const WaterBefore water = water_before(opening, layout.spacing, regions, layout.up);
    for (int k = 0; k < opening.rows; ++k)
      for (const Opening::Column& column : opening.columns) {
        if (!column.wet) continue;
        const Vector3d place = in_row(opening, column, k, layout.spacing);
        const WaterBefore::Particle* before = water.nearest(column.place, 3 * layout.spacing);
        layout.particles.push_back(place);
        layout.volumes.push_back(column.area * layout.spacing);
        layout.levels.push_back(before != nullptr ? before->level : layout.up.dot(place));
      }
  }
  layout.beyond = layout.particles.size() - before_all;
}

}  // namespace wavetank

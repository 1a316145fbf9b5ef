#include "flow_sections.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "opening_parts.h"
#include "polygon.h"
#include "wavetank/common/error.h"

namespace wavetank {
namespace {

const double pi = std::acos(-1.0);
constexpr int rim_corners = 24;  // of a disc's outline, which is for drawing

int cells_along(double length, double spacing) { return std::max(1, static_cast<int>(std::ceil(length / spacing - 1e-9))); }

/// A cell of the section, before it is known whether water can come to it.
struct SectionCell {
  Vector3d place;
  double area;
};

std::vector<SectionCell> cut_rectangle(const Opening& plane, double width, double height, int dimensions, double spacing) {
  const int rows = cells_along(height, spacing), columns = dimensions == 2 ? 1 : cells_along(width, spacing);
  const double up = height / rows, across = dimensions == 2 ? 0 : width / columns;
  std::vector<SectionCell> cells;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      cells.push_back({plane.centre + (up * (row + 0.5) - 0.5 * height) * plane.up +
                           (dimensions == 2 ? 0 : across * (column + 0.5) - 0.5 * width) * plane.across,
                       dimensions == 2 ? up : up * across});
  return cells;
}

/// Rings of equal breadth, each cut into equal parts about as long.
std::vector<SectionCell> cut_disc(const Opening& plane, double diameter, double spacing) {
  const int rings = cells_along(0.5 * diameter, spacing);
  const double breadth = 0.5 * diameter / rings;
  std::vector<SectionCell> cells;
  for (int ring = 0; ring < rings; ++ring) {
    const double radius = (ring + 0.5) * breadth;
    const int parts = std::max(4, cells_along(2 * pi * radius, spacing));
    for (int k = 0; k < parts; ++k) {
      const double angle = 2 * pi * (k + 0.5) / parts;
      cells.push_back(
          {plane.centre + radius * (std::cos(angle) * plane.across + std::sin(angle) * plane.up), 2 * pi * radius * breadth / parts});
    }
  }
  return cells;
}

std::vector<Vector3d> outline_of(const FlowSectionCase& given, const Opening& plane, int dimensions) {
  std::vector<Vector3d> outline;
  if (given.diameter) {
    for (int k = 0; k < rim_corners; ++k) {
      const double angle = 2 * pi * k / rim_corners;
      outline.push_back(plane.centre + 0.5 * *given.diameter * (std::cos(angle) * plane.across + std::sin(angle) * plane.up));
    }
    return outline;
  }
  const Vector3d up = 0.5 * (*given.size)[1] * plane.up, across = 0.5 * (*given.size)[0] * plane.across;
  if (dimensions == 2) return {plane.centre - up, plane.centre + up};
  for (const auto& [right, top] : {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)})
    outline.push_back(plane.centre + right * across + top * up);
  return outline;
}

/// Before any is made: what is far larger than the tank by mistake would take minutes and gigabytes.
void check_size(const FlowSectionCase& given, int dimensions, double spacing) {
  constexpr double most_cells = 1e7;
  const auto along = [&](double length) { return std::max(1.0, length / spacing); };
  const double cells = given.diameter      ? 0.25 * pi * along(*given.diameter) * along(*given.diameter)
                       : (dimensions == 2) ? along((*given.size)[1])
                                           : along((*given.size)[0]) * along((*given.size)[1]);
  if (cells <= most_cells) return;
  char count[32];
  std::snprintf(count, sizeof count, "%.2g", cells);
  throw Error("section '" + given.name + "' reaches over " + count + " cells of the spacing, and 1e7 at most are allowed; make it smaller");
}

FlowSection place_section(const FlowSectionCase& given, const Basin& basin, const OpenSpace& open, double spacing) {
  check_size(given, basin.dimensions, spacing);
  Opening plane;  // of which the axes are those that an opening's would be
  plane.centre = given.centre;
  plane.normal = given.normal.normalized();
  set_axes(given.up, basin.up, basin.dimensions, plane);
  FlowSection section;
  section.normal = plane.normal;
  section.outline = outline_of(given, plane, basin.dimensions);
  const std::vector<SectionCell> cells = given.diameter
                                             ? cut_disc(plane, *given.diameter, spacing)
                                             : cut_rectangle(plane, (*given.size)[0], (*given.size)[1], basin.dimensions, spacing);
  for (const SectionCell& cell : cells) {
    if (!open.reached(cell.place, cell.place)) continue;
    section.places.push_back(cell.place);
    section.areas.push_back(cell.area);
  }
  if (section.places.empty())
    throw Error("section '" + given.name + "' at " + describe(given.centre) +
                " m lies where no water can come; move it into the space that the water can reach");
  return section;
}

}  // namespace

std::vector<FlowSection> place_sections(const std::vector<FlowSectionCase>& sections, const Basin& basin, const OpenSpace& open,
                                        double spacing) {
  std::vector<FlowSection> placed;
  placed.reserve(sections.size());
  for (const FlowSectionCase& section : sections) placed.push_back(place_section(section, basin, open, spacing));
  return placed;
}

}  // namespace wavetank

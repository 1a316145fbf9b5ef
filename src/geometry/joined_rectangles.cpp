#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "wavetank/geometry/layout.h"

namespace wavetank {
namespace {

/// A rectangle in the coordinates of its own plane.
struct Rectangle {
  WallElement like;                     ///< for its owner and directions
  double height = 0;                    ///< of the plane along its normal, m
  std::array<double, 2> low{}, high{};  ///< along the tangent and across, m
};

Vector3d across_of(const WallElement& element) { return element.normal.cross(element.tangent); }

Rectangle rectangle_of(const WallElement& element, int dimensions) {
  Rectangle rectangle;
  rectangle.like = element;
  rectangle.height = element.normal.dot(element.centre);
  const bool flat = dimensions == 3;
  const double half[2] = {0.5 * (flat ? std::sqrt(element.area * element.elongation) : element.area),
                          flat ? 0.5 * std::sqrt(element.area / element.elongation) : 0.0};
  const double place[2] = {element.tangent.dot(element.centre), across_of(element).dot(element.centre)};
  for (int side = 0; side < 2; ++side) {
    rectangle.low[side] = place[side] - half[side];
    rectangle.high[side] = place[side] + half[side];
  }
  return rectangle;
}

WallElement element_of(const Rectangle& rectangle, int dimensions) {
  WallElement element = rectangle.like;
  const double length = rectangle.high[0] - rectangle.low[0], width = rectangle.high[1] - rectangle.low[1];
  element.centre = rectangle.height * element.normal + 0.5 * (rectangle.low[0] + rectangle.high[0]) * element.tangent +
                   0.5 * (rectangle.low[1] + rectangle.high[1]) * across_of(element);
  element.area = dimensions == 3 ? length * width : length;
  element.elongation = dimensions == 3 ? length / width : 1.0;
  return element;
}

/// Joins those that meet along one direction: 0 the tangent, 1 across. Lengths are compared in units of `hair`.
std::vector<Rectangle> joined_along(std::vector<Rectangle> rectangles, int along, double hair) {
  const int across = 1 - along;
  const auto units = [hair](double length) { return std::llround(length / hair); };
  const auto line_of = [&](const Rectangle& r) {  // what two that are joined have in common
    std::array<long long, 10> line{r.like.owner, units(r.height), units(r.low[across]), units(r.high[across])};
    for (int axis = 0; axis < 3; ++axis) {
      line[4 + axis] = units(r.like.normal[axis]);
      line[7 + axis] = units(r.like.tangent[axis]);
    }
    return line;
  };
  std::sort(rectangles.begin(), rectangles.end(), [&](const Rectangle& a, const Rectangle& b) {
    const auto first = line_of(a), second = line_of(b);
    return first != second ? first < second : a.low[along] < b.low[along];
  });
  std::vector<Rectangle> joined;
  for (const Rectangle& next : rectangles) {
    if (!joined.empty() && line_of(joined.back()) == line_of(next) && std::abs(joined.back().high[along] - next.low[along]) < hair)
      joined.back().high[along] = next.high[along];
    else
      joined.push_back(next);
  }
  return joined;
}

}  // namespace

std::vector<WallElement> joined_rectangles(const std::vector<WallElement>& elements, double spacing, int dimensions) {
  const double hair = 1e-4 * spacing;
  std::vector<Rectangle> rectangles;
  rectangles.reserve(elements.size());
  for (const WallElement& element : elements) rectangles.push_back(rectangle_of(element, dimensions));
  rectangles = joined_along(std::move(rectangles), 0, hair);
  if (dimensions == 3) rectangles = joined_along(std::move(rectangles), 1, hair);
  std::vector<WallElement> joined;
  joined.reserve(rectangles.size());
  for (const Rectangle& rectangle : rectangles) joined.push_back(element_of(rectangle, dimensions));
  return joined;
}

}  // namespace wavetank

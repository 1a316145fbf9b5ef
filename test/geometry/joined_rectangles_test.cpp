// Rectangles side by side become larger ones that cover the same place.
#include <gtest/gtest.h>

#include <cmath>

#include "wavetank/geometry/layout.h"

namespace wavetank::joined_rectangles_test {
namespace {

constexpr double spacing = 0.1;

/// A square that faces upwards, with its centre at multiples of the spacing.
WallElement square(int along, int across, double height = 1.0) {
  WallElement element;
  element.centre = Vector3d(along * spacing, across * spacing, height);
  element.normal = Vector3d::UnitZ();
  element.tangent = Vector3d::UnitX();
  element.area = spacing * spacing;
  return element;
}

double area_of(const std::vector<WallElement>& elements) {
  double area = 0;
  for (const WallElement& element : elements) area += element.area;
  return area;
}

TEST(JoinedRectangles, MakeOneOfAFullOne) {
  std::vector<WallElement> elements;
  for (int along = 0; along < 5; ++along)
    for (int across = 0; across < 3; ++across) elements.push_back(square(along, across));
  const std::vector<WallElement> joined = joined_rectangles(elements, spacing, 3);
  ASSERT_EQ(joined.size(), 1u);
  EXPECT_NEAR(joined[0].area, area_of(elements), 1e-12);
  EXPECT_NEAR(joined[0].elongation, 5.0 / 3, 1e-12);
  EXPECT_LT((joined[0].centre - Vector3d(2 * spacing, spacing, 1)).norm(), 1e-12);
  for (const Facet& facet : facets_of(joined[0], 3))
    for (const Vector3d& corner : facet.corners) EXPECT_NEAR(std::abs(corner.x() - 2 * spacing), 2.5 * spacing, 1e-12);
}

TEST(JoinedRectangles, LeaveHolesAndStepsAndGapsOpen) {
  std::vector<WallElement> elements;
  for (int along = 0; along < 3; ++along)
    for (int across = 0; across < 3; ++across)
      if (along != 1 || across != 1) elements.push_back(square(along, across));
  EXPECT_EQ(joined_rectangles(elements, spacing, 3).size(), 4u);
  EXPECT_NEAR(area_of(joined_rectangles(elements, spacing, 3)), area_of(elements), 1e-12);
  EXPECT_EQ(joined_rectangles({square(0, 0), square(1, 0, 1.01)}, spacing, 3).size(), 2u);
  EXPECT_EQ(joined_rectangles({square(0, 0), square(2, 0)}, spacing, 3).size(), 2u);
}

TEST(JoinedRectangles, KeepOwnersAndDirectionsApart) {
  WallElement other = square(1, 0), down = square(1, 0);
  other.owner = 1;
  down.normal = -down.normal;
  EXPECT_EQ(joined_rectangles({square(0, 0), other}, spacing, 3).size(), 2u);
  EXPECT_EQ(joined_rectangles({square(0, 0), down}, spacing, 3).size(), 2u);
  EXPECT_TRUE(joined_rectangles({}, spacing, 3).empty());
}

TEST(JoinedRectangles, JoinSegmentsIn2D) {
  std::vector<WallElement> elements;
  for (int along = 0; along < 4; ++along) {
    elements.push_back(square(along, 0));
    elements.back().area = spacing;
  }
  const std::vector<WallElement> joined = joined_rectangles(elements, spacing, 2);
  ASSERT_EQ(joined.size(), 1u);
  EXPECT_NEAR(joined[0].area, 4 * spacing, 1e-12);
  EXPECT_NEAR(joined[0].centre.x(), 1.5 * spacing, 1e-12);
}

}  // namespace
}  // namespace wavetank::joined_rectangles_test

// Polygons cut into triangles: as many as there are corners less two, turned as the polygon, over all of it and once.
#include "../../src/geometry/polygon.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

namespace wavetank::polygon_test {
namespace {

void covers_it_once(const std::vector<Vector3d>& polygon) {
  const Vector3d whole = vector_area(polygon);
  double area = 0;
  for (const Eigen::Vector3i& t : triangulate(polygon)) {
    const Vector3d part = 0.5 * (polygon[t[1]] - polygon[t[0]]).cross(polygon[t[2]] - polygon[t[0]]);
    EXPECT_GT(part.dot(whole), 0);
    area += part.norm();
  }
  EXPECT_NEAR(area, whole.norm(), 1e-12 * whole.norm());
  EXPECT_EQ(triangulate(polygon).size(), polygon.size() - 2);
}

// From one end of an L to the other the straight way touches its inner corner.
TEST(Triangulate, AnLFromWhicheverCorner) {
  const std::vector<Vector3d> corners = {{0, 0, 0}, {0.8, 0, 0}, {0.8, 0.4, 0}, {0.4, 0.4, 0}, {0.4, 0.8, 0}, {0, 0.8, 0}};
  for (std::size_t first = 0; first < corners.size(); ++first)
    for (const bool turned : {false, true}) {
      std::vector<Vector3d> polygon;
      for (std::size_t k = 0; k < corners.size(); ++k)
        polygon.push_back(corners[(first + (turned ? corners.size() - k : k)) % corners.size()]);
      SCOPED_TRACE(first);
      covers_it_once(polygon);
    }
}

TEST(Triangulate, AnLInSinglePrecisionTurnedInSpace) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  std::vector<Vector3d> polygon;
  for (const Vector3d& corner :
       {Vector3d(0, 0.8, 0), Vector3d(0, 0, 0), Vector3d(0.8, 0, 0), Vector3d(0.8, 0.4, 0), Vector3d(0.4, 0.4, 0), Vector3d(0.4, 0.8, 0)})
    polygon.push_back((turn * corner).cast<float>().cast<double>());
  const Vector3d whole = vector_area(polygon);
  double area = 0;
  for (const Eigen::Vector3i& t : triangulate(polygon))
    area += 0.5 * (polygon[t[1]] - polygon[t[0]]).cross(polygon[t[2]] - polygon[t[0]]).norm();
  EXPECT_NEAR(area, whole.norm(), 1e-6 * whole.norm());
}

TEST(Triangulate, EndsWhereItsBudgetDoes) {
  std::vector<Vector3d> circle;
  for (int k = 0; k < 50; ++k) circle.emplace_back(std::cos(k * M_PI / 25), std::sin(k * M_PI / 25), 0);
  std::uint64_t enough = 50 * 50, little = 50;
  EXPECT_EQ(triangulate(circle, &enough).size(), 48u);
  EXPECT_GT(enough, 0u);
  EXPECT_LT(enough, 50u * 50u);
  EXPECT_TRUE(triangulate(circle, &little).empty());
  EXPECT_EQ(little, 0u);
}

TEST(Triangulate, StarsOfAnyShape) {
  const unsigned seed = 11;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> radius(0.2, 1.0);
  std::printf("seed %u\n", seed);
  for (int star = 0; star < 50; ++star) {
    std::vector<Vector3d> polygon;
    for (int k = 0; k < 17; ++k) {
      const double r = radius(random), angle = 2 * M_PI * k / 17;
      polygon.emplace_back(r * std::cos(angle), r * std::sin(angle), 0.3);
    }
    covers_it_once(polygon);
  }
}

}  // namespace
}  // namespace wavetank::polygon_test

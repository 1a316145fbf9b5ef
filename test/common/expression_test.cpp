#include "wavetank/common/expression.h"

#include <gtest/gtest.h>

#include <cmath>

#include "error_of.h"

namespace wavetank::expression_test {
namespace {

TEST(Expression, IsAFunctionOfAPlace) {
  EXPECT_DOUBLE_EQ(Expression("sin(2*pi*x)*cos(pi*z) + y^2").at({0.1, 3, 0.25}), std::sin(0.2 * M_PI) * std::cos(0.25 * M_PI) + 9);
  EXPECT_DOUBLE_EQ(Expression("z < 0.5 ? 1 : -2").at({0, 0, 0.6}), -2);
  EXPECT_DOUBLE_EQ(Expression("1e-3").at({0, 0, 0}), 1e-3);
}

TEST(Expression, OrOfTime) {
  EXPECT_DOUBLE_EQ(Expression("min(t, 1)*0.5", Expression::Of::time).at(0.5), 0.25);
  const Expression wave("t*x + z", Expression::Of::time_and_place);
  EXPECT_DOUBLE_EQ(wave.at(2, Eigen::Vector3d(3, 0, 0.5)), 6.5);
  EXPECT_TRUE(wave.depends_on_place());
  EXPECT_FALSE(Expression("2*t", Expression::Of::time_and_place).depends_on_place());
  EXPECT_NE(error_of([] { Expression("x + t", Expression::Of::time); }).find("\"x + t\" is no expression of t: "), std::string::npos);
}

TEST(Expression, SaysWhatIsWrongAndWhere) {
  EXPECT_NE(error_of([] { Expression("sin(x"); }).find("\"sin(x\" is no expression of x, y and z: "), std::string::npos);
  const std::string unknown = error_of([] { Expression("2*t + x"); });
  EXPECT_NE(unknown.find("\"t\""), std::string::npos) << unknown;
  EXPECT_NE(unknown.find("at its character 3"), std::string::npos) << unknown;
  EXPECT_NE(error_of([] { Expression(""); }), "");
  EXPECT_NE(error_of([] { Expression("1 2"); }), "");
}

TEST(Expression, IsNotFiniteWhereItsValueIsNot) { EXPECT_FALSE(std::isfinite(Expression("1/x").at({0, 0, 0}))); }

}  // namespace
}  // namespace wavetank::expression_test

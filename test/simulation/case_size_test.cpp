// What --check tells of a case's size, and the warning of shallow water.
#include "wavetank/simulation/case_size.h"

#include "simulation_fixture.h"
#include "wavetank/common/log.h"
#include "wavetank/sph/discretisation.h"

namespace wavetank::case_size_test {
namespace {

CaseSize size_of_case(const Case& scene) {
  const Layout layout = lay_out(scene);
  const Case settled_case = settled(scene, layout);
  return size_of(settled_case, layout, RigidWorld(settled_case, layout));
}

BodyCase box_body(const std::string& name, const Vector3d& from, const Vector3d& to, double density) {
  BodyCase body;
  body.name = name;
  body.shape = Box{from, to};
  body.motion = Motion::free;
  body.rigid.density = density;
  return body;
}

TEST(CaseSize, IsThatOfTheTankWithoutPocketsBehindOpenings) {
  Case scene = box_case(Vector3d(1, 0, 0.6), 0.3, 0.025);
  OpeningCase inlet;
  inlet.name = "inlet";
  inlet.centre = Vector3d(0, 0, 0.15);
  inlet.normal = Vector3d::UnitX();
  inlet.size = std::array<double, 2>{1, 0.2};
  inlet.velocity = "0.5";
  scene.openings = {inlet};
  const CaseSize size = size_of_case(scene);
  EXPECT_NEAR(size.water_volume, 0.3, 1e-9);
  EXPECT_NEAR(size.least_depth, 0.3, 1e-9);
}

TEST(CaseSize, OfTankWaterAndBodies) {
  Case scene = box_case(Vector3d(1, 0.5, 0.6), 0.3, 0.05);
  scene.bodies = {box_body("block", {0.2, 0.1, 0.2}, {0.4, 0.3, 0.3}, 400), box_body("stone", {0.6, 0.1, 0.1}, {0.8, 0.3, 0.25}, 2500),
                  box_body("tied", {0.6, 0.3, 0.4}, {0.8, 0.5, 0.5}, 500)};
  MooringCase rope;
  rope.anchor = Vector3d(0.7, 0.4, 0);
  rope.attachment = Vector3d(0.7, 0.4, 0.4);
  rope.stiffness = 10;
  scene.bodies[2].rigid.moorings = {rope};
  const CaseSize size = size_of_case(scene);
  ASSERT_EQ(size.owners.size(), 4u);
  EXPECT_NEAR(size.owners[0].volume, 0.3, 1e-9);
  EXPECT_TRUE(size.owners[0].size.isApprox(Vector3d(1, 0.5, 0.6)));
  EXPECT_NEAR(size.owners[1].volume, 0.004, 1e-9);
  EXPECT_NEAR(size.owners[1].mass, 1.6, 1e-9);
  EXPECT_TRUE(size.owners[1].floats_alone);
  EXPECT_NEAR(size.owners[1].draught.value(), 0.04, 1e-9);
  EXPECT_TRUE(size.owners[2].floats_alone);
  EXPECT_FALSE(size.owners[2].draught) << "it sinks";
  EXPECT_FALSE(size.owners[3].floats_alone) << "a rope holds it";
  EXPECT_NEAR(size.water_volume, 1 * 0.5 * 0.3 - 0.004 - 0.006, 0.003);
  EXPECT_NEAR(size.water_mass, 1000 * size.water_volume, 1e-6);
  EXPECT_NEAR(size.least_depth, 0.3, 1e-6);
  EXPECT_NEAR(size.least_extent.value(), 0.1, 1e-9);
}

TEST(CaseSize, InTwoDimensionsIsPerMetre) {
  Case scene = box_case(Vector3d(1, 0, 0.6), 0.3, 0.02);
  scene.bodies = {box_body("raft", {0.2, -0.1, 0.26}, {0.6, 0.2, 0.34}, 250)};
  const CaseSize size = size_of_case(scene);
  EXPECT_NEAR(size.owners[0].volume, 0.6, 1e-9);
  EXPECT_NEAR(size.owners[1].volume, 0.032, 1e-9);
  EXPECT_NEAR(size.owners[1].draught.value(), 0.02, 1e-9);
  EXPECT_NEAR(size.least_extent.value(), 0.08, 1e-9) << "width does not count";
}

/// The warnings of a case that is laid out.
std::string warnings_of(const Case& scene) {
  std::string warnings;
  set_log_sink([&](LogLevel level, const std::string& line) {
    if (level == LogLevel::warning) warnings += line + "\n";
  });
  tell_of_shallow_water(lay_out(scene));
  set_log_sink({});
  return warnings;
}

void expect_shallow(const Case& scene, bool is_shallow) {
  const std::string warnings = warnings_of(scene);
  EXPECT_EQ(warnings.find("spacings deep") != std::string::npos, is_shallow) << warnings;
  if (is_shallow) {
    EXPECT_NE(warnings.find("fluid/spacing"), std::string::npos) << warnings;
  }
}

TEST(ShallowWater, IsToldBelowFourSpacings) {
  expect_shallow(box_case(Vector3d(1, 0, 0.6), 0.08, 0.02), false);
  expect_shallow(box_case(Vector3d(1, 0, 0.6), 0.06, 0.02), true);
  expect_shallow(box_case(Vector3d(1, 0, 0.6), 0.01, 0.02), true);
  expect_shallow(box_case(Vector3d(0.4, 0.4, 0.4), 0.2, 0.04), false);
  expect_shallow(box_case(Vector3d(0.4, 0.4, 0.4), 0.1, 0.04), true);
}

TEST(ShallowWater, IsSoAlongGravityWhereverItPoints) {
  for (const double way : {-1.0, 1.0})
    for (const double depth : {0.06, 0.1}) {
      Case scene = box_case(Vector3d(0.6, 0, 1), 1, 0.02);
      scene.gravity = Vector3d(way * 9.81, 0, 0);
      const double floor = way < 0 ? 0 : 0.6, surface = floor - way * depth;
      scene.fluid.fill = {Box{Vector3d(std::min(floor, surface), 0, 0), Vector3d(std::max(floor, surface), 0, 1)}};
      expect_shallow(scene, depth < 0.08);
      EXPECT_NEAR(size_of_case(scene).least_depth, depth, 1e-6);
    }
}

TEST(ShallowWater, IsToldOfOneOfTwoWatersAndOfALayerBeforeADam) {
  Case scene = box_case(Vector3d(1, 0, 0.6), 0.3, 0.02);
  scene.fluid.fill = {Box{Vector3d(0, 0, 0), Vector3d(0.3, 0, 0.3)}, Box{Vector3d(0.9, 0, 0), Vector3d(1, 0, 0.04)}};
  expect_shallow(scene, true);
  scene.fluid.fill[1] = Box{Vector3d(0.3, 0, 0), Vector3d(1, 0, 0.04)};
  expect_shallow(scene, true);
  scene.fluid.fill[1] = Box{Vector3d(0, 0, 0.3), Vector3d(0.3, 0, 0.32)};  // upon the first: one water
  expect_shallow(scene, false);
}

TEST(ShallowWater, IsNotThatOverAndUnderBodies) {
  Case scene = box_case(Vector3d(1, 0, 0.6), 0.3, 0.02);
  scene.bodies = {box_body("low", {0.2, 0, 0.04}, {0.6, 0, 0.2}, 500), box_body("high", {0.7, 0, 0.2}, {0.8, 0, 0.26}, 500)};
  expect_shallow(scene, false);
  scene.bodies = {box_body("raft", {0.1, 0, 0.15}, {0.6, 0, 0.35}, 500), box_body("stone", {0.65, 0, 0.05}, {0.95, 0, 0.25}, 2500)};
  expect_shallow(scene, false);
}

}  // namespace
}  // namespace wavetank::case_size_test

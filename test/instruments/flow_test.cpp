// Velocity probes and sections in flows that are known.
#include <algorithm>

#include "../common/error_of.h"
#include "../sph/sph_fixture.h"
#include "wavetank/instruments/recorder.h"

namespace wavetank::flow_test {
namespace {

/// Of a fluid that has been given its state, at that instant.
Samples samples_of(const Case& scene) {
  Tank tank(scene);
  tank.solver->start();
  const RigidWorld world(tank.scene, tank.layout);
  Recorder recorder(tank.scene, tank.layout, *tank.solver, world);
  recorder.start(*tank.solver);
  return recorder.take();
}

/// A tank that flows along x, weightless, as deep as it is said.
Case flowing(const Vector3d& size, double depth, double spacing) {
  Case scene = box_case(size, depth, spacing);
  scene.gravity = Vector3d::Zero();
  scene.fluid.sound_speed = 20;
  scene.fluid.initial.u = "2*z";
  scene.fluid.initial.w = "0.5";
  scene.instruments.velocity_probes = {{"low", Vector3d(0.5 * size.x(), 0.5 * size.y(), 0.3 * depth)},
                                       {"high", Vector3d(0.4 * size.x(), 0.4 * size.y(), 0.7 * depth)},
                                       {"air", Vector3d(0.5 * size.x(), 0.5 * size.y(), depth + 2 * spacing)}};
  return scene;
}

void expect_velocities(const Case& scene, double depth) {
  const Samples samples = samples_of(scene);
  ASSERT_EQ(samples.velocities.size(), 1U);
  const std::vector<Vector3d>& velocities = samples.velocities[0].velocities;
  ASSERT_EQ(velocities.size(), 3U);
  // The kernel's mean of what is linear is its middle's, on a lattice to a small part of what it varies by over the spacing.
  EXPECT_NEAR(velocities[0].x(), 2 * 0.3 * depth, 0.002);
  EXPECT_NEAR(velocities[1].x(), 2 * 0.7 * depth, 0.002);
  EXPECT_NEAR(velocities[0].y(), 0, 1e-6);
  EXPECT_NEAR(velocities[1].z(), 0.5, 1e-5);
  EXPECT_TRUE(velocities[2].hasNaN()) << "in the air";
}

TEST(VelocityProbe, ReadsTheWatersVelocityIn2D) { expect_velocities(flowing(Vector3d(1, 0, 0.8), 0.5, 0.02), 0.5); }

TEST(VelocityProbe, ReadsTheWatersVelocityIn3D) { expect_velocities(flowing(Vector3d(0.6, 0.4, 0.6), 0.4, 0.03), 0.4); }

TEST(VelocityProbe, RidesWithItsBody) {
  Case scene = flowing(Vector3d(1, 0, 0.8), 0.5, 0.02);
  scene.bodies = {{"plate", Box{Vector3d(0.2, 0, 0.6), Vector3d(0.4, 0, 0.7)}, Motion::prescribed}};
  RampCase down{Direction::heave, -0.2, 0, 1};
  scene.bodies[0].rigid.prescribed.ramps = {down};
  scene.instruments.velocity_probes = {{"under", Vector3d(0.3, 0, 0.5), "plate"}};
  Tank tank(scene);
  tank.solver->start();
  RigidWorld world(tank.scene, tank.layout);
  Recorder recorder(tank.scene, tank.layout, *tank.solver, world);
  world.advance(0, 1, std::vector<RigidLoad>(2));
  recorder.start(*tank.solver);
  EXPECT_NEAR(recorder.take().velocities.at(0).velocities[0].x(), 2 * 0.3, 0.005);
}

TEST(VelocityProbe, InABodyIsRefused) {
  Case scene = flowing(Vector3d(1, 0, 0.8), 0.5, 0.02);
  scene.bodies = {{"plate", Box{Vector3d(0.2, 0, 0.2), Vector3d(0.4, 0, 0.4)}, Motion::fixed}};
  scene.instruments.velocity_probes = {{"V", Vector3d(0.3, 0, 0.3)}};
  EXPECT_EQ(error_of([&] { lay_out(scene); }),
            "velocity probe 'V' at (0.3, 0, 0.3) m lies inside body 'plate'; put it on the body's surface or into the fluid");
}

FlowSectionCase across(const Vector3d& centre, double width, double height) {
  FlowSectionCase section;
  section.name = "section";
  section.centre = centre;
  section.normal = Vector3d(2, 0, 0);
  section.size = {width, height};
  return section;
}

/// Larger than the channel, up into the air: what walls and air take does not count.
void expect_discharge(Case scene, double width, double depth) {
  const Vector3d size = std::get<BoxTank>(scene.tank.shape).size;
  scene.instruments.sections = {across(Vector3d(0.5 * size.x(), 0.5 * size.y(), 0.5 * size.z()), 2 * size.y(), 2 * size.z()),
                                across(Vector3d(0.5 * size.x(), 0.5 * size.y(), 0.25 * depth), size.y(), 0.5 * depth)};
  scene.instruments.sections[1].normal = Vector3d(-1, 0, 0);
  const std::vector<FlowThroughSection> flows = samples_of(scene).sections.at(0).flows;
  // ∫ 2 z dz over the depth, and over the lower half of it, the other way
  std::printf("%d-D: discharge %.4f of the exact, wet area %.4f; of the lower half %.4f and %.4f\n", scene.dimensions,
              flows[0].discharge / (width * depth * depth), flows[0].area / (width * depth),
              -flows[1].discharge / (0.25 * width * depth * depth), flows[1].area / (0.5 * width * depth));
  EXPECT_NEAR(flows[0].discharge, width * depth * depth, 0.01 * width * depth * depth);
  EXPECT_NEAR(flows[0].area, width * depth, 0.01 * width * depth);
  // beside the floor the mean is of the water over it alone, which is faster
  EXPECT_NEAR(flows[1].discharge, -0.25 * width * depth * depth, 0.02 * 0.25 * width * depth * depth);
  EXPECT_NEAR(flows[1].area, 0.5 * width * depth, 0.01 * 0.5 * width * depth);
}

TEST(Section, ReadsTheDischargeIn2D) { expect_discharge(flowing(Vector3d(1, 0, 0.8), 0.5, 0.02), 1, 0.5); }

TEST(Section, ReadsTheDischargeIn3D) { expect_discharge(flowing(Vector3d(0.6, 0.4, 0.6), 0.4, 0.025), 0.4, 0.4); }

TEST(Section, BetweenGhostsDoesNotCountThem) {
  Case scene = flowing(Vector3d(1, 0, 0.8), 0.5, 0.02);
  scene.fluid.initial.u = "1";
  scene.fluid.initial.w = "0";
  scene.numerics.walls.method = WallMethod::ghost;
  scene.numerics.walls.slip = Slip::no_slip;  // whose velocities are turned round whole: counted, they would take several percent
  scene.instruments.sections = {across(Vector3d(0.5, 0, 0.25), 0, 0.5)};
  const FlowThroughSection flow = samples_of(scene).sections.at(0).flows.at(0);
  EXPECT_NEAR(flow.area, 0.5, 0.02 * 0.5);  // half of a cell at the surface
  EXPECT_NEAR(flow.discharge, flow.area, 1e-4);
}

TEST(Section, OfADiscReadsTheDischarge) {
  Case scene = flowing(Vector3d(0.6, 0.4, 0.6), 0.4, 0.025);
  FlowSectionCase disc;
  disc.name = "disc";
  disc.centre = Vector3d(0.3, 0.2, 0.2);
  disc.normal = Vector3d(1, 0, 0);
  disc.diameter = 0.3;
  scene.instruments.sections = {disc};
  const FlowThroughSection flow = samples_of(scene).sections.at(0).flows.at(0);
  const double area = M_PI * 0.15 * 0.15;
  EXPECT_NEAR(flow.area, area, 1e-3 * area);
  EXPECT_NEAR(flow.discharge, 2 * 0.2 * area, 5e-3 * 2 * 0.2 * area);
}

TEST(Section, LeavesOutWhatLiesInBodies) {
  Case scene = flowing(Vector3d(1, 0, 0.8), 0.5, 0.02);
  scene.instruments.velocity_probes.clear();
  scene.instruments.sections = {across(Vector3d(0.5, 0, 0.4), 0, 0.8)};
  for (const Motion motion : {Motion::fixed, Motion::commanded}) {
    scene.bodies = {{"block", Box{Vector3d(0.3, 0, 0), Vector3d(0.7, 0, 0.2)}, motion}};
    const FlowThroughSection flow = samples_of(scene).sections.at(0).flows.at(0);
    EXPECT_NEAR(flow.area, 0.3, 0.01 * 0.3);
    EXPECT_NEAR(flow.discharge, 0.25 - 0.04, 0.01 * 0.21);
  }
}

TEST(Section, WhereNoWaterCanComeIsRefused) {
  Case scene = flowing(Vector3d(1, 0, 0.8), 0.5, 0.02);
  scene.instruments.sections = {across(Vector3d(2, 0, 0.25), 0, 0.5)};
  EXPECT_EQ(error_of([&] { lay_out(scene); }),
            "section 'section' at (2, 0, 0.25) m lies where no water can come; move it into the space that the water can reach");
}

}  // namespace
}  // namespace wavetank::flow_test

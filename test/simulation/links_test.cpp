// Links of robots that overlap at joints which let them move.
#include <algorithm>

#include "simulation_fixture.h"

namespace wavetank::links_test {
namespace {

constexpr double density = 1000, gravity = 9.81;

using Links = SimulationTest;

/// A hull of 0.4 m × 0.2 m × 0.1 m as heavy as the water that it displaces, and a sensor on a hinge 25 mm inside its skin.
Case hull_with_sensor() {
  Case scene = box_case(Vector3d(0.68, 0.4, 0.5), 0.4, 0.04);
  scene.fluid.density = density;
  scene.numerics.packing.settling = 3;
  scene.instruments.rate = 50;
  BodyCase hull{"hull", Box{Vector3d(0.14, 0.1, 0.15), Vector3d(0.54, 0.3, 0.25)}, Motion::free};
  hull.rigid.density = 980;
  BodyCase sensor{"sensor", Box{Vector3d(0.435, 0.15, 0.175), Vector3d(0.515, 0.25, 0.225)}, Motion::free};
  sensor.rigid.density = 400;
  scene.bodies = {hull, sensor};
  JointCase hinge;
  hinge.name = "hinge";
  hinge.type = JointType::hinge;
  hinge.parent = "hull";
  hinge.child = "sensor";
  hinge.point = Vector3d(0.475, 0.2, 0.2);
  hinge.axis = Vector3d::UnitY();
  scene.joints = {hinge};
  return scene;
}

TEST_F(Links, InsideAHullFeelNothingAlsoOnAHinge) {
  Simulation simulation(hull_with_sensor());
  const Samples samples = run_to(simulation, 0.1);
  const double archimedes = density * gravity * 0.4 * 0.2 * 0.1;
  double mean = 0;
  for (const WrenchSample& sample : samples.wrenches) {
    EXPECT_EQ(sample.wrenches[2].pressure_force, Vector3d::Zero()) << "at " << sample.time << " s";
    mean += sample.wrenches[1].pressure_force.z() / samples.wrenches.size();
  }
  std::printf("hull: %+.1f %% of Archimedes' force\n", 100 * (mean / archimedes - 1));
  EXPECT_NEAR(mean, archimedes, 0.05 * archimedes);
}

}  // namespace
}  // namespace wavetank::links_test

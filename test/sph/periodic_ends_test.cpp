// A particle that leaves a long periodic tank at one end comes in at the other exactly a period away.
#include "sph_fixture.h"

namespace wavetank::periodic_ends_test {
namespace {

void crosses_the_end(double start, double speed) {
  constexpr double length = 250, spacing = 0.05;  // 5000 spacings, whose coordinates have steps of 1.5e-5 m in single precision
  Case scene = box_case(Vector3d(length, 0, 0.5), 0.25, spacing);
  scene.gravity = Vector3d::Zero();
  scene.fluid.sound_speed = 10;
  scene.tank.periodic = {true, false, false};
  const Layout layout = loose_particles({Vector3d::Zero(), Vector3d(length, 0, 0.5)}, spacing, {Vector3d(start, 0, 0.25)}, 2);
  scene = settled(scene, layout);
  const auto solver = make_solver(test_device(), scene, layout, discretise(scene, layout), {Vector3d::Zero()});
  double step = solver->start().time_step, time = 0;
  StateBytes<float> state(*solver);
  state.set("u", 0, speed);
  solver->restore(state.bytes());
  for (int k = 0; k < 20; ++k) {
    time += step;
    const StepReport report = solver->advance();
    ASSERT_TRUE(report.valid());
    step = report.time_step;
  }
  const double expected = start + speed * time - (speed > 0 ? length : -length);
  ASSERT_GT(expected, 0.01);
  ASSERT_LT(expected, length - 0.01);
  EXPECT_NEAR(solver->download().position[0].x(), expected, 1e-6);
}

TEST(PeriodicEnds, AreCrossedExactlyInALongTank) {
  crosses_the_end(250 - 0.001234567, 1.0);
  crosses_the_end(0.001234567, -1.0);
}

}  // namespace
}  // namespace wavetank::periodic_ends_test

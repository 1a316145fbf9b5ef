// What the device counts in every step: values that are not finite, particles outside, and too fast ones.
#include <limits>

#include "sph_fixture.h"

namespace wavetank::watchdog_test {
namespace {

/// Particles so far apart that none is in another's neighbour cells, nor near the tank's sides, where positions that are
/// not finite are sorted, in a tank without gravity.
Tank sparse_tank(int dimensions) {
  const double side = 5, spacing = 0.05;
  Case scene;
  scene.dimensions = dimensions;
  scene.gravity = Vector3d::Zero();
  scene.fluid.sound_speed = 10;
  std::vector<Vector3d> particles;
  for (double x = 1.0; x < side - 0.7; x += 0.65)
    for (double z = 1.0; z < side - 0.7; z += 0.65) particles.emplace_back(x, dimensions == 3 ? 0.5 : 0.0, z);
  Tank tank(scene, loose_particles({Vector3d::Zero(), Vector3d(side, dimensions == 3 ? 1.0 : 0.0, side)}, spacing, particles, dimensions));
  tank.solver->start();
  return tank;
}

/// The report of one step after `value` was put into one field of the particle `id`.
StepReport step_with(Tank& tank, std::uint32_t id, const std::string& field, double value) {
  StateBytes<float> state(*tank.solver);
  state.set(field, id, value);
  tank.solver->restore(state.bytes());
  return tank.solver->advance();
}

class Watchdog : public ::testing::TestWithParam<int> {};

TEST_P(Watchdog, IsQuietWithoutCause) {
  Tank tank = sparse_tank(GetParam());
  const StepReport report = step_with(tank, 3, "u", 4.9);
  EXPECT_EQ(report.not_finite + report.outside + report.too_fast, 0);
  EXPECT_EQ(report.offender, -1);
  EXPECT_NEAR(report.greatest_speed, 4.9, 1e-3);
}

TEST_P(Watchdog, FindsValuesThatAreNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  Tank tank = sparse_tank(GetParam());
  const std::vector<char> sound = tank.solver->save();
  for (const char* const field : {"x", "z", "u", "w", "compression"})
    for (const double value : {nan, infinity, -infinity}) {
      SCOPED_TRACE("field " + std::string(field) + ", value " + std::to_string(value));
      tank.solver->restore(sound);
      const StepReport report = step_with(tank, 17, field, value);
      EXPECT_EQ(report.not_finite, 1);
      ASSERT_GE(report.offender, 0);
      EXPECT_EQ(report.offender_id, 17u);
      EXPECT_TRUE(std::isfinite(report.greatest_speed)) << "Δt must not follow a lost particle";
    }
}

TEST_P(Watchdog, FindsTheParticleOutside) {
  Tank tank = sparse_tank(GetParam());
  const float origin = static_cast<float>(tank.discretisation.origin.x());
  const StepReport report = step_with(tank, 11, "x", 5.1f - origin);
  EXPECT_EQ(report.outside, 1);
  EXPECT_EQ(report.not_finite, 0);
  EXPECT_EQ(report.offender_id, 11u);
  EXPECT_NEAR(report.offender_position.x(), 5.1, 1e-4);
  EXPECT_NEAR(report.offender_position.z(), tank.layout.particles[11].z(), 1e-4);
}

TEST_P(Watchdog, FindsTheParticleThatIsTooFast) {
  Tank tank = sparse_tank(GetParam());
  const StepReport report = step_with(tank, 20, "w", -5.1);
  EXPECT_EQ(report.too_fast, 1);
  EXPECT_EQ(report.offender_id, 20u);
  EXPECT_NEAR(report.offender_velocity.z(), -5.1, 1e-3);
  EXPECT_NEAR(report.greatest_speed, 5.1, 1e-3);
}

TEST_P(Watchdog, CountsAll) {
  Tank tank = sparse_tank(GetParam());
  StateBytes<float> state(*tank.solver);
  for (const std::uint32_t id : {5u, 8u, 9u}) state.set("u", id, 6.0);
  state.set("z", 2, 50.0);
  state.set("compression", 30, std::numeric_limits<double>::quiet_NaN());
  tank.solver->restore(state.bytes());
  const StepReport report = tank.solver->advance();
  EXPECT_EQ(report.too_fast, 3);
  EXPECT_EQ(report.outside, 1);
  EXPECT_EQ(report.not_finite, 1);
}

INSTANTIATE_TEST_SUITE_P(Dimensions, Watchdog, ::testing::Values(2, 3),
                         [](const auto& info) { return "In" + std::to_string(info.param) + "D"; });

TEST(State, OfAnotherSizeIsRefused) {
  Tank tank = sparse_tank(2);
  std::vector<char> bytes = tank.solver->save();
  bytes.pop_back();
  EXPECT_THROW(tank.solver->restore(bytes), Error);
}

}  // namespace
}  // namespace wavetank::watchdog_test

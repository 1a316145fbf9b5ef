// Inertial measurement units on motions that are known.
#include "../sph/sph_fixture.h"
#include "wavetank/instruments/recorder.h"

namespace wavetank::imu_test {
namespace {

/// A hull that the water does not matter to.
Case hull_case(Motion motion) {
  Case scene = box_case(Vector3d(2, 1, 2), 0.2, 0.2);
  BodyCase hull{"hull", Box{Vector3d(0.5, 0.4, 1), Vector3d(0.9, 0.6, 1.2)}, motion};
  hull.imu = ImuCase{Vector3d(0.9, 0.5, 1.2)};
  hull.rigid.collision = CollisionShape::none;
  if (motion == Motion::free) hull.rigid.mass = 10;
  scene.bodies = {hull};
  scene.instruments.rate = 10;  // of what is not looked at
  scene.instruments.imu_rate = 200;
  return scene;
}

/// Its readings over a second.
std::vector<ImuSample> readings(const Case& scene) {
  Tank tank(scene);
  tank.solver->start();
  RigidWorld world(tank.scene, tank.layout);
  Recorder recorder(tank.scene, tank.layout, *tank.solver, world);
  recorder.start(*tank.solver);
  constexpr int steps = 2000;
  for (int k = 0; k < steps; ++k) {
    const double time = static_cast<double>(k) / steps, next = static_cast<double>(k + 1) / steps;
    recorder.before_step(*tank.solver, time, next);
    world.advance(time, next - time, std::vector<RigidLoad>(2));
    recorder.after_step(*tank.solver, time, next);
  }
  return recorder.take().imus;
}

TEST(Imu, AtRestReadsGravityUpwards) {
  const std::vector<ImuSample> samples = readings(hull_case(Motion::fixed));
  ASSERT_EQ(samples.size(), 201U);
  for (const ImuSample& sample : samples) {
    EXPECT_LT((sample.readings.at(0).specific_force - Vector3d(0, 0, 9.81)).norm(), 1e-12);
    EXPECT_EQ(sample.readings[0].angular_velocity, Vector3d::Zero());
  }
}

TEST(Imu, InFreeFallReadsNothing) {
  const std::vector<ImuSample> samples = readings(hull_case(Motion::free));
  EXPECT_LT((samples.front().readings.at(0).specific_force - Vector3d(0, 0, 9.81)).norm(), 1e-12) << "held, until it is let go";
  for (std::size_t k = 1; k < samples.size(); ++k) EXPECT_LT(samples[k].readings.at(0).specific_force.norm(), 1e-9) << samples[k].time;
}

TEST(Imu, OnAPitchingHullReadsItsPlacesAccelerationInItsAxes) {
  Case scene = hull_case(Motion::prescribed);
  const double swing = 0.3, omega = 2 * M_PI * 0.8;
  scene.bodies[0].rigid.prescribed.harmonics = {{Direction::pitch, swing, 0.8, 0, 0}};
  scene.bodies[0].rigid.prescribed.point = Vector3d(0.9, 0.5, 0.2);  // a metre under the unit
  double pitch = 0, before = 0;                                      // rad, by the gyro alone
  const std::vector<ImuSample> samples = readings(scene);
  // at first of the instant: what a metre of arm has of the turning itself
  EXPECT_LT((samples.front().readings.at(0).specific_force - Vector3d(0, 0, 9.81 - std::pow(swing * omega, 2))).norm(), 1e-2);
  for (const ImuSample& sample : samples) {
    const ImuReading& reading = sample.readings.at(0);
    const double angle = swing * std::sin(omega * sample.time), rate = swing * omega * std::cos(omega * sample.time);
    EXPECT_NEAR(reading.orientation.angularDistance(Quaterniond(Eigen::AngleAxisd(angle, Vector3d::UnitY()))), 0, 1e-6);
    EXPECT_NEAR(reading.angular_velocity.y(), rate, 1e-4);
    if (sample.time > 0) pitch += 0.5 * (before + reading.angular_velocity.y()) / 200;
    before = reading.angular_velocity.y();
    EXPECT_NEAR(pitch, angle, 1e-4);
    if (sample.time == 0) continue;
    // Of the middle of the period that it is the mean of, in the axes at its end: less by a turn of rate · 2.5 ms, so 1 m · swing ω² / 400.
    const double middle = sample.time - 0.0025, turned = swing * std::sin(omega * middle), spin = swing * omega * std::cos(omega * middle);
    const double spin_up = -omega * omega * turned;
    const Vector3d up(std::sin(turned), 0, std::cos(turned)), along(std::cos(turned), 0, -std::sin(turned));
    const Vector3d acceleration = spin_up * along - spin * spin * up;
    const Vector3d expected = Eigen::AngleAxisd(-angle, Vector3d::UnitY()) * Vector3d(acceleration + Vector3d(0, 0, 9.81));
    EXPECT_LT((reading.specific_force - expected).norm(), 2e-3) << sample.time;
  }
}

}  // namespace
}  // namespace wavetank::imu_test

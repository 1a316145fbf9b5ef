// Commanded motions: limits, timeout, the paths that they lead along, and that a saved one goes on bit for bit.
#include "wavetank/rigid/commanded_motion.h"

#include <Eigen/Geometry>
#include <random>

#include "../common/error_of.h"

namespace wavetank::commanded_motion_test {
namespace {

const Vector3d start(1, -2, 0.5);
const Vector3d none = Vector3d::Zero();

CommandCase unlimited() {
  CommandCase limits;
  limits.greatest_acceleration = limits.greatest_angular_acceleration = {};
  limits.timeout = 0;
  return limits;
}

CommandCase accelerating(double greatest, double greatest_angular) {
  CommandCase limits = unlimited();
  limits.greatest_acceleration = greatest;
  limits.greatest_angular_acceleration = greatest_angular;
  return limits;
}

/// A motion that is stepped on from 0 s.
struct Drive {
  CommandedMotion motion;
  double time_step;
  int steps = 0;

  Drive(const CommandCase& limits, double time_step, int dimensions = 3) : motion(limits, start, dimensions), time_step(time_step) {}
  double time() const { return steps * time_step; }
  void command(const Vector3d& velocity, const Vector3d& angular_velocity) { motion.command(time(), velocity, angular_velocity); }
  const RigidState& advance(int count = 1) {
    for (; count > 0; --count) motion.advance(time(), time_step), ++steps;
    return motion.state();
  }
};

TEST(CommandedMotion, RestsUntilItIsCommanded) {
  Drive run(unlimited(), 0.01);
  EXPECT_EQ(run.advance(10).position, start);
  EXPECT_EQ(run.motion.state().velocity, none);
  EXPECT_EQ(run.motion.state().orientation.coeffs(), Quaterniond::Identity().coeffs());
}

TEST(CommandedMotion, ApproachesTheWantedVelocityAtTheGreatestAcceleration) {
  Drive run(accelerating(2, 1), 0.01);
  run.command(Vector3d(0.6, 0, 0.8), none);  // 1 m/s: reached in 0.5 s
  for (int step = 1; step <= 50; ++step) {
    const RigidState& state = run.advance();
    // Rounding of up to 50 steps.
    EXPECT_LT((state.velocity - 2 * run.time() * Vector3d(0.6, 0, 0.8)).norm(), 1e-14);
    EXPECT_LT((state.acceleration - 2 * Vector3d(0.6, 0, 0.8)).norm(), 1e-12);
    EXPECT_LT((state.position - start - run.time() * run.time() * Vector3d(0.6, 0, 0.8)).norm(), 1e-14);
  }
  const RigidState& state = run.advance(10);
  EXPECT_EQ(state.velocity, Vector3d(0.6, 0, 0.8));
  EXPECT_EQ(state.acceleration, none);
  EXPECT_LT((state.position - start - (0.25 + 0.1) * Vector3d(0.6, 0, 0.8)).norm(), 1e-14);
}

TEST(CommandedMotion, TurnsAtTheGreatestAngularAcceleration) {
  Drive run(accelerating(1, 4), 0.01);
  run.command(none, Vector3d(0, 0, 2));
  run.advance(100);  // 0.5 s of acceleration, 0.5 s at 2 rad/s: 0.5 + 1 rad
  const Quaterniond expected(Eigen::AngleAxisd(1.5, Vector3d::UnitZ()));
  EXPECT_LT(run.motion.state().orientation.angularDistance(expected), 1e-7);  // an angle from a cosine near 1
  EXPECT_LT((run.motion.state().orientation.coeffs() - expected.coeffs()).norm(), 1e-14);
  EXPECT_LT((run.motion.state().angular_velocity - Vector3d(0, 0, 2)).norm(), 1e-14);
  EXPECT_EQ(run.motion.state().position, start);
}

TEST(CommandedMotion, LimitsTheVectorAndNotItsComponents) {
  CommandCase limits = unlimited();
  limits.greatest_speed = 0.5;
  limits.greatest_angular_speed = 0.25;
  Drive run(limits, 0.01);
  run.command(Vector3d(3, 4, 0), Vector3d(0, 0.6, 0.8));
  const RigidState& state = run.advance();
  EXPECT_NEAR(state.velocity.norm(), 0.5, 1e-15);
  EXPECT_NEAR(state.angular_velocity.norm(), 0.25, 1e-15);
  EXPECT_LT((state.orientation.conjugate() * state.velocity - Vector3d(0.3, 0.4, 0)).norm(), 1e-15);
  EXPECT_LT((state.orientation.conjugate() * state.angular_velocity - Vector3d(0, 0.15, 0.2)).norm(), 1e-15);
  run.command(Vector3d(0.3, 0, 0), none);  // less is left as it is
  run.advance();
  EXPECT_NEAR(run.motion.state().velocity.norm(), 0.3, 1e-15);
}

TEST(CommandedMotion, DrivesInCircles) {
  const double speed = 0.7, rate = 0.9, time_step = 0.05, angle = rate * time_step;
  Drive run(unlimited(), time_step);
  run.command(Vector3d(speed, 0, 0), Vector3d(0, 0, rate));
  run.advance();  // from rest to full speed
  const RigidState from = run.motion.state();
  // The mean of two velocities on a circle makes its chord shorter by (θ/2) cot(θ/2) than that of a circle of radius v/ω.
  const double radius = speed / rate * (angle / 2) / std::tan(angle / 2);
  const Vector3d centre = from.position + radius * (from.orientation * Vector3d::UnitY());
  for (int step = 0; step < 200; ++step) {
    const RigidState& state = run.advance();
    EXPECT_NEAR((state.position - centre).norm(), radius, 1e-13);
    EXPECT_NEAR(state.acceleration.norm(), 2 * speed * std::sin(angle / 2) / time_step, 1e-12);  // towards the centre, of the chord
    EXPECT_LT((state.orientation.conjugate() * state.velocity - Vector3d(speed, 0, 0)).norm(), 1e-14);
  }
}

TEST(CommandedMotion, ReadsCommandsInTheBodysAxes) {
  Drive run(unlimited(), 0.01);
  run.command(none, Vector3d(0, 0, 25 * M_PI));  // two steps: the first at half the rate on average
  run.advance(2);
  run.command(none, Vector3d(0, 0, 12.5 * M_PI));  // mean of 25π and 12.5π
  run.advance();
  run.command(Vector3d(1, 0, 0), none);
  run.advance();
  const double yaw = 0.01 * M_PI * (12.5 + 25 + 18.75 + 6.25);
  EXPECT_LT((run.motion.state().velocity - Vector3d(std::cos(yaw), std::sin(yaw), 0)).norm(), 1e-14);
  EXPECT_LT((run.motion.state().velocity - Vector3d(std::cos(0.625 * M_PI), std::sin(0.625 * M_PI), 0)).norm(), 1e-14);
}

TEST(CommandedMotion, TurnsAboutTheBodysAxes) {
  Drive run(unlimited(), 0.01);
  run.command(none, Vector3d(0, 0, 100 * M_PI));  // a quarter turn within a step from rest
  run.advance();
  run.command(none, none);  // and another
  run.advance();
  run.command(none, Vector3d(40, 0, 0));  // about the body's x axis, which by now points along −x
  const RigidState& state = run.advance();
  const Quaterniond expected = Quaterniond(Eigen::AngleAxisd(M_PI, Vector3d::UnitZ())) * Eigen::AngleAxisd(0.2, Vector3d::UnitX());
  EXPECT_LT((state.orientation.toRotationMatrix() - expected.toRotationMatrix()).norm(), 1e-14);
  EXPECT_LT((state.angular_velocity - Vector3d(-40, 0, 0)).norm(), 1e-13);
}

TEST(CommandedMotion, BrakesToAStopAfterItsTimeout) {
  CommandCase limits = accelerating(2, 4);
  limits.timeout = 0.5;
  const double time_step = 1.0 / 128;  // a binary number: times are exact
  Drive run(limits, time_step);
  run.command(Vector3d(0.5, 0, 0), Vector3d(0, 0, 1));
  run.advance(64);
  EXPECT_NEAR(run.motion.state().velocity.norm(), 0.5, 1e-14);
  double before = 0.5;
  for (int step = 0; step < 32; ++step) {  // 0.25 s at 2 m/s² and at 4 rad/s²
    const double speed = run.advance().velocity.norm();
    EXPECT_NEAR(before - speed, 2 * time_step, 1e-14);
    before = speed;
  }
  run.advance();
  EXPECT_EQ(run.motion.state().velocity, none);
  EXPECT_EQ(run.motion.state().angular_velocity, none);
  const Vector3d stopped = run.motion.state().position;
  EXPECT_EQ(run.advance(100).position, stopped);
  EXPECT_EQ(run.motion.state().acceleration, none);
  run.command(Vector3d(0.5, 0, 0), none);  // and goes on when it is told to
  EXPECT_GT(run.advance().velocity.norm(), 0.0);
}

TEST(CommandedMotion, GoesOnWhileCommandsComeAndForEverWithoutATimeout) {
  CommandCase limits = accelerating(2, 4);
  limits.timeout = 0.1;
  Drive renewed(limits, 0.01);
  for (int k = 0; k < 100; ++k) {
    renewed.command(Vector3d(0.5, 0, 0), none);
    renewed.advance(9);
  }
  EXPECT_EQ(renewed.motion.state().velocity, Vector3d(0.5, 0, 0));
  limits.timeout = 0;
  Drive left_alone(limits, 0.01);
  left_alone.command(Vector3d(0.5, 0, 0), none);
  EXPECT_EQ(left_alone.advance(5000).velocity, Vector3d(0.5, 0, 0));
}

TEST(CommandedMotion, AccelerationsAreTheChangesOverTheStep) {
  Drive run(accelerating(1.3, 2.1), 0.013);
  run.command(Vector3d(0.5, -0.2, 0.1), Vector3d(0.3, -0.4, 0.5));
  run.advance(7);
  const RigidState before = run.motion.state();
  const RigidState& after = run.advance();
  EXPECT_EQ(after.acceleration, Vector3d((after.velocity - before.velocity) / 0.013));
  EXPECT_EQ(after.angular_acceleration, Vector3d((after.angular_velocity - before.angular_velocity) / 0.013));
  EXPECT_EQ(after.position, Vector3d(before.position + 0.5 * 0.013 * (before.velocity + after.velocity)));
}

TEST(CommandedMotion, StaysInThePlaneInTwoDimensions) {
  CommandCase limits = accelerating(1, 1);
  limits.greatest_speed = 5;  // what is ignored does not count towards it
  Drive run(limits, 0.01, 2);
  run.command(Vector3d(3, 40, 4), Vector3d(7, 0.5, -7));
  const RigidState& state = run.advance(600);
  EXPECT_EQ(state.position.y(), start.y());
  for (const double across :
       {state.velocity.y(), state.angular_velocity.x(), state.angular_velocity.z(), state.orientation.x(), state.orientation.z()}) {
    EXPECT_EQ(across, 0.0);
  }
  EXPECT_NEAR(state.velocity.norm(), 5, 1e-13);
  EXPECT_NEAR(state.angular_velocity.y(), 0.5, 1e-13);
}

TEST(CommandedMotion, GoesOnBitForBitAfterItWasSaved) {
  const unsigned seed = 1307;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-2, 2);
  const auto vector = [&] { return Vector3d(any(random), any(random), any(random)); };
  CommandCase limits;  // the defaults, with a timeout that runs out while both go on
  limits.greatest_speed = 1.5;
  Drive run(limits, 0.0123);
  for (int k = 0; k < 20; ++k) {
    run.command(vector(), vector());
    run.advance(3);
  }
  const std::vector<double> saved = run.motion.save();
  EXPECT_EQ(saved.size(), run.motion.saved_size());
  Drive restored(limits, 0.0123);
  restored.steps = run.steps;
  restored.motion.restore(saved);
  EXPECT_EQ(restored.motion.save(), saved);
  for (int k = 0; k < 300; ++k) {
    run.advance();
    restored.advance();
    ASSERT_EQ(run.motion.save(), restored.motion.save()) << "step " << k;
  }
  EXPECT_EQ(run.motion.state().velocity, none);
  EXPECT_NE(error_of([&] { restored.motion.restore(std::vector<double>(5)); }).find("from 5 numbers; it takes 27"), std::string::npos);
}

}  // namespace
}  // namespace wavetank::commanded_motion_test

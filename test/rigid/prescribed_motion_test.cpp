// Prescribed motions against formulae: where they lead, and that velocities and accelerations are their derivatives.
#include "wavetank/rigid/prescribed_motion.h"

#include <Eigen/Geometry>
#include <functional>

#include "../geometry/geometry_fixture.h"

namespace wavetank::prescribed_motion_test {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;

const Vector3d reference(0.3, -0.2, 0.5);

PrescribedMotion motion(const PrescribedCase& prescribed, int dimensions = 3, const Vector3d& about = reference) {
  return PrescribedMotion(prescribed, about, dimensions, 9.81, "", {}, "body 'flap'");
}

/// Central difference of the fourth order.
template <class Value>
Value derivative(const std::function<Value(double)>& of, double time) {
  const double h = 1e-3;
  return (8.0 * (of(time + h) - of(time - h)) - (of(time + 2 * h) - of(time - 2 * h))) / (12 * h);
}

/// The greatest difference at `time` between a motion's rates and the differences of what they are the rates of.
double derivative_error(const PrescribedMotion& moving, double time) {
  const std::function<Vector3d(double)> position = [&](double t) { return moving.at(t).position; };
  const std::function<Vector3d(double)> velocity = [&](double t) { return moving.at(t).velocity; };
  const std::function<Vector3d(double)> angular_velocity = [&](double t) { return moving.at(t).angular_velocity; };
  const std::function<Matrix3d(double)> rotation = [&](double t) { return moving.at(t).orientation.toRotationMatrix(); };
  const RigidState state = moving.at(time);
  const Matrix3d spin = derivative(rotation, time) * rotation(time).transpose();  // the cross product with the angular velocity
  return std::max({(derivative(position, time) - state.velocity).norm(), (derivative(velocity, time) - state.acceleration).norm(),
                   (Vector3d(spin(2, 1), spin(0, 2), spin(1, 0)) - state.angular_velocity).norm(),
                   (derivative(angular_velocity, time) - state.angular_acceleration).norm()});
}

const std::vector<Direction> every_direction = {Direction::surge, Direction::sway, Direction::heave,  Direction::roll,
                                                Direction::pitch, Direction::yaw,  Direction::stroke, Direction::angle};
const std::vector<Direction> directions_in_2d = {Direction::surge, Direction::heave, Direction::pitch, Direction::stroke, Direction::angle};
const std::vector<Direction> not_in_2d = {Direction::sway, Direction::roll, Direction::yaw};

/// Two harmonics and a ramp in each direction, each with figures of its own.
PrescribedCase busy_motion(const std::vector<Direction>& directions, const Vector3d& axis) {
  PrescribedCase prescribed;
  prescribed.axis = axis;
  prescribed.point = Vector3d(-0.4, 0.1, 0.2);
  double k = 0;
  for (const Direction direction : directions) {
    ++k;
    prescribed.harmonics.push_back({direction, 0.1 + 0.03 * k, 0.4 + 0.1 * k, 0.7 * k, 1.55});
    prescribed.harmonics.push_back({direction, -0.02 * k, 1.3 - 0.1 * k, -0.3 * k, 0});
    prescribed.ramps.push_back({direction, 0.5 - 0.1 * k, 0.25, 2.55});
  }
  return prescribed;
}

// The differences' error is h⁴/30 of a fifth derivative: h = 1e-3, products of several rates of up to 2π · 1.3 Hz. 3e-8 was found, where
// accelerations reach 29. Rounding adds 1e-16/h of the value.
constexpr double difference_error = 1e-7;

TEST(PrescribedMotion, RatesAreDerivativesInEveryDirectionAtOnce) {
  const PrescribedMotion moving = motion(busy_motion(every_direction, Vector3d(1, -2, 3)));
  double fastest = 0;
  for (double time = 0.01; time < 4; time += 0.0719) {
    EXPECT_LT(derivative_error(moving, time), difference_error) << "at " << time << " s";
    fastest = std::max(fastest, moving.at(time).angular_velocity.norm());
  }
  EXPECT_GT(fastest, 1.0);  // rotations were really at work
}

TEST(PrescribedMotion, RatesAreDerivativesInTwoDimensionsAndStayInThePlane) {
  const Vector3d flat(0.3, 0, 0.5);
  PrescribedCase prescribed = busy_motion(directions_in_2d, Vector3d(1, 0, 3));
  prescribed.point->y() = 0;
  const PrescribedMotion moving = motion(prescribed, 2, flat);
  for (double time = 0.01; time < 4; time += 0.0719) {
    EXPECT_LT(derivative_error(moving, time), difference_error) << "at " << time << " s";
    const RigidState state = moving.at(time);
    for (const double across : {state.position.y(), state.velocity.y(), state.acceleration.y(), state.angular_velocity.x(),
                                state.angular_velocity.z(), state.orientation.x(), state.orientation.z()}) {
      EXPECT_EQ(across, 0.0);
    }
  }
}

TEST(PrescribedMotion, TurnsByRollThenPitchThenYawThenItsOwnAngleAboutItsPoint) {
  const Vector3d point(1, 2, -1), axis(1, 1, 0.5);
  PrescribedCase prescribed;
  prescribed.point = point;
  prescribed.axis = axis;
  const double ends[] = {0.1, -0.2, 0.3, 0.5, -0.7, 1.1, 0.4, 0.9};
  for (std::size_t k = 0; k < 8; ++k) prescribed.ramps.push_back({every_direction[k], ends[k], 0, 1});
  const RigidState state = motion(prescribed).at(1.5);
  const Vector3d own = axis.normalized();
  const Matrix3d rotation =
      (AngleAxisd(0.9, own) * AngleAxisd(1.1, Vector3d::UnitZ()) * AngleAxisd(-0.7, Vector3d::UnitY()) * AngleAxisd(0.5, Vector3d::UnitX()))
          .toRotationMatrix();
  // Rounding of four rotations.
  EXPECT_LT((state.orientation.toRotationMatrix() - rotation).norm(), 1e-14);
  const Vector3d displacement = Vector3d(0.1, -0.2, 0.3) + 0.4 * own;
  EXPECT_LT((state.position - (point + displacement + rotation * (reference - point))).norm(), 1e-14);
  EXPECT_LT((state.moved(point, reference) - point - displacement).norm(), 1e-14);
  EXPECT_EQ(state.velocity.norm(), 0.0);
  EXPECT_EQ(state.angular_acceleration.norm(), 0.0);
}

TEST(PrescribedMotion, TurnsAboutTheReferenceWithoutAPoint) {
  PrescribedCase prescribed;
  prescribed.ramps = {{Direction::yaw, M_PI / 2, 0, 1}};
  const RigidState state = motion(prescribed).at(2);
  EXPECT_EQ(state.position, reference);
  EXPECT_LT((state.orientation * Vector3d::UnitX() - Vector3d::UnitY()).norm(), 1e-15);
}

TEST(PrescribedMotion, PitchTurnsXTowardsMinusZ) {
  PrescribedCase prescribed;
  prescribed.ramps = {{Direction::pitch, M_PI / 2, 0, 1}};
  EXPECT_LT((motion(prescribed, 2, Vector3d::Zero()).at(2).orientation * Vector3d::UnitX() + Vector3d::UnitZ()).norm(), 1e-15);
}

TEST(PrescribedMotion, OwnAngleInTwoDimensionsFollowsTheAxis) {
  for (const auto& [axis, sign] : {std::pair(Vector3d(0, 2, 0), 1.0), {Vector3d(0, -2, 0), -1.0}, {Vector3d(1, 0, 1), 1.0}}) {
    PrescribedCase prescribed;
    prescribed.axis = axis;
    prescribed.ramps = {{Direction::angle, 0.5, 0, 1}};
    EXPECT_NEAR(2 * std::asin(motion(prescribed, 2).at(2).orientation.y()), 0.5 * sign, 1e-15);
  }
}

TEST(PrescribedMotion, HarmonicStartsAtItsPlaceAndRisesSmoothly) {
  PrescribedCase prescribed;
  prescribed.harmonics = {{Direction::surge, 0.2, 0.8, 0.6, 0}};
  const double rate = 2 * M_PI * 0.8;
  const PrescribedMotion sudden = motion(prescribed);
  for (const double time : {0.0, 0.4, 3.1}) {
    const RigidState state = sudden.at(time);
    EXPECT_NEAR(state.position.x() - reference.x(), 0.2 * (std::sin(rate * time + 0.6) - std::sin(0.6)), 1e-15);
    EXPECT_NEAR(state.velocity.x(), 0.2 * rate * std::cos(rate * time + 0.6), 1e-14);
    EXPECT_NEAR(state.acceleration.x(), -0.2 * rate * rate * std::sin(rate * time + 0.6), 1e-13);
  }
  prescribed.harmonics[0].rise = 2;
  const PrescribedMotion smooth = motion(prescribed);
  EXPECT_EQ(smooth.at(0).position, reference);
  EXPECT_EQ(smooth.at(0).velocity.norm(), 0.0);
  EXPECT_EQ(smooth.at(0).acceleration.norm(), 0.0);
  EXPECT_NEAR(smooth.at(1).position.x() - reference.x(), 0.1 * (std::sin(rate + 0.6) - std::sin(0.6)), 1e-15);  // half risen
  for (const double time : {2.0, 3.1}) EXPECT_EQ(smooth.at(time).acceleration, sudden.at(time).acceleration);
}

TEST(PrescribedMotion, RampGoesSmoothlyFromOneTimeToAnother) {
  PrescribedCase prescribed;
  prescribed.ramps = {{Direction::heave, -0.3, 1, 3}};
  const PrescribedMotion moving = motion(prescribed);
  const auto rise = [&](double time) { return moving.at(time).position.z() - reference.z(); };
  EXPECT_EQ(rise(0), 0.0);
  EXPECT_EQ(rise(1), 0.0);
  EXPECT_NEAR(rise(2), -0.15, 1e-15);
  EXPECT_NEAR(rise(3), -0.3, 1e-15);
  EXPECT_NEAR(rise(9), -0.3, 1e-15);
  EXPECT_NEAR(moving.at(2).velocity.z(), -0.3 * 15.0 / 8.0 / 2.0, 1e-15);
  for (const double time : {1.0, 3.0}) {  // velocity and acceleration do not jump: they leave 0 as 30 s² and 60 s
    const double step = 1e-6, fraction = step / 2;
    for (const double side : {-step, step}) {
      EXPECT_NEAR(moving.at(time + side).velocity.z(), 0.0, 0.3 * 31 * fraction * fraction / 2);
      EXPECT_NEAR(moving.at(time + side).acceleration.z(), 0.0, 0.3 * 61 * fraction / 4);
    }
  }
}

TEST(PrescribedMotion, RestsBeforeTheStart) {
  PrescribedCase prescribed = busy_motion(every_direction, Vector3d(1, -2, 3));
  const PrescribedMotion moving = motion(prescribed);
  const RigidState before = moving.at(-0.5), start = moving.at(0);
  EXPECT_GT(start.velocity.norm(), 0.1);  // there is something to suppress
  EXPECT_EQ(before.position, start.position);
  EXPECT_EQ(before.orientation.coeffs(), start.orientation.coeffs());
  for (const Vector3d& rate : {before.velocity, before.angular_velocity, before.acceleration, before.angular_acceleration})
    EXPECT_EQ(rate.norm(), 0.0);
}

TEST(PrescribedMotion, GreatestSpeedIsThatOfTheFarthestCorner) {
  const Box box{Vector3d(0, -0.5, 0), Vector3d(0.2, 0.5, 1.5)};
  const auto fastest = [&](const PrescribedCase& prescribed, double duration) { return motion(prescribed).greatest_speed(box, duration); };
  PrescribedCase flap;  // about an edge of the floor; the greatest arm is to the corner (0.2, 1.5) of the x–z plane
  flap.point = Vector3d::Zero();
  flap.harmonics = {{Direction::pitch, 0.2, 37, 0.3, 0}};
  const double speed = 0.2 * 2 * M_PI * 37 * std::hypot(0.2, 1.5);
  EXPECT_LE(fastest(flap, 60), speed * (1 + 1e-14));
  EXPECT_GT(fastest(flap, 60), 0.996 * speed);  // 40 times a period miss at most 1 − cos(π/40) = 0.31 %
  PrescribedCase jerk;
  jerk.ramps = {{Direction::sway, 0.1, 29.9, 29.91}};                                // a hundredth of a second within a minute
  EXPECT_NEAR(fastest(jerk, 60), 0.1 * 15 / 8 / 0.01, 0.004 * 0.1 * 15 / 8 / 0.01);  // curvature of the rate at its top, 40 times a ramp
  EXPECT_EQ(fastest(jerk, 29), 0.0);                                                 // the run ends before it
  EXPECT_EQ(fastest({}, 60), 0.0);
}

TEST(PrescribedMotion, RefusesDirectionsThatTwoDimensionsDoNotHave) {
  for (const Direction direction : not_in_2d) {
    PrescribedCase harmonic, ramp;
    harmonic.harmonics = {{direction, 0.1, 1, 0, 0}};
    ramp.ramps = {{direction, 0.1, 0, 1}};
    EXPECT_ERROR(motion(harmonic, 2), "body 'flap': a two-dimensional case has no ");
    EXPECT_ERROR(motion(ramp, 2), "one of surge, heave, pitch, stroke, angle");
  }
  PrescribedCase across;
  across.ramps = {{Direction::stroke, 0.1, 0, 1}};  // with the axis along y
  EXPECT_ERROR(motion(across, 2), "a stroke's axis must lie in the x–z plane");
}

TEST(PrescribedMotion, RefusesNumbersThatMakeNoMotion) {
  const double infinite = std::numeric_limits<double>::infinity();
  const auto refused = [](const std::function<void(PrescribedCase&)>& spoil, const std::string& part) {
    PrescribedCase prescribed;
    prescribed.harmonics = {{Direction::surge, 0.1, 1, 0, 0}};
    prescribed.ramps = {{Direction::surge, 0.1, 0, 1}};
    spoil(prescribed);
    EXPECT_ERROR(motion(prescribed), part);
  };
  refused([](PrescribedCase& p) { p.axis = Vector3d::Zero(); }, "axis must have a length");
  refused([&](PrescribedCase& p) { p.point = Vector3d(0, infinite, 0); }, "not a finite place");
  refused([](PrescribedCase& p) { p.harmonics[0].frequency = -1; }, "harmonic in surge has a frequency of -1 Hz; it must be at least 0");
  refused([](PrescribedCase& p) { p.harmonics[0].rise = -1; }, "has a rise of -1 s");
  refused([&](PrescribedCase& p) { p.harmonics[0].amplitude = infinite; }, "not finite");
  refused([](PrescribedCase& p) { p.ramps[0].to = 0; }, "goes from 0 s to 0 s");
  refused([](PrescribedCase& p) { p.ramps[0].from = -1; }, "it must start at 0 s or later");
  refused([&](PrescribedCase& p) { p.ramps[0].change = infinite; }, "not finite");
}

}  // namespace
}  // namespace wavetank::prescribed_motion_test

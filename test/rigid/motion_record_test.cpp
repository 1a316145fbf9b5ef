// Motions that follow a file: the spline through its points, and every way in which the file can be written or be wrong.
#include <functional>
#include <random>

#include "../geometry/geometry_fixture.h"
#include "wavetank/rigid/prescribed_motion.h"

namespace wavetank::motion_record_test {
namespace {

class MotionRecordTest : public GeometryTest {
 protected:
  RecordCase record;

  PrescribedMotion motion(int dimensions = 3, const ResourceResolver& resolve = {}) const {
    PrescribedCase prescribed;
    prescribed.records = {record};
    return PrescribedMotion(prescribed, Vector3d::Zero(), dimensions, 9.81, directory.string(), resolve, "tank");
  }
  double surge(double time) const { return motion().at(time).position.x(); }
  void follow(const std::string& text) { record.file = write("motion.csv", text); }
  std::string refusal(int dimensions = 3) const {
    return error_of([&] { motion(dimensions); });
  }
  void expect_refusal(const std::string& part) const {
    const std::string message = refusal();
    EXPECT_EQ(message.rfind("tank: ", 0), 0u) << "the message is: " << message;
    EXPECT_NE(message.find(part), std::string::npos) << "the message is: " << message;
  }
};

/// sin 2πt over whole and half periods, whose second derivative is 0 at both ends as the spline's.
std::string sampled_sine(int points) {
  std::ostringstream text;
  text.precision(17);
  text << "time,surge\n";
  for (int k = 0; k <= points; ++k) text << 1.5 * k / points << "," << std::sin(2 * M_PI * 1.5 * k / points) << "\n";
  return text.str();
}

TEST_F(MotionRecordTest, FollowsASineToTheFourthOrder) {
  double before = 0;
  for (const int points : {30, 60, 120}) {
    follow(sampled_sine(points));
    const PrescribedMotion moving = motion();
    double error = 0, rate_error = 0, acceleration_error = 0;
    const double rate = 2 * M_PI;
    for (int k = 0; k <= 3000; ++k) {
      const double time = 1.5 * k / 3000;
      const RigidState state = moving.at(time);
      error = std::max(error, std::abs(state.position.x() - std::sin(rate * time)));
      rate_error = std::max(rate_error, std::abs(state.velocity.x() - rate * std::cos(rate * time)));
      acceleration_error = std::max(acceleration_error, std::abs(state.acceleration.x() + rate * rate * std::sin(rate * time)));
    }
    // Bounds of cubic spline interpolation, exact in the leading order (Hall and Meyer): 5/384, 1/24 and 3/8 of the fourth derivative.
    const double h = 1.5 / points, fourth = std::pow(rate, 4);
    EXPECT_LT(error, 5.0 / 384.0 * fourth * std::pow(h, 4));
    EXPECT_LT(rate_error, 1.0 / 24.0 * fourth * std::pow(h, 3));
    EXPECT_LT(acceleration_error, 3.0 / 8.0 * fourth * h * h);
    if (before > 0) {
      EXPECT_NEAR(before / error, 16.0, 1.0);  // the next order is h² smaller: 0.1 at 30 points
    }
    before = error;
  }
}

TEST_F(MotionRecordTest, VelocityAndAccelerationAreContinuousEvenThroughNoise) {
  const unsigned seed = 20241;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> noise(-1, 1);
  std::ostringstream text;
  text.precision(17);
  text << "time,surge\n";
  std::vector<double> times, values;
  for (int k = 0; k < 200; ++k) {
    times.push_back(0.001 * k + 0.0003 * noise(random));
    values.push_back(noise(random));
    text << times.back() << "," << values.back() << "\n";
  }
  follow(text.str());
  record.delay = 1;  // the file starts after t = 0, and the first value counts there
  const PrescribedMotion moving = motion();
  for (std::size_t k = 0; k < times.size(); ++k) {
    EXPECT_NEAR(moving.at(times[k] + 1).position.x(), values[k] - values[0], 1e-12);
    if (k == 0 || k + 1 == times.size()) continue;
    // On both sides of a point the acceleration a tells v, and the jerk j tells a: within ε, v changes by a ε and a by j ε. The
    // accelerations of such noise are of order 1/(0.4 ms)² ~ 1e7 and the jerk of order 1e11.
    const double epsilon = 1e-10;
    const RigidState left = moving.at(times[k] + 1 - epsilon), right = moving.at(times[k] + 1 + epsilon);
    EXPECT_LT((right.velocity - left.velocity).norm(), 2 * epsilon * 1e8);
    EXPECT_LT((right.acceleration - left.acceleration).norm(), 2 * epsilon * 1e12);
  }
  EXPECT_EQ(moving.at(0.5).velocity.norm(), 0.0);
  EXPECT_NEAR(moving.at(times.front() + 1 + 1e-9).acceleration.x(), 0.0, 1e3);  // natural ends: jerk · 1e-9 s
}

TEST_F(MotionRecordTest, IsHeldBeyondItsEnds) {
  follow("time,surge\n1,5\n2,6\n4,10\n");
  for (const double time : {0.0, 0.99}) EXPECT_EQ(surge(time), 0.0);
  EXPECT_NEAR(surge(2), 1.0, 1e-14);
  for (const double time : {4.0, 4.01, 100.0}) EXPECT_NEAR(surge(time), 5.0, 1e-14);
  EXPECT_GT(motion().at(4.0).velocity.x(), 1.0);
  EXPECT_EQ(motion().at(4.01).velocity.x(), 0.0);
  EXPECT_EQ(motion().at(4.01).acceleration.x(), 0.0);
}

TEST_F(MotionRecordTest, CountsFromItsValueAtTheStartTimesItsFactorAfterItsDelay) {
  follow("time,surge\n0,3\n1,5\n2,7\n3,9\n");  // a straight line: exact
  EXPECT_NEAR(surge(1.5), 3.0, 1e-14);
  record.factor = -0.1;
  EXPECT_NEAR(surge(1.5), -0.3, 1e-14);
  record.delay = -1;
  EXPECT_EQ(surge(0), 0.0);
  EXPECT_NEAR(surge(1.5), -0.3, 1e-14);
  record.delay = 1;
  EXPECT_NEAR(surge(1.5), -0.1, 1e-14);
  EXPECT_NEAR(motion().at(1.5).velocity.x(), -0.2, 1e-14);
}

TEST_F(MotionRecordTest, TakesEveryColumnNamedAfterADirection) {
  follow("time,heave,remark,pitch,surge\n0,0,start,0,0\n1,2,,0.5,1\n");
  const RigidState state = motion(2).at(1);
  EXPECT_NEAR(state.position.x(), 1, 1e-15);
  EXPECT_NEAR(state.position.z(), 2, 1e-15);
  EXPECT_NEAR(2 * std::asin(state.orientation.y()), 0.5, 1e-15);
  record.column = "heave";
  EXPECT_EQ(motion().at(1).position.x(), 0.0);
  EXPECT_NEAR(motion().at(1).position.z(), 2, 1e-15);
  record.direction = Direction::surge;
  EXPECT_NEAR(motion().at(1).position.x(), 2, 1e-15);
  EXPECT_EQ(motion().at(1).position.z(), 0.0);
}

TEST_F(MotionRecordTest, AllowsCommentsEmptyLinesQuotesSpacesAndOtherSystemsLineEnds) {
  follow(
      "\xEF\xBB\xBF# measured\r\n\r\n \"t, of the clock\" ,  \"piston\"\r\n# calibrated\r\n0 , +1e0\r\n\r\n  1,\t\"3\"\r\n2,.5e1 \r\n"
      "3,7");
  record.time_column = "t, of the clock";
  record.column = "piston";
  record.direction = Direction::surge;
  EXPECT_NEAR(surge(1.5), 3.0, 1e-14);
  EXPECT_NEAR(surge(3), 6.0, 1e-14);
}

TEST_F(MotionRecordTest, IsFoundAsMeshesAre) {
  const std::string path = write("motion.csv", "time,surge\n0,0\n1,1\n");
  for (const std::string& file : {std::string("motion.csv"), path, "file://" + path}) {
    record.file = file;
    EXPECT_NEAR(surge(1), 1, 1e-15) << file;
  }
  record.file = "package://tanks/motion.csv";
  const auto resolve = [&](const std::string& uri) { return uri == record.file ? path : ""; };
  EXPECT_NEAR(motion(3, resolve).at(1).position.x(), 1, 1e-15);
  expect_refusal("motion record 'package://tanks/motion.csv' cannot be found");
  record.file = "motion2.csv";
  expect_refusal("motion2.csv' does not exist");
  record.file = "";
  expect_refusal("a motion record has an empty path");
  record.file = directory.string();
  expect_refusal("is not a regular file");
  follow("");
  expect_refusal("is empty");
}

TEST_F(MotionRecordTest, RestsBeforeTheStartEvenWhereTheFileDoesNot) {
  follow("time,surge\n-2,0\n-1,1\n1,3\n2,4\n");
  const RigidState before = motion().at(-0.5);
  EXPECT_EQ(before.position, Vector3d::Zero());
  EXPECT_EQ(before.velocity, Vector3d::Zero());
  EXPECT_NEAR(motion().at(0).velocity.x(), 1, 1e-14);
  EXPECT_NEAR(surge(1), 1, 1e-14);
}

TEST_F(MotionRecordTest, GreatestSpeedIsFoundWithinAShortMovement) {
  std::ostringstream text;
  text << "time,surge\n0,0\n";
  for (int k = -10; k <= 10; ++k) text << 29.985 + 0.01 * k << "," << (k == 0 ? 0.01 : 0) << "\n";  // up and down within a minute
  follow(text.str() + "60,0\n");
  const PrescribedMotion moving = motion();
  double greatest = 0, jerk = 0;
  for (int k = 0; k <= 20000; ++k) {
    const double time = 29.965 + 2e-6 * k;
    greatest = std::max(greatest, std::abs(moving.at(time).velocity.x()));
    jerk = std::max(jerk, std::abs(moving.at(time + 2e-6).acceleration.x() - moving.at(time).acceleration.x()) / 2e-6);
  }
  EXPECT_GT(greatest, 1.0);  // the points' slope
  // The acceleration goes through 0 at the top, which lies at most half the distance of two times from one of them.
  const double distance = 0.01 / 4;
  EXPECT_NEAR(moving.greatest_speed({}, 60), greatest, jerk * distance * distance / 8);
}

struct BadRecord {
  const char* name;
  const char* text;
  const char* part;
};

class BadRecords : public MotionRecordTest, public ::testing::WithParamInterface<BadRecord> {};

TEST_P(BadRecords, AreRefusedWithFileAndLine) {
  follow(GetParam().text);
  const std::string message = refusal();
  EXPECT_EQ(message.rfind("tank: motion record file '" + record.file + "'", 0), 0u) << "the message is: " << message;
  EXPECT_NE(message.find(GetParam().part), std::string::npos) << "the message is: " << message;
}

INSTANTIATE_TEST_SUITE_P(
    MotionRecord, BadRecords,
    ::testing::Values(
        BadRecord{"Unordered", "# x\ntime,surge\n0,0\n2,1\n1.5,2\n", "line 5, column 'time': the time 1.5 s does not come after 2 s"},
        BadRecord{"Repeated", "time,surge\n0,0\n0,1\n", "line 3, column 'time': the time 0 s does not come after 0 s"},
        BadRecord{"NoNumber", "time,surge\n0,0\n1,fast\n", "line 3, column 'surge': 'fast' is not a finite number"},
        BadRecord{"HalfANumber", "time,surge\n0,0\n1,1.5m\n", "line 3, column 'surge': '1.5m' is not a finite number"},
        BadRecord{"NotANumber", "time,surge\n0,nan\n1,0\n", "line 2, column 'surge': 'nan'"},
        BadRecord{"TooLarge", "time,surge\n0,0\n1e999,0\n", "line 3, column 'time': '1e999'"},
        BadRecord{"Missing", "time,surge\n0,0\n\n1,\n", "line 4, column 'surge': '' is not"},
        BadRecord{"FewValues", "time,surge,heave\n0,0,0\n1,1\n", "line 3, has 2 values, where the header in line 1 names 3 columns"},
        BadRecord{"ManyValues", "time,surge\n0,0,0\n1,1\n", "line 2, has 3 values"},
        BadRecord{"NoTime", "t,surge\n0,0\n1,1\n", "line 1, names no column 'time'; it names 't' and 'surge'"},
        BadRecord{"NoDirection", "time,x,y\n0,0,0\n1,1,1\n",
                  "no column is named after a direction (surge, sway, heave, roll, pitch, yaw, stroke, angle); it has 'time', 'x' and 'y'"},
        BadRecord{"Twice", "time,surge,surge\n0,0,0\n1,1,1\n", "line 1, names the column 'surge' twice"},
        BadRecord{"OneLine", "time,surge\n0,0\n", "has 1 line of values after its header; a motion takes at least two"},
        BadRecord{"HeaderOnly", "time,surge\n", "has 0 lines of values"}, BadRecord{"NoHeader", "# nothing\n\n", "has no header line"}),
    [](const auto& instance) { return std::string(instance.param.name); });

TEST_F(MotionRecordTest, RefusesColumnsWithoutADirectionAndTheOtherWayRound) {
  follow("time,x,sway\n0,0,0\n1,1,1\n");
  record.column = "x";
  expect_refusal("the column 'x' is not named after a direction; give its direction, one of surge, sway");
  record.column = "y";
  record.direction = Direction::surge;
  expect_refusal("line 1, names no column 'y'; it names 'time', 'x' and 'sway'");
  record.column = "";
  expect_refusal("has a direction but no column");
  record.direction = {};
  EXPECT_NE(refusal(2).find("a two-dimensional case has no sway"), std::string::npos);
  record.column = "x";
  record.direction = Direction::surge;
  record.factor = std::numeric_limits<double>::infinity();
  expect_refusal("not finite");
}

}  // namespace
}  // namespace wavetank::motion_record_test

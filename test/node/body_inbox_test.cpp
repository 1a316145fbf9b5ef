#include "wavetank/node/body_inbox.h"

#include <gtest/gtest.h>

#include <limits>
#include <thread>

#include "example_case.h"
#include "wavetank/common/error.h"

namespace wavetank::body_inbox_test {

using test::example_frames;
using test::moving_box_case;
using Axes = AskedWrench::Axes;

namespace {

geometry_msgs::WrenchStamped wrench_in(const std::string& frame) {
  geometry_msgs::WrenchStamped message;
  message.header.frame_id = frame;
  message.wrench.force.x = 1;
  message.wrench.force.z = 3;
  message.wrench.torque.y = 5;
  return message;
}

std::string refusal(const geometry_msgs::WrenchStamped& message, std::size_t owner) {
  try {
    read_wrench(message, owner, example_frames(moving_box_case()));
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

const double nan = std::numeric_limits<double>::quiet_NaN();
const double infinity = std::numeric_limits<double>::infinity();

}  // namespace

TEST(ReadWrench, TellsTheAxesByTheFrame) {
  const auto frames = example_frames(moving_box_case());
  for (const auto& [frame, axes] :
       {std::pair<std::string, Axes>{"", Axes::body}, {"basin/bodies/box", Axes::body}, {"basin", Axes::tank}, {"world", Axes::world}}) {
    const AskedWrench wrench = read_wrench(wrench_in(frame), 1, frames);
    EXPECT_EQ(wrench.axes, axes) << frame;
    EXPECT_EQ(wrench.force, Vector3d(1, 0, 3));
    EXPECT_EQ(wrench.torque, Vector3d(0, 5, 0));
  }
  EXPECT_EQ(read_wrench(wrench_in("basin"), 0, frames).axes, Axes::body) << "the tank's own";
}

TEST(ReadWrench, RefusesAnotherFrameAndSaysWhichAreAllowed) {
  EXPECT_EQ(
      refusal(wrench_in("basin/bodies/other"), 1),
      "a wrench in frame 'basin/bodies/other' is ignored: its frame_id must be 'basin/bodies/box', 'basin', 'world' or empty, which means "
      "the body's own");
  EXPECT_EQ(refusal(wrench_in("map"), 0),
            "a wrench in frame 'map' is ignored: its frame_id must be 'basin', 'world' or empty, which means the body's own");
}

TEST(ReadWrench, RefusesWhatIsNotFinite) {
  for (const double value : {nan, infinity, -infinity}) {
    geometry_msgs::WrenchStamped message = wrench_in("");
    message.wrench.force.y = value;
    EXPECT_EQ(refusal(message, 1), "a wrench with a NaN or an infinite value is ignored: the one before stays");
    message = wrench_in("");
    message.wrench.torque.z = value;
    EXPECT_EQ(refusal(message, 1), "a wrench with a NaN or an infinite value is ignored: the one before stays");
  }
}

TEST(ReadVelocity, RefusesWhatIsNotFinite) {
  geometry_msgs::Twist message;
  message.linear.x = 0.5;
  message.angular.y = -0.25;
  EXPECT_EQ(read_velocity(message).velocity, Vector3d(0.5, 0, 0));
  EXPECT_EQ(read_velocity(message).angular_velocity, Vector3d(0, -0.25, 0));
  message.angular.z = nan;
  EXPECT_THROW(read_velocity(message), Error);
  message.angular.z = 0;
  message.linear.y = infinity;
  EXPECT_THROW(read_velocity(message), Error);
}

TEST(Discharges, AreFiniteAndNotNegative) {
  std_msgs::Float64 message;
  message.data = 0.02;
  EXPECT_EQ(read_discharge(message), 0.02);
  for (const double wrong : {-0.01, nan, infinity}) {
    message.data = wrong;
    EXPECT_THROW(read_discharge(message), Error);
  }
  BodyInbox inbox;
  inbox.put_discharge(1, 0.1);
  inbox.put_discharge(1, 0.2);
  EXPECT_EQ(inbox.take().discharges, (std::map<std::size_t, double>{{1, 0.2}}));
  EXPECT_TRUE(inbox.take().discharges.empty());
}

TEST(OutsideWrenches, OfTheTanksAxesAreTurnedIntoTheWorld) {
  const Quaterniond tank(Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitZ()));
  AskedWrench asked{{1, 0, 2}, {0, 3, 0}, Axes::tank};
  OutsideWrench wrench = outside_wrench(asked, tank, 4.0, 0.5);
  EXPECT_FALSE(wrench.turns_with_body);
  EXPECT_LT((wrench.force - Vector3d(0, 1, 2)).norm(), 1e-15);
  EXPECT_LT((wrench.torque - Vector3d(-3, 0, 0)).norm(), 1e-15);
  EXPECT_EQ(wrench.until, 4.5);

  asked.axes = Axes::world;
  wrench = outside_wrench(asked, tank, 4.0, 0.5);
  EXPECT_FALSE(wrench.turns_with_body);
  EXPECT_EQ(wrench.force, asked.force);

  asked.axes = Axes::body;
  wrench = outside_wrench(asked, tank, 4.0, 0.0);
  EXPECT_TRUE(wrench.turns_with_body);
  EXPECT_EQ(wrench.torque, asked.torque);
  EXPECT_GT(wrench.until, 1e30) << "no timeout: until it is replaced";
}

TEST(Inbox, KeepsTheNewestOfEachBodyAndIsEmptyOnceTaken) {
  BodyInbox inbox;
  for (const double force : {1.0, 2.0}) {
    inbox.put(1, AskedWrench{{force, 0, 0}, {0, 0, 0}, Axes::body});
    inbox.put(3, AskedWrench{{10 * force, 0, 0}, {0, 0, 0}, Axes::tank});
  }
  inbox.put(0, AskedVelocity{{0.5, 0, 0}, {0, 0, 0}});
  const BodyInbox::Contents contents = inbox.take();
  ASSERT_EQ(contents.wrenches.size(), 2U);
  EXPECT_EQ(contents.wrenches.at(1).force.x(), 2.0);
  EXPECT_EQ(contents.wrenches.at(3).force.x(), 20.0);
  EXPECT_EQ(contents.wrenches.at(3).axes, Axes::tank);
  ASSERT_EQ(contents.velocities.size(), 1U);
  EXPECT_EQ(contents.velocities.at(0).velocity.x(), 0.5);
  EXPECT_TRUE(inbox.take().wrenches.empty());
}

TEST(Inbox, LosesNoLastMessageBetweenThreads) {
  BodyInbox inbox;
  constexpr int count = 20000;
  std::thread sender([&inbox] {
    for (int i = 1; i <= count; ++i) inbox.put(1, AskedWrench{Vector3d::Constant(i), Vector3d::Constant(i), Axes::body});
  });
  double last = 0;
  while (last < count) {
    const BodyInbox::Contents contents = inbox.take();
    if (contents.wrenches.empty()) continue;
    const AskedWrench& wrench = contents.wrenches.at(1);
    EXPECT_GT(wrench.force.x(), last);
    EXPECT_EQ(wrench.force.x(), wrench.torque.z()) << "half of one message, half of another";
    last = wrench.force.x();
  }
  sender.join();
}

}  // namespace wavetank::body_inbox_test

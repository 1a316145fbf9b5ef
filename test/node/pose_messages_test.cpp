#include "wavetank/node/pose_messages.h"

#include <gtest/gtest.h>

#include <map>

#include "example_case.h"
#include "wavetank/node/messages.h"

namespace wavetank::pose_messages_test {

using test::example_case;
using test::example_frames;
using test::example_layout;
using test::moving_box_case;
using test::moving_tank_case;

namespace {

/// The tank turned by a quarter about z, the box by a quarter about y (x towards −z).
PoseSample example_sample(double time) {
  PoseSample sample;
  sample.time = time;
  sample.states.resize(2);
  sample.states[0].position = {10, 20, 30};
  sample.states[0].orientation = Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitZ());
  sample.states[0].velocity = {0, 3, 0};
  sample.states[0].angular_velocity = {0, 0, 2};
  sample.states[1].position = {1.8, 2.5, 3.3};
  sample.states[1].orientation = Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitY());
  sample.states[1].velocity = {1, 0, 4};
  sample.states[1].angular_velocity = {0, 5, 6};
  return sample;
}

const double rounding = 1e-12;  // of a few sums of numbers up to 30

}  // namespace

TEST(PoseMessages, OdometryHasTheReferencePointsPoseInTheTankAndItsTwistInTheBody) {
  const PoseMessages messages(moving_box_case(), example_frames(moving_box_case()));
  const nav_msgs::Odometry odometry = messages.odometry(1, example_sample(0.25), StampClock());
  EXPECT_EQ(odometry.header.stamp, ros::Time(0.25));
  EXPECT_EQ(odometry.header.frame_id, "basin");
  EXPECT_EQ(odometry.child_frame_id, "basin/bodies/box");
  EXPECT_EQ(odometry.pose.pose.position.x, 1.8);
  EXPECT_EQ(odometry.pose.pose.position.z, 3.3);
  EXPECT_NEAR(odometry.pose.pose.orientation.y, std::sqrt(0.5), rounding);
  EXPECT_NEAR(odometry.pose.pose.orientation.w, std::sqrt(0.5), rounding);
  // The body's x points down and its z along the tank's x.
  EXPECT_NEAR(odometry.twist.twist.linear.x, -4.0, rounding);
  EXPECT_NEAR(odometry.twist.twist.linear.z, 1.0, rounding);
  EXPECT_NEAR(odometry.twist.twist.angular.x, -6.0, rounding);
  EXPECT_NEAR(odometry.twist.twist.angular.y, 5.0, rounding);
}

TEST(PoseMessages, AMovingTankIsSeenFromTheWorld) {
  const PoseMessages messages(moving_tank_case(), example_frames(moving_tank_case()));
  const nav_msgs::Odometry odometry = messages.odometry(0, example_sample(0.25), StampClock());
  EXPECT_EQ(odometry.header.frame_id, "world");
  EXPECT_EQ(odometry.child_frame_id, "basin");
  EXPECT_EQ(odometry.pose.pose.position.y, 20.0);
  EXPECT_NEAR(odometry.twist.twist.linear.x, 3.0, rounding) << "the tank's x points along the world's y";
  EXPECT_NEAR(odometry.twist.twist.angular.z, 2.0, rounding);
}

TEST(PoseMessages, AFreeTanksFrameStaysAtTheCasesOriginNotAtItsCentreOfMass) {
  Case example = moving_tank_case();
  example.tank.motion = Motion::free;
  const PoseMessages messages(example, body_frames(example, {{2, 0, 0}, {1.75, 2.5, 3.2}}));
  const nav_msgs::Odometry odometry = messages.odometry(0, example_sample(0.25), StampClock());
  // The origin lies 2 m from the centre of mass along the tank's −x, which points along the world's −y.
  EXPECT_NEAR(odometry.pose.pose.position.x, 10.0, rounding);
  EXPECT_NEAR(odometry.pose.pose.position.y, 18.0, rounding);
  // In the world it moves at (0, 3, 0) + (0, 0, 2) × (0, −2, 0) = (4, 3, 0).
  EXPECT_NEAR(odometry.twist.twist.linear.x, 3.0, rounding);
  EXPECT_NEAR(odometry.twist.twist.linear.y, -4.0, rounding);
}

TEST(PoseMessages, TransformsAgreeWithOdometry) {
  const PoseMessages messages(moving_tank_case(), example_frames(moving_tank_case()));
  const PoseSample sample = example_sample(0.25);
  const tf2_msgs::TFMessage transforms = messages.transforms(sample, StampClock());
  ASSERT_EQ(transforms.transforms.size(), 2U);
  for (std::size_t owner = 0; owner < 2; ++owner) {
    const geometry_msgs::TransformStamped& transform = transforms.transforms[owner];
    const nav_msgs::Odometry odometry = messages.odometry(owner, sample, StampClock());
    EXPECT_EQ(transform.header, odometry.header);
    EXPECT_EQ(transform.child_frame_id, odometry.child_frame_id);
    EXPECT_EQ(transform.transform.translation.x, odometry.pose.pose.position.x);
    EXPECT_EQ(transform.transform.translation.y, odometry.pose.pose.position.y);
    EXPECT_EQ(transform.transform.translation.z, odometry.pose.pose.position.z);
    EXPECT_EQ(transform.transform.rotation, odometry.pose.pose.orientation);
  }
}

TEST(PoseMessages, JointStatesAreNamedInTheCasesOrderAndOnlyOfJointsWithAPosition) {
  Case example = moving_box_case();
  const std::pair<const char*, JointType> joints_of_every_type[] = {{"weld", JointType::fixed},    {"flap hinge", JointType::hinge},
                                                                    {"ball", JointType::ball},     {"spring", JointType::spring},
                                                                    {"strut", JointType::six_dof}, {"rail", JointType::slider}};
  PoseSample sample = example_sample(0.5);
  for (const auto& [name, type] : joints_of_every_type) {
    example.joints.emplace_back();
    example.joints.back().name = name;
    example.joints.back().type = type;
    sample.joints.emplace_back();
  }
  sample.joints[1] = {0.1, 0.2, 0.3};
  sample.joints[3] = {1.0, 2.0, 3.0};
  sample.joints[5] = {10.0, 20.0, 30.0};
  const sensor_msgs::JointState joints = PoseMessages(example, example_frames(example)).joint_states(sample, StampClock());
  EXPECT_EQ(joints.header.stamp, ros::Time(0.5));
  EXPECT_EQ(joints.name, (std::vector<std::string>{"flap hinge", "spring", "rail"}));
  EXPECT_EQ(joints.position, (std::vector<double>{0.1, 1.0, 10.0}));
  EXPECT_EQ(joints.velocity, (std::vector<double>{0.2, 2.0, 20.0}));
  EXPECT_EQ(joints.effort, (std::vector<double>{0.3, 3.0, 30.0}));
}

TEST(PoseMessages, JointsThatAllHaveNoPositionHaveNoTopic) {
  Case example = moving_box_case();
  example.joints.resize(1);
  example.joints[0].type = JointType::ball;
  PoseSample sample = example_sample(0.0);
  sample.joints.resize(1);
  std::vector<std::string> topics;
  PoseMessages(example, example_frames(example))
      .emit(sample, StampClock(), [&topics](const std::string& topic, const ros::Time&, const auto&) { topics.push_back(topic); });
  EXPECT_EQ(topics, (std::vector<std::string>{"/tf", "bodies/box/odom"}));
}

TEST(PoseMessages, EverySampleGoesOutOnceWithItsOwnStamp) {
  Case example = moving_tank_case();
  example.joints.resize(1);
  const SampleMessages messages(example, example_layout(), example_frames(example));
  Samples samples;
  for (const double time : {0.0, 0.01, 0.02}) {
    samples.poses.push_back(example_sample(time));
    samples.poses.back().joints.resize(1);
  }
  StampClock clock;
  clock.restart_after(0.5);
  std::map<std::string, std::vector<ros::Time>> stamps;
  messages.emit(samples, clock,
                [&stamps](const std::string& topic, const ros::Time& stamp, const auto&) { stamps[topic].push_back(stamp); });
  const std::vector<ros::Time> three{ros::Time(1.0), ros::Time(1.01), ros::Time(1.02)};
  for (const char* topic : {"/tf", "bodies/tank/odom", "bodies/box/odom", "joint_states"}) EXPECT_EQ(stamps[topic], three) << topic;
  EXPECT_EQ(stamps.size(), 4U);
}

TEST(PoseMessages, FixedBodiesHaveNone) {
  const SampleMessages messages(moving_box_case(), example_layout(), example_frames(moving_box_case()));
  Samples samples;
  samples.poses.push_back(example_sample(0.0));
  std::vector<std::string> topics;
  messages.emit(samples, StampClock(), [&topics](const std::string& topic, const ros::Time&, const auto&) { topics.push_back(topic); });
  EXPECT_EQ(topics, (std::vector<std::string>{"/tf", "bodies/box/odom"})) << "nothing of the tank, no joints";
}

TEST(Frames, AMovingTanksParentIsTheWorldOrElseTheInertialFrame) {
  Case example = moving_tank_case();
  EXPECT_EQ(example_frames(example)[0].parent, "world");
  example.publishing.world_frame = "world";
  EXPECT_EQ(example_frames(example)[0].parent, "inertial");
  EXPECT_EQ(example_frames(example)[1].name, "world/bodies/box");
  EXPECT_EQ(example_frames(example)[1].parent, "world");
}

}  // namespace wavetank::pose_messages_test

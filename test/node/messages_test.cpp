#include "wavetank/node/messages.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <type_traits>

#include "example_case.h"
#include "wavetank/scene/case_reader.h"

namespace wavetank::messages_test {

using test::example_case;
using test::example_frames;
using test::example_layout;

TEST(SampleMessages, ProbesAreInGaugePascalsWithNamesAndPositions) {
  const SampleMessages messages(example_case(), example_layout(), example_frames());
  const ProbeArray array = messages.probes({0.25, {100.0, -7.5}}, StampClock());
  EXPECT_EQ(array.header.stamp, ros::Time(0.25));
  EXPECT_EQ(array.header.frame_id, "basin");
  EXPECT_EQ(array.names, (std::vector<std::string>{"P1", "P2"}));
  ASSERT_EQ(array.positions.size(), 2U);
  EXPECT_EQ(array.positions[1].x, 2.0);
  EXPECT_EQ(array.positions[1].y, 2.5);
  EXPECT_EQ(array.positions[1].z, 3.2);
  EXPECT_EQ(array.pressures, (std::vector<double>{100.0, -7.5}));
}

TEST(SampleMessages, FluidPressureAddsTheReferenceInTheProbesFrame) {
  const SampleMessages messages(example_case(), example_layout(), example_frames());
  const sensor_msgs::FluidPressure message = messages.probe(1, {0.25, {100.0, -7.5}}, StampClock());
  EXPECT_EQ(message.header.frame_id, "basin/probes/P2");
  EXPECT_EQ(message.header.stamp, ros::Time(0.25));
  EXPECT_DOUBLE_EQ(message.fluid_pressure, 101317.5);
  EXPECT_EQ(message.variance, 0.0);
}

TEST(SampleMessages, GaugesStandOnTheTanksLowestPoint) {
  const SampleMessages messages(example_case(), example_layout(), example_frames());
  const WaveGaugeArray array = messages.gauges({0.5, {3.4}}, StampClock());
  ASSERT_EQ(array.positions.size(), 1U);
  EXPECT_EQ(array.positions[0].x, 2.5);
  EXPECT_EQ(array.positions[0].z, 3.0);
  EXPECT_EQ(array.levels, (std::vector<double>{3.4}));
}

TEST(SampleMessages, AGaugesPointIsTheSurfaceOnItsLineToTheLastBit) {
  const LevelSample sample{0.5, {3.0 + 1.0 / 3}};
  Case example = example_case();
  const SampleMessages messages(example, example_layout(), example_frames());
  const geometry_msgs::PointStamped point = messages.gauge(0, sample, StampClock());
  EXPECT_EQ(point.header.stamp, ros::Time(0.5));
  EXPECT_EQ(point.header.frame_id, "basin");
  EXPECT_EQ(point.point.x, 2.5);
  EXPECT_EQ(point.point.y, 2.5);
  EXPECT_EQ(point.point.z, messages.gauges(sample, StampClock()).levels[0]);
  example.gravity = {9.81, 0, 0};
  const SampleMessages along_x(example, example_layout(), example_frames());
  EXPECT_EQ(along_x.gauge(0, {0.5, {1.25}}, StampClock()).point.x, 1.25) << "a level along x";
}

TEST(SampleMessages, VelocitiesAndSectionsHaveATopicEach) {
  Case example = example_case();
  example.instruments.velocity_probes = {{"V1", {2.5, 2.5, 3.1}}, {"V2", {2.5, 2.5, 3.9}}};
  example.instruments.sections = {{"gap", {2.5, 2.5, 3.2}, {1, 0, 0}}};
  const SampleMessages messages(example, example_layout(), example_frames());
  const Vector3d dry = Vector3d::Constant(std::nan(""));
  const VelocitySample velocities{0.25, {Vector3d(1, 2, 3), dry}};
  const geometry_msgs::Vector3Stamped wet = messages.velocity(0, velocities, StampClock());
  EXPECT_EQ(wet.header.stamp, ros::Time(0.25));
  EXPECT_EQ(wet.header.frame_id, "basin");
  EXPECT_EQ(wet.vector.y, 2.0);
  EXPECT_TRUE(std::isnan(messages.velocity(1, velocities, StampClock()).vector.z));
  const SectionFlow flow = messages.section(0, {0.5, {{0.02, 0.3}}}, StampClock());
  EXPECT_EQ(flow.header.stamp, ros::Time(0.5));
  EXPECT_EQ(flow.discharge, 0.02);
  EXPECT_EQ(flow.area, 0.3);
  Samples samples;
  samples.velocities = {velocities};
  samples.sections = {{0.5, {{0.02, 0.3}}}};
  std::vector<std::string> topics;
  messages.emit(samples, StampClock(), [&](const std::string& topic, const ros::Time&, const auto&) { topics.push_back(topic); });
  EXPECT_EQ(topics, (std::vector<std::string>{"velocities/V1", "velocities/V2", "sections/gap"}));
}

TEST(SampleMessages, AnImuSpeaksInItsOwnFrame) {
  Case example = test::moving_box_case();
  example.bodies[0].imu = ImuCase{Vector3d(1.5, 2.5, 3.5)};
  const SampleMessages messages(example, example_layout(), example_frames(example));
  ImuSample sample;
  sample.time = 0.5;
  sample.readings.resize(1);
  sample.readings[0].orientation = Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitY());
  sample.readings[0].angular_velocity = {1, 2, 3};
  sample.readings[0].specific_force = {-9.81, 0, 0};
  const sensor_msgs::Imu imu = messages.imu(0, sample, StampClock());
  EXPECT_EQ(imu.header.frame_id, "basin/bodies/box/imu");
  EXPECT_EQ(imu.header.stamp, ros::Time(0.5));
  EXPECT_NEAR(imu.orientation.y, std::sqrt(0.5), 1e-12);
  EXPECT_EQ(imu.angular_velocity.z, 3.0);
  EXPECT_EQ(imu.linear_acceleration.x, -9.81);
  const auto transforms = static_transforms(example, example_frames(example));
  EXPECT_EQ(transforms.back().header.frame_id, "basin/bodies/box");
  EXPECT_EQ(transforms.back().child_frame_id, "basin/bodies/box/imu");
  EXPECT_NEAR(transforms.back().transform.translation.x, -0.25, 1e-12);
  EXPECT_NEAR(transforms.back().transform.translation.z, 0.3, 1e-12);
  Samples samples;
  samples.imus = {sample};
  std::vector<std::string> topics;
  messages.emit(samples, StampClock(), [&](const std::string& topic, const ros::Time&, const auto&) { topics.push_back(topic); });
  EXPECT_EQ(topics, (std::vector<std::string>{"bodies/box/imu"}));
}

TEST(SampleMessages, MooringsTellTheirTensionAndAreDrawnTwentyTimesASecond) {
  Case example = test::moving_box_case();
  example.bodies[0].rigid.moorings.resize(2);
  example.bodies[0].rigid.moorings[1].name = "bow";
  const SampleMessages messages(example, example_layout(), example_frames(example));
  Samples samples;
  for (int k = 0; k < 100; ++k)
    samples.moorings.push_back({0.01 * k, {{1.0 * k, 2, 3, {Vector3d(1, 2, 3), Vector3d(2, 2, 4)}}, {5, 6, 0, {Vector3d(1, 2, 3)}}}});
  std::map<std::string, int> counts;
  messages.emit(samples, StampClock(), [&](const std::string& topic, const ros::Time& stamp, const auto& message) {
    ++counts[topic];
    if constexpr (std::is_same_v<std::decay_t<decltype(message)>, visualization_msgs::MarkerArray>) {
      ASSERT_EQ(message.markers.size(), 2U);
      for (const auto& line : message.markers) EXPECT_EQ(line.header.stamp, stamp);
      EXPECT_EQ(message.markers[0].ns, "moorings");
      EXPECT_EQ(message.markers[0].header.frame_id, "basin");
      ASSERT_EQ(message.markers[0].points.size(), 2U);
      EXPECT_EQ(message.markers[0].points[1].z, 4.0);
    }
  });
  EXPECT_EQ(counts, (std::map<std::string, int>{
                        {"bodies/box/moorings/0/tension", 100}, {"bodies/box/moorings/bow/tension", 100}, {"markers", 20}}));
  const MooringTension tension = messages.mooring(0, samples.moorings[7], StampClock());
  EXPECT_EQ(tension.header.frame_id, "basin/bodies/box");
  EXPECT_EQ(tension.tension, 7.0);
  EXPECT_EQ(tension.anchor_tension, 2.0);
  EXPECT_EQ(tension.lying, 3.0);
}

TEST(SampleMessages, WrenchesAreTheSumOfPressureAndViscousParts) {
  const SampleMessages messages(example_case(), example_layout(), example_frames());
  WrenchSample sample;
  sample.time = 0.5;
  sample.wrenches.resize(2);
  sample.wrenches[1].pressure_force = {1, 2, 3};
  sample.wrenches[1].viscous_force = {10, 20, 30};
  sample.wrenches[1].pressure_torque = {4, 5, 6};
  sample.wrenches[1].viscous_torque = {40, 50, 60};
  const auto total = messages.wrench(1, SampleMessages::Part::total, sample, StampClock());
  const auto pressure = messages.wrench(1, SampleMessages::Part::pressure, sample, StampClock());
  const auto viscous = messages.wrench(1, SampleMessages::Part::viscous, sample, StampClock());
  EXPECT_EQ(total.header.frame_id, "basin/bodies/box");
  EXPECT_EQ(total.wrench.force.y, 22.0);
  EXPECT_EQ(total.wrench.torque.z, 66.0);
  EXPECT_EQ(pressure.wrench.force.y, 2.0);
  EXPECT_EQ(viscous.wrench.torque.x, 40.0);
  EXPECT_EQ(messages.wrench(0, SampleMessages::Part::total, sample, StampClock()).header.frame_id, "basin");
}

TEST(SampleMessages, AFreeTanksWrenchIsMovedFromItsCentreOfMassToItsFramesOrigin) {
  Case example = example_case();
  example.tank.motion = Motion::free;
  const SampleMessages messages(example, example_layout(), body_frames(example, {{2, 0, 0}, {1.75, 2.5, 3.2}}));
  WrenchSample sample;
  sample.wrenches.resize(2);
  sample.wrenches[0].pressure_force = {0, 0, 3};
  sample.wrenches[0].pressure_torque = {0, 1, 0};
  sample.wrenches[0].viscous_force = {0, 5, 0};
  sample.wrenches[1].pressure_force = {0, 0, 7};
  const auto total = messages.wrench(0, SampleMessages::Part::total, sample, StampClock());
  EXPECT_EQ(total.header.frame_id, "basin");
  EXPECT_EQ(total.wrench.force.z, 3.0);
  EXPECT_EQ(total.wrench.torque.y, -5.0) << "1 − 2 · 3";
  EXPECT_EQ(total.wrench.torque.z, 10.0) << "2 · 5";
  EXPECT_EQ(messages.wrench(0, SampleMessages::Part::pressure, sample, StampClock()).wrench.torque.z, 0.0);
  EXPECT_EQ(messages.wrench(1, SampleMessages::Part::total, sample, StampClock()).wrench.torque.y, 0.0)
      << "a body's frame is at its reference";
}

TEST(SampleMessages, FlowsOfOpeningsHaveATopicEach) {
  Case example = example_case();
  example.openings.resize(2);
  example.openings[0].name = "hose";
  example.openings[1].name = "drain";
  const SampleMessages messages(example, example_layout(), example_frames(example));
  Samples samples;
  samples.flows = {{0.25, {{0.02, 0.5}, {-0.01, -0.25}}}, {0.5, {{0.03, 0.6}, {0, -0.25}}}};
  std::map<std::string, std::vector<OpeningFlow>> heard;
  messages.emit(samples, StampClock(), [&](const std::string& topic, const ros::Time& stamp, const auto& message) {
    if constexpr (std::is_same_v<std::decay_t<decltype(message)>, OpeningFlow>) {
      EXPECT_EQ(stamp, message.header.stamp);
      heard[topic].push_back(message);
    }
  });
  ASSERT_EQ(heard["openings/hose/flow"].size(), 2U);
  ASSERT_EQ(heard["openings/drain/flow"].size(), 2U);
  EXPECT_EQ(heard["openings/drain/flow"][0].discharge, -0.01);
  EXPECT_EQ(heard["openings/drain/flow"][0].volume, -0.25);
  EXPECT_EQ(heard["openings/hose/flow"][1].header.stamp, ros::Time(0.5));
  EXPECT_EQ(heard["openings/hose/flow"][1].header.frame_id, "basin");
  example.openings[1].name = "hose";
  EXPECT_THROW(SampleMessages(example, example_layout(), example_frames(example)), Error);
}

TEST(SampleMessages, EmitsEverySampleOnceOnEachTopic) {
  const SampleMessages messages(example_case(), example_layout(), example_frames());
  Samples samples;
  for (const double time : {0.0, 0.001, 0.002}) samples.pressures.push_back({time, {1.0, 2.0}});
  samples.levels.push_back({0.0, {3.1}});
  WrenchSample wrench;
  wrench.wrenches.resize(2);
  samples.wrenches.push_back(wrench);
  std::map<std::string, std::vector<ros::Time>> stamps;
  messages.emit(samples, StampClock(),
                [&stamps](const std::string& topic, const ros::Time& stamp, const auto&) { stamps[topic].push_back(stamp); });
  const std::vector<ros::Time> three{ros::Time(0.0), ros::Time(0.001), ros::Time(0.002)};
  EXPECT_EQ(stamps["probes"], three);
  EXPECT_EQ(stamps["probes/P1"], three);
  EXPECT_EQ(stamps["probes/P2"], three);
  for (const char* topic : {"gauges", "bodies/tank/wrench", "bodies/tank/wrench/pressure", "bodies/tank/wrench/viscous",
                            "bodies/box/wrench", "bodies/box/wrench/pressure", "bodies/box/wrench/viscous"})
    EXPECT_EQ(stamps[topic].size(), 1U) << topic;
  EXPECT_EQ(stamps["gauges/H1"].size(), 1U);
  EXPECT_EQ(stamps.size(), 11U);
}

TEST(Names, BecomeValidGraphNames) {
  EXPECT_EQ(probe_topic("bow 1-a"), "probes/bow_1_a");
  EXPECT_EQ(wrench_topic("box"), "bodies/box/wrench");
}

TEST(Names, ThatShareATopicAreRefused) {
  Case example = example_case();
  example.instruments.pressure_probes = {{"P 1", {0, 0, 0}}, {"P_1", {0, 0, 0}}};
  EXPECT_THROW(SampleMessages(example, example_layout(), example_frames()), Error);
  example = example_case();
  example.bodies[0].name = "tank";
  try {
    check_names(example);
    FAIL() << "a body named as the tank was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()),
              "body 'tank' and the tank would both publish on 'bodies/tank/wrench': give one of them another name");
  }
}

TEST(Names, OfMooringsThatShareATopicAreRefused) {
  Case example = example_case();
  MooringCase first, second;
  first.name = "1";  // as the second is called, which has no name
  example.bodies[0].rigid.moorings = {first, second};
  try {
    check_names(example);
    FAIL() << "two moorings of one topic were accepted";
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()),
              "mooring '1' of 'box' and mooring '1' of 'box' would both publish on 'bodies/box/moorings/1/tension': "
              "give one of them another name");
  }
}

TEST(StaticTransforms, PlaceProbesAndBodiesUnderTheWorldFrame) {
  const auto transforms = static_transforms(example_case(), example_frames());
  ASSERT_EQ(transforms.size(), 3U);
  for (const auto& transform : transforms) {
    EXPECT_EQ(transform.header.frame_id, "basin");
    EXPECT_EQ(transform.transform.rotation.w, 1.0);
  }
  EXPECT_EQ(transforms[0].child_frame_id, "basin/probes/P1");
  EXPECT_EQ(transforms[0].transform.translation.z, 3.1);
  EXPECT_EQ(transforms[2].child_frame_id, "basin/bodies/box");
  EXPECT_NEAR(transforms[2].transform.translation.x, 1.75, 1e-12);
  EXPECT_NEAR(transforms[2].transform.translation.z, 3.2, 1e-12);
}

TEST(StaticTransforms, LeaveOutWhatMoves) {
  const Case example = test::moving_box_case();
  const auto transforms = static_transforms(example, example_frames(example));
  ASSERT_EQ(transforms.size(), 2U);
  EXPECT_EQ(transforms[0].child_frame_id, "basin/probes/P1");
  EXPECT_EQ(transforms[1].child_frame_id, "basin/probes/P2");
}

TEST(StatusMessage, CarriesStateEnergiesAndRun) {
  SolverState solver;
  solver.time = 0.5;
  solver.step = 17;
  solver.particles = 4711;
  solver.guard_hits = 3;
  EnergySample energies;
  energies.kinetic = 1.5;
  energies.mass = 998.0;
  energies.damper_power = 0.125;
  RunState run;
  run.phase = SolverStatus::RUNNING;
  run.device = "a device";
  run.real_time_factor = 0.25;
  const SolverStatus status = status_message(example_case(), solver, energies, run, StampClock());
  EXPECT_EQ(status.header.stamp, ros::Time(0.5));
  EXPECT_EQ(status.header.frame_id, "basin");
  EXPECT_EQ(status.title, "an example");
  EXPECT_EQ(status.device, "a device");
  EXPECT_EQ(status.phase, SolverStatus::RUNNING);
  EXPECT_EQ(status.step, 17U);
  EXPECT_EQ(status.particles, 4711U);
  EXPECT_EQ(status.kinetic_energy, 1.5);
  EXPECT_EQ(status.mass, 998.0);
  EXPECT_EQ(status.damper_power, 0.125);
  EXPECT_EQ(status.real_time_factor, 0.25);
  EXPECT_EQ(status.guard_hits, 3U);
  EXPECT_EQ(status.duration, 2.0);
}

}  // namespace wavetank::messages_test

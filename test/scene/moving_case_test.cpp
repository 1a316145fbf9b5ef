#include <gtest/gtest.h>

#include <cmath>

#include "../common/scratch_directory.h"
#include "wavetank/scene/case_reader.h"

namespace wavetank::moving_case_test {

namespace {

const double pi = std::acos(-1.0);

// Every key of what moves, with a value that is not its default.
const char* const everything = R"(duration: 2
fluid: {spacing: 0.1, fill: [{box: {min: [0, 0, 0], max: [1, 1, 1]}}]}
tank:
  box: {size: [2, 1, 2]}
  motion: prescribed
  mass: 50
  centre_of_mass: [1, 0.5, 0.8]
  friction: 0.1
  restitution: 0.2
  collision: parts
  collision_parts: [{mesh: parts/floor.stl, scale: 0.001, translation: [1, 2, 3], rotation: [90, -45, 30]}, {mesh: "package://walls/wall.stl"}]
  prescribed:
    point: [1, 0.5, 0]
    axis: [1, 1, 0]
    harmonics:
      - {direction: roll, amplitude: 5, frequency: 0.7, phase: 90, rise: 2}
      - {direction: sway, amplitude: 0.05, frequency: 0.3}
    ramps: [{direction: stroke, change: -0.2, from: 0.5, to: 1.5}, {direction: angle, change: 720, to: 3}]
    records:
      - {file: motions/ship.csv, time_column: t, column: z, direction: heave, factor: -0.001, delay: 1.5}
      - {file: "package://waves/all.csv"}
      - {file: yaw.csv, column: yaw}
bodies:
  - name: hull
    mesh: hull.stl
    motion: free
    density: 400
    centre_of_mass: [1, 0.5, 0.6]
    inertia: [1, 2, 2.5, 0.1, 0.2, 0.3]
    velocity: [0.1, 0.2, 0.3]
    angular_velocity: [0.4, 0.5, 0.6]
    friction: 0.3
    restitution: 0.7
    collision: decomposition
    forces:
      - {force: [1, 2, 3], torque: [4, 5, 6], point: [7, 8, 9], turns_with_body: true, from: 1, to: 2, frequency: 3, phase: 45}
      - {torque: [0, 0, 1]}
    moorings:
      - {anchor: [0, 1, 2], attachment: [3, 4, 5], stiffness: 6, damping: 7, length: 8, slack: false}
      - {anchor: [0, 1, 2], attachment: [3, 4, 6], stiffness: 6}
      - {name: bow, line: catenary, anchor: [0, 1, 2], attachment: [3, 4, 6], length: 7, weight: 20, axial_stiffness: 1e5, bed: false}
    wind: {velocity: [8, 1, 0], area: 3, centre: [1, 0.5, 1.2], drag_coefficient: 1.1, density: 1.2, gust_intensity: 0.15, gust_time: 5, seed: 7}
    imu: true
  - name: paddle
    box: {min: [0.1, 0.1, 0.1], max: [0.2, 0.9, 1]}
    motion: commanded
    collision: none
    command: {greatest_speed: 2, greatest_angular_speed: 3, greatest_acceleration: none, greatest_angular_acceleration: 5, timeout: 0}
  - {name: buoy, box: {min: [0.5, 0.1, 0.1], max: [0.6, 0.9, 1]}, motion: free, mass: 3, collision: convex_hull, imu: [0.5, 0.1, 1]}
  - {name: pier, box: {min: [1.5, 0.1, 0.1], max: [1.6, 0.9, 1]}, imu: false, surface_velocity: [1, 0, 0]}
joints:
  - {name: a, type: fixed, child: hull}
  - {name: b, type: hinge, parent: tank, child: hull, point: [1, 2, 3], axis: [0, 0, 2], limits: [-30, 60], stiffness: 4, damping: 5,
     command: {quantity: velocity, greatest_effort: 10, greatest_velocity: 2, timeout: 1}}
  - {name: c, type: slider, parent: paddle, child: hull, axis: [1, 0, 0], limits: [-0.3, 0.6], stiffness: 6, damping: 7, command: {}}
  - {name: d, type: ball, parent: hull, child: buoy, point: [1, 2, 3]}
  - {name: e, type: spring, parent: hull, child: buoy, point: [1, 2, 3], parent_point: [4, 5, 6], stiffness: 7, damping: 8, length: 9}
  - {name: f, type: six_dof, child: buoy, point: [1, 2, 3],
     six_limits: {surge: [-1, 1], sway: [0, 0], heave: [0, 2], roll: [-90, 90], yaw: [0, 45]}}
instruments: {pose_rate: 25, imu_rate: 200}
)";

void expect_close(const Vector3d& value, const Vector3d& expected) {
  EXPECT_LT((value - expected).norm(), 1e-14) << value.transpose() << " is not " << expected.transpose();
}

using Limits = std::array<double, 2>;

void expect_limits(const std::optional<Limits>& limits, double low, double high) {
  ASSERT_TRUE(limits);
  EXPECT_DOUBLE_EQ((*limits)[0], low);
  EXPECT_DOUBLE_EQ((*limits)[1], high);
}

void expect_prescribed(const PrescribedCase& prescribed, const std::string& folder) {
  ASSERT_TRUE(prescribed.point);
  expect_close(*prescribed.point, {1, 0.5, 0});
  expect_close(prescribed.axis, {1, 1, 0});
  ASSERT_EQ(prescribed.harmonics.size(), 2u);
  EXPECT_EQ(prescribed.harmonics[0].direction, Direction::roll);
  EXPECT_DOUBLE_EQ(prescribed.harmonics[0].amplitude, pi / 36);
  EXPECT_DOUBLE_EQ(prescribed.harmonics[0].frequency, 0.7);
  EXPECT_DOUBLE_EQ(prescribed.harmonics[0].phase, pi / 2);
  EXPECT_DOUBLE_EQ(prescribed.harmonics[0].rise, 2);
  EXPECT_EQ(prescribed.harmonics[1].direction, Direction::sway);
  EXPECT_DOUBLE_EQ(prescribed.harmonics[1].amplitude, 0.05);
  ASSERT_EQ(prescribed.ramps.size(), 2u);
  EXPECT_EQ(prescribed.ramps[0].direction, Direction::stroke);
  EXPECT_DOUBLE_EQ(prescribed.ramps[0].change, -0.2);
  EXPECT_DOUBLE_EQ(prescribed.ramps[0].from, 0.5);
  EXPECT_DOUBLE_EQ(prescribed.ramps[0].to, 1.5);
  EXPECT_DOUBLE_EQ(prescribed.ramps[1].change, 4 * pi);
  ASSERT_EQ(prescribed.records.size(), 3u);
  EXPECT_EQ(prescribed.records[0].file, folder + "motions/ship.csv");
  EXPECT_EQ(prescribed.records[0].time_column, "t");
  EXPECT_EQ(prescribed.records[0].column, "z");
  EXPECT_EQ(prescribed.records[0].direction, Direction::heave);
  EXPECT_DOUBLE_EQ(prescribed.records[0].factor, -0.001);
  EXPECT_DOUBLE_EQ(prescribed.records[0].delay, 1.5);
  EXPECT_EQ(prescribed.records[1].file, "package://waves/all.csv");
  EXPECT_EQ(prescribed.records[1].column, "");
  EXPECT_EQ(prescribed.records[2].column, "yaw");
  EXPECT_FALSE(prescribed.records[2].direction);
}

void expect_tank(const TankCase& tank, const std::string& folder) {
  EXPECT_EQ(tank.motion, Motion::prescribed);
  EXPECT_EQ(tank.rigid.mass, 50);
  expect_close(tank.rigid.centre_of_mass.value(), {1, 0.5, 0.8});
  EXPECT_DOUBLE_EQ(tank.rigid.friction, 0.1);
  EXPECT_DOUBLE_EQ(tank.rigid.restitution, 0.2);
  EXPECT_EQ(tank.rigid.collision, CollisionShape::parts);
  ASSERT_EQ(tank.rigid.collision_parts.size(), 2u);
  EXPECT_EQ(tank.rigid.collision_parts[0].uri, folder + "parts/floor.stl");
  EXPECT_EQ(tank.rigid.collision_parts[0].scale, Vector3d::Constant(0.001));
  expect_close(tank.rigid.collision_parts[0].translation, {1, 2, 3});
  expect_close(tank.rigid.collision_parts[0].rotation, {pi / 2, -pi / 4, pi / 6});
  EXPECT_EQ(tank.rigid.collision_parts[1].uri, "package://walls/wall.stl");
  expect_prescribed(tank.rigid.prescribed, folder);
}

void expect_loads(const RigidCase& hull) {
  ASSERT_EQ(hull.forces.size(), 2u);
  const ForceCase& force = hull.forces[0];
  expect_close(force.force, {1, 2, 3});
  expect_close(force.torque, {4, 5, 6});
  expect_close(force.point.value(), {7, 8, 9});
  EXPECT_TRUE(force.turns_with_body);
  EXPECT_DOUBLE_EQ(force.from, 1);
  EXPECT_EQ(force.to, 2);
  EXPECT_DOUBLE_EQ(force.frequency, 3);
  EXPECT_DOUBLE_EQ(force.phase, pi / 4);
  EXPECT_FALSE(hull.forces[1].point);
  EXPECT_FALSE(hull.forces[1].to);
  ASSERT_EQ(hull.moorings.size(), 3u);
  const MooringCase& mooring = hull.moorings[0];
  expect_close(mooring.anchor, {0, 1, 2});
  expect_close(mooring.attachment, {3, 4, 5});
  EXPECT_DOUBLE_EQ(mooring.stiffness, 6);
  EXPECT_DOUBLE_EQ(mooring.damping, 7);
  EXPECT_EQ(mooring.length, 8);
  EXPECT_FALSE(mooring.slack);
  EXPECT_FALSE(hull.moorings[1].length);
  EXPECT_TRUE(hull.moorings[1].slack);
  EXPECT_EQ(hull.moorings[1].name, "");
  const MooringCase& catenary = hull.moorings[2];
  EXPECT_EQ(catenary.name, "bow");
  EXPECT_EQ(catenary.line, MooringLine::catenary);
  EXPECT_EQ(catenary.length, 7);
  EXPECT_DOUBLE_EQ(catenary.weight, 20);
  EXPECT_EQ(catenary.axial_stiffness, 1e5);
  EXPECT_FALSE(catenary.bed);
  ASSERT_TRUE(hull.wind);
  expect_close(hull.wind->velocity, {8, 1, 0});
  EXPECT_DOUBLE_EQ(hull.wind->area, 3);
  expect_close(hull.wind->centre.value(), {1, 0.5, 1.2});
  EXPECT_DOUBLE_EQ(hull.wind->drag_coefficient, 1.1);
  EXPECT_DOUBLE_EQ(hull.wind->density, 1.2);
  EXPECT_DOUBLE_EQ(hull.wind->gust_intensity, 0.15);
  EXPECT_DOUBLE_EQ(hull.wind->gust_time, 5);
  EXPECT_EQ(hull.wind->seed, 7);
}

void expect_bodies(const std::vector<BodyCase>& bodies) {
  ASSERT_EQ(bodies.size(), 4u);
  const RigidCase& hull = bodies[0].rigid;
  EXPECT_EQ(bodies[0].motion, Motion::free);
  EXPECT_FALSE(hull.mass);
  EXPECT_EQ(hull.density, 400);
  expect_close(hull.centre_of_mass.value(), {1, 0.5, 0.6});
  EXPECT_EQ(hull.inertia, (std::array<double, 6>{1, 2, 2.5, 0.1, 0.2, 0.3}));
  expect_close(hull.velocity, {0.1, 0.2, 0.3});
  expect_close(hull.angular_velocity, {0.4, 0.5, 0.6});
  EXPECT_DOUBLE_EQ(hull.friction, 0.3);
  EXPECT_DOUBLE_EQ(hull.restitution, 0.7);
  EXPECT_EQ(hull.collision, CollisionShape::decomposition);
  expect_loads(hull);
  const CommandCase& command = bodies[1].rigid.command;
  EXPECT_EQ(bodies[1].motion, Motion::commanded);
  EXPECT_EQ(bodies[1].rigid.collision, CollisionShape::none);
  EXPECT_EQ(command.greatest_speed, 2);
  EXPECT_EQ(command.greatest_angular_speed, 3);
  EXPECT_FALSE(command.greatest_acceleration);
  EXPECT_EQ(command.greatest_angular_acceleration, 5);
  EXPECT_EQ(command.timeout, 0);
  EXPECT_EQ(bodies[2].rigid.mass, 3);
  EXPECT_FALSE(bodies[2].rigid.density);
  EXPECT_EQ(bodies[2].rigid.collision, CollisionShape::convex_hull);
  EXPECT_EQ(bodies[3].motion, Motion::fixed);
  ASSERT_TRUE(bodies[0].imu);
  EXPECT_FALSE(bodies[0].imu->position);
  EXPECT_FALSE(bodies[1].imu);
  ASSERT_TRUE(bodies[2].imu);
  expect_close(bodies[2].imu->position.value(), {0.5, 0.1, 1});
  EXPECT_FALSE(bodies[3].imu);
}

void expect_joints(const std::vector<JointCase>& joints) {
  ASSERT_EQ(joints.size(), 6u);
  const JointType types[] = {JointType::fixed, JointType::hinge, JointType::slider, JointType::ball, JointType::spring, JointType::six_dof};
  for (std::size_t j = 0; j < 6; ++j) EXPECT_EQ(joints[j].type, types[j]) << joints[j].name;
  EXPECT_EQ(joints[0].name, "a");
  EXPECT_EQ(joints[0].parent, "world");
  EXPECT_EQ(joints[0].child, "hull");
  EXPECT_EQ(joints[1].parent, "tank");
  expect_close(joints[1].point, {1, 2, 3});
  expect_close(joints[1].axis, {0, 0, 2});
  expect_limits(joints[1].limits, -pi / 6, pi / 3);
  EXPECT_DOUBLE_EQ(joints[1].stiffness, 4);
  EXPECT_DOUBLE_EQ(joints[1].damping, 5);
  ASSERT_TRUE(joints[1].command);
  EXPECT_EQ(joints[1].command->quantity, JointQuantity::velocity);
  EXPECT_EQ(joints[1].command->greatest_effort, 10);
  EXPECT_EQ(joints[1].command->greatest_velocity, 2);
  EXPECT_DOUBLE_EQ(joints[1].command->timeout, 1);
  ASSERT_TRUE(joints[2].command);
  EXPECT_EQ(joints[2].command->quantity, JointQuantity::effort);
  EXPECT_FALSE(joints[2].command->greatest_effort);
  EXPECT_FALSE(joints[3].command);
  expect_limits(joints[2].limits, -0.3, 0.6);
  EXPECT_FALSE(joints[3].limits);
  expect_close(joints[4].parent_point.value(), {4, 5, 6});
  EXPECT_EQ(joints[4].length, 9);
  expect_limits(joints[5].six_limits[0], -1, 1);
  expect_limits(joints[5].six_limits[1], 0, 0);
  expect_limits(joints[5].six_limits[2], 0, 2);
  expect_limits(joints[5].six_limits[3], -pi / 2, pi / 2);
  EXPECT_FALSE(joints[5].six_limits[4]);
  expect_limits(joints[5].six_limits[5], 0, pi / 4);
}

void expect_everything(const Case& read, const std::string& folder) {
  expect_tank(read.tank, folder);
  expect_bodies(read.bodies);
  expect_joints(read.joints);
  EXPECT_EQ(read.instruments.pose_rate, 25);
  EXPECT_EQ(read.instruments.imu_rate, 200);
}

}  // namespace

TEST(MovingCase, ReadsEveryKey) { expect_everything(read_case_text(everything, "everything"), ""); }

TEST(MovingCase, WritesWhatItReads) {
  const ScratchDirectory scratch;
  for (const char* file : {"hull.stl", "yaw.csv", "parts/floor.stl", "motions/ship.csv"}) scratch.write(file, "something");
  Case read = read_case_text(everything, "everything");
  read.directory = scratch.path();
  const std::string written = write_case(read);
  const Case again = read_case_text(written, "written");
  expect_everything(again, scratch.file(""));
  EXPECT_EQ(write_case(again), written);
}

TEST(MovingCase, FillsInTheStructsDefaults) {
  const Case read = read_case_text(R"(duration: 2
fluid: {spacing: 0.1, fill: [{box: {min: [0, 0, 0], max: [1, 1, 1]}}]}
tank: {box: {size: [2, 1, 2]}, motion: free, mass: 5, centre_of_mass: [1, 0.5, 1], inertia: [1, 1, 1, 0, 0, 0]}
bodies:
  - {name: paddle, box: {min: [0.1, 0.1, 0.1], max: [0.2, 0.9, 1]}, motion: commanded}
joints:
  - {name: rail, type: slider, child: tank}
)",
                                   "defaults");
  const RigidCase defaults;
  EXPECT_FALSE(read.bodies[0].rigid.centre_of_mass);
  EXPECT_FALSE(read.bodies[0].rigid.inertia);
  EXPECT_EQ(read.tank.rigid.friction, defaults.friction);
  EXPECT_EQ(read.bodies[0].rigid.command.greatest_acceleration, defaults.command.greatest_acceleration);
  EXPECT_EQ(read.joints[0].axis, JointCase{}.axis);
  EXPECT_FALSE(read.instruments.pose_rate);
  const std::string written = write_case(read);
  EXPECT_EQ(write_case(read_case_text(written, "written")), written);
  for (const char* line : {"greatest_speed: none", "greatest_acceleration: 1\n", "pose_rate: auto", "parent: world", "timeout: 0.5"}) {
    EXPECT_NE(written.find(line), std::string::npos) << line;
  }
}

TEST(MovingCase, APeriodicTankMayMoveWithoutTurning) {
  const Case read = read_case_text(R"(duration: 2
fluid: {spacing: 0.1, fill: [{box: {min: [0, 0, 0], max: [1, 1, 1]}}]}
tank: {box: {size: [2, 1, 2]}, periodic: [x], motion: prescribed,
       prescribed: {harmonics: [{direction: surge, amplitude: 1, frequency: 1}], records: [{file: a.csv, column: sway}]}}
)",
                                   "periodic");
  EXPECT_TRUE(read.tank.periodic[0]);
}

TEST(MovingCase, FlatVectorsLieInTheXZPlane) {
  const Case read = read_case_text(R"(dimensions: 2
gravity: [0, -9.81]
duration: 2
fluid: {spacing: 0.1, fill: [{box: {min: [0, 0], max: [1, 1]}}]}
tank: {box: {size: [2, 2]}, motion: prescribed,
       prescribed: {point: [1, 0.5], axis: [1, 1], ramps: [{direction: stroke, change: 0.1, to: 1}, {direction: pitch, change: 9, to: 1}]}}
bodies:
  - {name: hull, box: {min: [1, 0.5], max: [1.5, 0.7]}, motion: free, mass: 100, centre_of_mass: [1.2, 7, 0.6], inertia: 2,
     velocity: [1, 2], angular_velocity: 0.1, forces: [{force: [3, 4], torque: 5, point: [6, 7]}, {torque: [0, 8, 0]}],
     moorings: [{anchor: [0, 1], attachment: [1, 2], stiffness: 1}]}
joints:
  - {name: rail, type: slider, child: hull, axis: [0, 1], limits: [0, 1]}
  - {name: strut, type: six_dof, parent: tank, child: hull, point: [1, 2], six_limits: {surge: [0, 1], heave: [0, 1], pitch: [0, 90]}}
)",
                                   "flat");
  const PrescribedCase& prescribed = read.tank.rigid.prescribed;
  EXPECT_EQ(prescribed.point.value(), Vector3d(1, 0, 0.5));
  EXPECT_EQ(prescribed.axis, Vector3d(1, 0, 1));
  EXPECT_DOUBLE_EQ(prescribed.ramps[0].change, 0.1);
  EXPECT_DOUBLE_EQ(prescribed.ramps[1].change, pi / 20);
  const RigidCase& hull = read.bodies[0].rigid;
  EXPECT_EQ(hull.centre_of_mass.value(), Vector3d(1.2, 0, 0.6));
  EXPECT_EQ(hull.inertia.value()[1], 2);
  EXPECT_EQ(hull.velocity, Vector3d(1, 0, 2));
  EXPECT_EQ(hull.angular_velocity, Vector3d(0, 0.1, 0));
  EXPECT_EQ(hull.forces[0].force, Vector3d(3, 0, 4));
  EXPECT_EQ(hull.forces[0].torque, Vector3d(0, 5, 0));
  EXPECT_EQ(hull.forces[0].point.value(), Vector3d(6, 0, 7));
  EXPECT_EQ(hull.forces[1].torque, Vector3d(0, 8, 0));
  EXPECT_EQ(hull.moorings[0].attachment, Vector3d(1, 0, 2));
  EXPECT_EQ(read.joints[0].axis, Vector3d(0, 0, 1));
  expect_limits(read.joints[1].six_limits[4], 0, pi / 2);
  EXPECT_EQ(write_case(read_case_text(write_case(read), "written")), write_case(read));
}

TEST(MovingCase, OverridesReachEveryKey) {
  const Case read = read_case_text(everything, "everything",
                                   {{"tank/prescribed/harmonics/0/amplitude", "10"},
                                    {"tank/prescribed/harmonics/2", "{direction: pitch, amplitude: 1, frequency: 1}"},
                                    {"bodies/0/inertia/0", "1.5"},
                                    {"bodies/1/command/greatest_speed", "none"},
                                    {"joints/1/limits/1", "90"}});
  EXPECT_DOUBLE_EQ(read.tank.rigid.prescribed.harmonics[0].amplitude, pi / 18);
  EXPECT_EQ(read.tank.rigid.prescribed.harmonics.at(2).direction, Direction::pitch);
  EXPECT_EQ(read.bodies[0].rigid.inertia.value()[0], 1.5);
  EXPECT_FALSE(read.bodies[1].rigid.command.greatest_speed);
  expect_limits(read.joints[1].limits, -pi / 6, pi / 2);
}

}  // namespace wavetank::moving_case_test

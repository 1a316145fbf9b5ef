#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <filesystem>

#include "../common/scratch_directory.h"
#include "broken_case.h"

namespace wavetank::robot_test {
namespace {

// Angles go through sines and cosines, and inertias through two rotations: a few roundings of numbers of the order of 1.
constexpr double rounding = 1e-12;

const std::string arm_file = std::string(WAVETANK_SOURCE_DIRECTORY) + "/test/scene/paddle_arm.urdf";

std::string case_with(const std::string& robots, const std::string& more = "") {
  return "duration: 1\nfluid: {spacing: 0.1, fill: [{box: {min: [0, 0, 0], max: [1, 1, 1]}}]}\ntank: {box: {size: [5, 5, 5]}}\nrobots:\n  "
         "- " +
         robots + "\n" + more;
}

/// A robot's text instead of a file.
Surroundings holding(const std::string& urdf) {
  return {{}, [urdf](const std::string&) { return urdf; }};
}

Case read_robot(const std::string& urdf, const std::string& keys = "") {
  return read_case_text(case_with("{parameter: robot_description" + keys + "}"), "case.yaml", {}, holding(urdf));
}

const BodyCase& body(const Case& read, const std::string& name) {
  for (const BodyCase& candidate : read.bodies) {
    if (candidate.name == name) return candidate;
  }
  throw std::logic_error("there is no body " + name);
}

const JointCase& joint(const Case& read, const std::string& name) {
  for (const JointCase& candidate : read.joints) {
    if (candidate.name == name) return candidate;
  }
  throw std::logic_error("there is no joint " + name);
}

const MeshSource& mesh(const Case& read, const std::string& name) { return std::get<MeshSource>(body(read, name).shape); }

void expect_close(const Vector3d& is, const Vector3d& should_be) {
  EXPECT_LT((is - should_be).norm(), rounding) << is.transpose() << ", not " << should_be.transpose();
}

void expect_inertia(const BodyCase& body, const std::array<double, 6>& should_be) {
  ASSERT_TRUE(body.rigid.inertia);
  for (int k = 0; k < 6; ++k) EXPECT_NEAR((*body.rigid.inertia)[k], should_be[k], rounding) << body.name << " " << k;
}

/// Turned by a quarter about z: its x is the case's y, its y the case's −x.
Case turned_arm(const std::string& more = "") {
  return read_case_text(case_with("{urdf: " + arm_file + ", position: [1, 2, 3], rotation: [0, 0, 90]}", more), "case.yaml");
}

std::string box_link(const std::string& name, const std::string& inertial) {
  return "<link name=\"" + name + "\">" + inertial + "<collision><geometry><box size=\"1 1 1\"/></geometry></collision></link>";
}

std::string inertial(double mass, const std::string& xyz) {
  return "<inertial><origin xyz=\"" + xyz + "\"/><mass value=\"" + std::to_string(mass) +
         "\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>";
}

std::string joint_text(const std::string& name, const std::string& type, const std::string& parent, const std::string& child,
                       const std::string& more = "") {
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent + "\"/><child link=\"" + child + "\"/>" + more +
         "</joint>";
}

std::string robot(const std::string& parts) { return "<robot name=\"r\">" + parts + "</robot>"; }

TEST(Robot, LinksWithAShapeBecomeBodies) {
  const Case read = turned_arm();
  ASSERT_EQ(read.bodies.size(), 4u);  // neither the footprint nor the sensor
  for (const std::string name : {"base", "arm", "paddle", "buoy"}) EXPECT_EQ(body(read, name).motion, Motion::free) << name;
  EXPECT_TRUE(read.robots.empty());
}

TEST(Robot, MassesAndInertiasAreInTheCasesAxes) {
  const Case read = turned_arm();
  // 4 kg at z = 0.1 m and the sensor's 1 kg at 0.6 m: the centre at 0.2 m; xx = 0.1 + 4 · 0.1² + 0.01 + 1 · 0.4² = 0.31 and likewise
  // yy = 0.41, zz = 0.31 in its own axes, of which x and y change places.
  EXPECT_NEAR(*body(read, "base").rigid.mass, 5, rounding);
  expect_close(*body(read, "base").rigid.centre_of_mass, {1, 2, 3.2});
  expect_inertia(body(read, "base"), {0.41, 0.31, 0.31, 0, 0, 0});
  // A quarter for the robot, one for the joint and one for the inertial's own axes: −90° in all, under which xy changes its sign.
  EXPECT_NEAR(*body(read, "arm").rigid.mass, 2, rounding);
  expect_close(*body(read, "arm").rigid.centre_of_mass, {1, 2.2, 2.85});
  expect_inertia(body(read, "arm"), {0.04, 0.03, 0.05, -0.001, 0, 0});
  expect_close(*body(read, "paddle").rigid.centre_of_mass, {1, 2.2, 2.6});
  expect_inertia(body(read, "paddle"), {0.001, 0.002, 0.003, 0, 0, 0});
  expect_close(*body(read, "buoy").rigid.centre_of_mass, {1.5, 2, 3});
}

TEST(Robot, ShapesAreThoseThatCollideOrElseAreSeen) {
  const Case read = turned_arm();
  EXPECT_EQ(mesh(read, "base").uri, "shape://box?size=0.4,0.2,0.2");
  expect_close(mesh(read, "base").translation, {1, 2, 3.1});
  expect_close(mesh(read, "base").rotation, {0, 0, M_PI / 2});
  EXPECT_EQ(mesh(read, "arm").uri, "shape://cylinder?radius=0.02&length=0.5");
  expect_close(mesh(read, "arm").translation, {1, 2.2, 2.85});
  EXPECT_NEAR(std::abs(mesh(read, "arm").rotation.z()), M_PI, rounding);
  EXPECT_EQ(mesh(read, "buoy").uri, "shape://sphere?radius=0.15");
  const MeshSource& paddle = mesh(read, "paddle");
  EXPECT_EQ(paddle.uri, "package://wavetank/meshes/sphere.stl");
  EXPECT_EQ(paddle.scale, Vector3d::Constant(0.5));
  expect_close(paddle.translation, {0.99, 2.2, 2.5});
  // Pitched by 90°, where roll and yaw are one: its x points down, its y to −y as the arm's does.
  const Eigen::Matrix3d turn =
      (Eigen::AngleAxisd(paddle.rotation.z(), Vector3d::UnitZ()) * Eigen::AngleAxisd(paddle.rotation.y(), Vector3d::UnitY()) *
       Eigen::AngleAxisd(paddle.rotation.x(), Vector3d::UnitX()))
          .toRotationMatrix();
  // The pitch's arcsine near 1 has half of the digits.
  EXPECT_LT((turn.col(0) - Vector3d(0, 0, -1)).norm(), 1e-7) << turn;
  EXPECT_LT((turn.col(1) - Vector3d(0, -1, 0)).norm(), 1e-7) << turn;
}

std::string mesh_link(const std::string& name, const std::string& mesh) {
  return "<link name=\"" + name + "\">" + inertial(1, "0 0 0") + "<collision><geometry><mesh " + mesh + "/></geometry></collision></link>";
}

TEST(Robot, MeshesAreNamedRelativeToItsFile) {
  const ScratchDirectory scratch;
  std::filesystem::create_directories(scratch.path() / "robots/meshes");
  const std::string urdf = scratch.write(
      "robots/pair.urdf", robot(mesh_link("near", "filename=\"near.stl\"") + mesh_link("below", "filename=\"meshes/below.stl\"") +
                                mesh_link("beside", "filename=\"../beside.stl\"") + mesh_link("absolute", "filename=\"/a/b.stl\"") +
                                mesh_link("packed", "filename=\"package://p/b.stl\"") + joint_text("a", "fixed", "near", "below") +
                                joint_text("b", "fixed", "near", "beside") + joint_text("c", "fixed", "near", "absolute") +
                                joint_text("d", "fixed", "near", "packed")));
  const std::string file = scratch.write("case.yaml", case_with("{urdf: robots/pair.urdf}"));
  const std::string directory = scratch.path().string();
  for (const std::string case_text : {"", "by its absolute name"}) {
    const Case read =
        case_text.empty() ? read_case_file(file) : read_case_text(case_with("{urdf: \"" + urdf + "\"}"), "case.yaml");  // of no file
    EXPECT_EQ(mesh(read, "near").uri, directory + "/robots/near.stl");
    EXPECT_EQ(mesh(read, "below").uri, directory + "/robots/meshes/below.stl");
    EXPECT_EQ(mesh(read, "beside").uri, directory + "/beside.stl");
    EXPECT_EQ(mesh(read, "absolute").uri, "/a/b.stl");
    EXPECT_EQ(mesh(read, "packed").uri, "package://p/b.stl");
  }
}

TEST(Robot, MeshesAreMirroredAndStretched) {
  const std::string file = "filename=\"package://p/a.stl\"";
  const Case read =
      read_robot(robot(mesh_link("left", file + " scale=\"0.001 0.001 0.001\"") +
                       mesh_link("right", file + " scale=\"0.001 -0.001 0.001\"") + mesh_link("flat", file + " scale=\"2 3 0.5\"") +
                       joint_text("a", "fixed", "left", "right") + joint_text("b", "fixed", "left", "flat")));
  EXPECT_EQ(mesh(read, "left").scale, Vector3d::Constant(0.001));
  EXPECT_EQ(mesh(read, "right").scale, Vector3d(0.001, -0.001, 0.001));
  EXPECT_EQ(mesh(read, "flat").scale, Vector3d(2, 3, 0.5));
  const Case again = read_case_text(write_case(read), "written");
  EXPECT_EQ(mesh(again, "left").scale, Vector3d::Constant(0.001));
  EXPECT_EQ(mesh(again, "right").scale, Vector3d(0.001, -0.001, 0.001));
}

TEST(Robot, JointsHaveTheirNamesPlacesAndAxes) {
  const Case read = turned_arm();
  ASSERT_EQ(read.joints.size(), 3u);
  const JointCase& shoulder = joint(read, "shoulder");
  EXPECT_EQ(shoulder.type, JointType::hinge);
  EXPECT_EQ(shoulder.parent, "base");
  EXPECT_EQ(shoulder.child, "arm");
  expect_close(shoulder.point, {1, 2.2, 3.1});
  expect_close(shoulder.axis, {-1, 0, 0});  // along the arm's x, which two quarters have turned round
  ASSERT_TRUE(shoulder.limits);
  EXPECT_EQ((*shoulder.limits)[0], -1);
  EXPECT_EQ((*shoulder.limits)[1], 0.5);
  EXPECT_EQ(shoulder.damping, 0.3);
  const JointCase& rod = joint(read, "rod");
  EXPECT_EQ(rod.type, JointType::slider);
  EXPECT_EQ(rod.child, "buoy");
  expect_close(rod.point, {1.5, 2, 3});
  expect_close(rod.axis, {0, 0, 1});
  ASSERT_TRUE(rod.limits);
  EXPECT_EQ((*rod.limits)[1], 0.2);
  EXPECT_EQ(rod.damping, 0);
  const JointCase& weld = joint(read, "paddle_joint");
  EXPECT_EQ(weld.type, JointType::fixed);
  EXPECT_EQ(weld.parent, "arm");
  EXPECT_EQ(weld.child, "paddle");
}

TEST(Robot, JointsAreCommandedWithinTheUrdfsLimitsOrTheCases) {
  const auto with = [](const std::string& commands) {
    return read_case_text(case_with("{urdf: " + arm_file + ", commands: [" + commands + "]}"), "case.yaml");
  };
  const Case read = with("{joint: shoulder, quantity: velocity}, {joint: rod, greatest_effort: 3, timeout: 2}");
  const JointCase& shoulder = joint(read, "shoulder");
  ASSERT_TRUE(shoulder.command);
  EXPECT_EQ(shoulder.command->quantity, JointQuantity::velocity);
  EXPECT_EQ(shoulder.command->greatest_effort, 10);
  EXPECT_EQ(shoulder.command->greatest_velocity, 1);
  const JointCase& rod = joint(read, "rod");
  ASSERT_TRUE(rod.command);
  EXPECT_EQ(rod.command->greatest_effort, 3);
  EXPECT_FALSE(rod.command->greatest_velocity);  // of an effort there is none
  EXPECT_EQ(rod.command->timeout, 2);
  EXPECT_FALSE(joint(read, "paddle_joint").command);
  const Case again = read_case_text(write_case(read), "written");
  ASSERT_TRUE(joint(again, "shoulder").command);
  EXPECT_EQ(joint(again, "shoulder").command->greatest_effort, 10);

  const auto error = [](const std::string& commands) {
    return error_of(case_with("{urdf: " + arm_file + ", commands: [" + commands + "]}"));
  };
  EXPECT_EQ(error("{joint: rod}, {joint: wrist}"),
            "case.yaml:5: robots/0/commands/1/joint is wrist; it must be a hinge or slider of the robot: one of rod, shoulder");
  EXPECT_TRUE(contains(error("{joint: paddle_joint}"), "robots/0/commands/0/joint is paddle_joint; it must be a hinge or slider"));
  EXPECT_TRUE(contains(error("{joint: rod}, {joint: rod}"), "robots/0/commands/1/joint is rod, as another one before it"));
  EXPECT_TRUE(contains(error("{joint: rod, greatest_velocity: 1}"), "is of the quantity velocity only"));
  EXPECT_TRUE(contains(error("{quantity: effort}"), "robots/0/commands/0/joint"));
}

TEST(Robot, AFixedRootStandsAndTheRestIsFree) {
  const Case read = read_case_text(case_with("{urdf: " + arm_file + ", motion: fixed}"), "case.yaml");
  EXPECT_EQ(body(read, "base").motion, Motion::fixed);
  EXPECT_EQ(body(read, "arm").motion, Motion::free);
  EXPECT_EQ(body(read, "paddle").motion, Motion::free);
  EXPECT_EQ(joint(read, "shoulder").parent, "base");
  EXPECT_EQ(read.joints.size(), 3u);
}

TEST(Robot, WhatHangsOnTheWorldHangsOnTheTank) {
  const std::string limitless = "<axis xyz=\"0 3 0\"/>";
  const Case read = read_robot(robot("<link name=\"world\"/>" + box_link("flap", inertial(2, "0 0 1")) +
                                     joint_text("hinge", "continuous", "world", "flap", limitless)));
  ASSERT_EQ(read.bodies.size(), 1u);
  EXPECT_EQ(joint(read, "hinge").parent, "tank");
  EXPECT_EQ(joint(read, "hinge").type, JointType::hinge);
  EXPECT_FALSE(joint(read, "hinge").limits);
  expect_close(joint(read, "hinge").axis, {0, 1, 0});
}

TEST(Robot, LinksWithoutAShapeAboveOneThatHasBelongToIt) {
  const Case read = read_robot(robot(box_link("base", inertial(5, "0 0 0")) + "<link name=\"arm\">" + inertial(3, "0 0 0") + "</link>" +
                                     box_link("skin", inertial(1, "0 0 0")) + joint_text("turn", "continuous", "base", "arm") +
                                     joint_text("weld", "fixed", "arm", "skin", "<origin xyz=\"2 0 0\"/>")));
  ASSERT_EQ(read.bodies.size(), 2u);
  ASSERT_EQ(read.joints.size(), 1u);
  EXPECT_EQ(joint(read, "turn").child, "skin");
  expect_close(joint(read, "turn").point, {0, 0, 0});
  // 3 kg at x = 0 and 1 kg at x = 2 m: about x = 0.5 m, 3 · 0.5² + 1 · 1.5² = 3 kg·m² besides their own 2.
  EXPECT_NEAR(*body(read, "skin").rigid.mass, 4, rounding);
  expect_close(*body(read, "skin").rigid.centre_of_mass, {0.5, 0, 0});
  expect_inertia(body(read, "skin"), {2, 5, 5, 0, 0, 0});
}

TEST(Robot, FloatingJointsJoinNothing) {
  const Case read = read_robot(robot("<link name=\"world\"/>" + box_link("raft", inertial(2, "0 0 0")) +
                                     joint_text("afloat", "floating", "world", "raft", "<origin xyz=\"0 0 4\"/>")));
  EXPECT_TRUE(read.joints.empty());
  EXPECT_EQ(body(read, "raft").motion, Motion::free);
  expect_close(mesh(read, "raft").translation, {0, 0, 4});
}

TEST(Robot, IsWrittenAsBodiesAndJoints) {
  const Case read = turned_arm("bodies: [{name: pier, box: {min: [4, 4, 0], max: [4.5, 4.5, 1]}}]\n");
  EXPECT_EQ(read.bodies.front().name, "pier");
  const std::string written = write_case(read);
  EXPECT_FALSE(contains(written, "robots")) << written;
  EXPECT_FALSE(contains(written, ".urdf")) << written;
  EXPECT_TRUE(contains(written, "mesh: \"shape://cylinder?radius=0.02&length=0.5\"\n")) << written;
  const Case again = read_case_text(written, "written");
  EXPECT_EQ(write_case(again), written);
  EXPECT_EQ(again.bodies.size(), 5u);
  EXPECT_EQ(again.joints.size(), 3u);
}

TEST(Robot, JointsOfTheCaseCanEndOnItsLinks) {
  const Case read = turned_arm(
      "joints: [{name: stay, type: spring, parent: base, child: paddle, point: [1, 2.2, 2.6], parent_point: [1, 2, 3], stiffness: 9}]\n");
  ASSERT_EQ(read.joints.size(), 4u);
  EXPECT_EQ(read.joints.front().child, "paddle");
}

TEST(Robot, SeveralCanShareACase) {
  const std::string raft = robot(box_link("raft", inertial(2, "0 0 0")));
  const Surroundings two{{}, [&](const std::string& name) { return name == "one" ? raft : replaced(raft, "raft", "barge"); }};
  const Case read = read_case_text(case_with("{parameter: one}\n  - {parameter: other, position: [0, 0, 2]}"), "case.yaml", {}, two);
  EXPECT_EQ(read.bodies.size(), 2u);
  expect_close(mesh(read, "barge").translation, {0, 0, 2});
}

TEST(Robot, FilesAreRelativeToTheCase) {
  const ScratchDirectory scratch;
  scratch.write("raft.urdf", robot(box_link("raft", inertial(2, "0 0 0"))));
  EXPECT_EQ(read_case_file(scratch.write("case.yaml", case_with("urdf: raft.urdf"))).bodies.size(), 1u);
}

TEST(Robot, FilesOfPackagesAreResolved) {
  const Surroundings surroundings{[](const std::string& uri) {
                                    EXPECT_EQ(uri, "package://arms/paddle_arm.urdf");
                                    return arm_file;
                                  },
                                  {}};
  EXPECT_EQ(read_case_text(case_with("urdf: package://arms/paddle_arm.urdf"), "case.yaml", {}, surroundings).bodies.size(), 4u);
}

TEST(Robot, IsRefusedInItsEntry) {
  EXPECT_EQ(error_of(case_with("parameter: robot_description")),
            "case.yaml:5: robots/0/parameter: only a node has ROS parameters such as 'robot_description'; give the robot's file as urdf "
            "instead, or run the case with wavetank_node");
  EXPECT_TRUE(
      contains(error_of(case_with("urdf: /none.urdf")), "case.yaml:5: robots/0/urdf: /none.urdf: cannot open the robot description"));
  EXPECT_TRUE(contains(error_of(case_with("urdf: none.urdf")), "robots/0/urdf: robot description 'none.urdf' is a relative path"));
  EXPECT_TRUE(contains(error_of(case_with("urdf: package://a/b")), "robots/0/urdf: robot description 'package://a/b' cannot be found"));
  EXPECT_TRUE(contains(error_of(case_with("{urdf: a, parameter: b}")), "robots/0 has both urdf and parameter"));
  EXPECT_TRUE(contains(error_of(case_with("{position: [0, 0, 0]}")), "robots/0 has neither urdf nor parameter"));
  EXPECT_TRUE(contains(error_of(case_with("{urdf: a, motion: commanded}")), "robots/0/motion is commanded; it must be one of free, fixed"));
  EXPECT_TRUE(contains(error_of("dimensions: 2\n" + case_with("urdf: a.urdf")), "robots/0 is in a 2-D case"));
}

TEST(Robot, NamesMustBeItsOwn) {
  const auto error = [](const std::string& more) { return error_of(case_with("{urdf: " + arm_file + "}", more)); };
  EXPECT_TRUE(contains(error("bodies: [{name: arm, box: {min: [4, 4, 0], max: [5, 5, 1]}}]\n"),
                       "paddle_arm.urdf: link 'arm' has a name that is taken; every body must have one of its own"));
  EXPECT_TRUE(contains(error("world_frame: buoy\n"), "link 'buoy' has a name that is taken"));
  EXPECT_TRUE(contains(error("joints: [{name: rod, type: ball, child: arm, point: [0, 0, 0]}]\n"),
                       "paddle_arm.urdf: joint 'rod' has a name that is taken; every joint must have one of its own"));
  EXPECT_TRUE(contains(error("instruments: {pressure_probes: [{name: arm, position: [0, 0, 0]}]}\n"),
                       "instruments/pressure_probes/0/name is arm, as is bodies/"));
}

class BrokenRobot : public testing::TestWithParam<Fault> {};

TEST_P(BrokenRobot, IsRefusedInOneClearSentence) {
  const std::string sound = robot(box_link("base", inertial(5, "0 0 0")) + box_link("arm", inertial(2, "0 0 1")) +
                                  joint_text("elbow", "revolute", "base", "arm",
                                             "<axis xyz=\"0 1 0\"/><limit lower=\"-1\" upper=\"1\" effort=\"1\" velocity=\"1\"/>"
                                             "<dynamics damping=\"1\"/>"));
  ASSERT_EQ(read_robot(sound).joints.size(), 1u);
  std::string message = "(no error)";
  testing::internal::CaptureStderr();
  try {
    read_robot(replaced(sound, GetParam().from, GetParam().to));
  } catch (const Error& error) {
    message = error.what();
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");  // what the URDF library has to say is in the message
  EXPECT_EQ(message.find("parameter robot_description: "), 0u) << message;
  for (const std::string& phrase : GetParam().phrases)
    EXPECT_TRUE(contains(message, phrase)) << "\"" << phrase << "\" is not in: " << message;
  EXPECT_FALSE(contains(message, "\n")) << message;
}

INSTANTIATE_TEST_SUITE_P(
    Faults, BrokenRobot,
    testing::Values(
        Fault{"NoXml", "<robot", "robot", {"not a URDF description that can be read"}},
        Fault{"NotARobot", "<robot name=\"r\">", "<robot>", {"not a URDF description that can be read", "name"}},
        Fault{"Xacro",
              "<robot name=\"r\">",
              "<robot name=\"r\"><xacro:arm/>",
              {"is a xacro file", "expand it first with pipx run xacro FILE > ROBOT.urdf"}},
        Fault{"NoSuchLink", "<child link=\"arm\"/>", "<child link=\"leg\"/>", {"not a URDF description that can be read", "leg", "elbow"}},
        Fault{"NoLimits",
              "<limit lower=\"-1\" upper=\"1\" effort=\"1\" velocity=\"1\"/>",
              "",
              {"not a URDF description that can be read", "elbow"}},
        Fault{"TwoRoots", "</robot>", "<link name=\"alone\"/></robot>", {"not a URDF description that can be read", "alone"}},
        Fault{"TwoParents",
              "</robot>",
              "<joint name=\"again\" type=\"fixed\"><parent link=\"base\"/><child link=\"arm\"/></joint></robot>",
              {"link 'arm' is the child of more than one joint"}},
        Fault{"Planar", "revolute", "planar", {"joint 'elbow' is planar"}},
        Fault{"Mimic", "<dynamics damping=\"1\"/>", "<mimic joint=\"knee\"/>", {"joint 'elbow' mimics joint 'knee'"}},
        Fault{"LimitsWithoutTheStart", "lower=\"-1\"", "lower=\"0.5\"", {"joint 'elbow' has the limits 0.5 and 1", "with 0"}},
        Fault{"LimitsTurnedRound", "lower=\"-1\"", "lower=\"2\"", {"joint 'elbow' has the limits 2 and 1"}},
        Fault{"NegativeDamping", "damping=\"1\"", "damping=\"-1\"", {"joint 'elbow' has a damping of -1; it must be"}},
        Fault{"NoAxis", "axis xyz=\"0 1 0\"", "axis xyz=\"0 0 0\"", {"joint 'elbow' has an axis without a direction"}},
        Fault{"NoMass", "<mass value=\"2.000000\"/>", "<mass value=\"0\"/>", {"link 'arm' moves but has no mass"}},
        Fault{"NegativeMass", "<mass value=\"2.000000\"/>", "<mass value=\"-2\"/>", {"link 'arm' has a mass of -2"}},
        Fault{"NoInertia", "ixx=\"1\"", "ixx=\"0\"", {"link 'base' moves but its inertia is not positive definite"}},
        Fault{"FlatBox", "size=\"1 1 1\"", "size=\"1 0 1\"", {"link 'base' has a shape whose size along y is 0; it must be"}},
        Fault{"PointSphere", "<box size=\"1 1 1\"/>", "<sphere radius=\"0\"/>", {"link 'base' has a shape whose radius is 0"}},
        Fault{"RelativeMesh", "<box size=\"1 1 1\"/>", "<mesh filename=\"a.stl\"/>", {"link 'base' has the mesh 'a.stl'", "package://"}},
        Fault{"MeshWithoutAName", "<box size=\"1 1 1\"/>", "<mesh filename=\"\"/>", {"link 'base' has a mesh without a file name"}},
        Fault{"FlattenedMesh",
              "<box size=\"1 1 1\"/>",
              "<mesh filename=\"package://a/a.stl\" scale=\"1 0 1\"/>",
              {"link 'base' has a mesh of scale 1 0 1; it must be three numbers other than 0"}},
        Fault{"TwoShapes",
              "<collision>",
              "<collision><geometry><sphere radius=\"1\"/></geometry></collision><collision>",
              {"link 'base' has 2 collision elements", "fixed joints"}},
        Fault{"NoShapeButAMass",
              "<collision><geometry><box size=\"1 1 1\"/></geometry></collision></link><joint",
              "</link><joint",
              {"link 'arm' moves but has no shape"}},
        Fault{"IllegalLinkName",
              "</robot>",
              "<link name=\"my-raft\"><visual><geometry><sphere radius=\"1\"/></geometry></visual><inertial><mass value=\"1\"/>"
              "<inertia ixx=\"1\" iyy=\"1\" izz=\"1\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>"
              "<joint name=\"j\" type=\"floating\"><parent link=\"base\"/><child link=\"my-raft\"/></joint></robot>",
              {"link 'my-raft' cannot be called so", "a letter"}},
        Fault{"IllegalJointName", "joint name=\"elbow\"", "joint name=\"my-elbow\"", {"joint 'my-elbow' cannot be called so", "a letter"}},
        Fault{"ReservedName",
              "</robot>",
              "<link name=\"tank\"><visual><geometry><sphere radius=\"1\"/></geometry></visual>"
              "<inertial><mass value=\"1\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>"
              "<joint name=\"j\" type=\"floating\"><parent link=\"base\"/><child link=\"tank\"/></joint></robot>",
              {"link 'tank' has a name that is taken", "which is not tank"}},
        Fault{"HangsOnNothing",
              "<robot name=\"r\">",
              "<robot name=\"r\"><link name=\"footprint\"/>"
              "<joint name=\"foot\" type=\"continuous\"><parent link=\"footprint\"/><child link=\"base\"/></joint>",
              {"joint 'foot' hangs on link 'footprint', which has no shape and is free"}}),
    [](const testing::TestParamInfo<Fault>& info) { return std::string(info.param.name); });

TEST(RobotParameters, AreTheirNamesWhateverElseIsWrong) {
  using Names = std::vector<std::string>;
  const std::string robots = "robots:\n  - {parameter: /arm/robot_description}\n  - {urdf: a.urdf}\n  - {parameter: b, densty: 1}\n";
  EXPECT_EQ(robot_parameters_of_text(robots, "case.yaml"), (Names{"/arm/robot_description", "b"}));
  EXPECT_EQ(robot_parameters_of_text("robots: {0: {parameter: c}}", "case.yaml"), Names{"c"}) << "as a list's index comes in overrides";
  EXPECT_EQ(robot_parameters_of_text("robots: [1, {parameter: [d]}]", "case.yaml"), Names{});
  EXPECT_EQ(robot_parameters_of_text("duration: 1", "case.yaml"), Names{});
  const ScratchDirectory scratch;
  EXPECT_EQ(robot_parameters_of_file(scratch.write("case.yaml", robots)), (Names{"/arm/robot_description", "b"}));
}

TEST(Robot, NothingIsMadeOfNoShapes) {
  const std::string empty = robot("<link name=\"frame\"/>");
  std::string message = "(no error)";
  try {
    read_robot(empty);
  } catch (const Error& error) {
    message = error.what();
  }
  EXPECT_EQ(message, "parameter robot_description: no link of the robot has a shape (collision or visual); give at least one");
}

}  // namespace
}  // namespace wavetank::robot_test

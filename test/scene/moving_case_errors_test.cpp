#include <gtest/gtest.h>

#include "broken_case.h"

namespace wavetank::moving_case_errors_test {

namespace {

// Line by line, so that the numbers below can be counted.
const char* const sound = R"(dimensions: 3
duration: 2
fluid: {spacing: 0.1, fill: [{box: {min: [0, 0, 0], max: [1, 1, 1]}}]}
tank:
  box: {size: [2, 1, 2]}
  motion: prescribed
  prescribed:
    axis: [0, 1, 0]
    harmonics: [{direction: roll, amplitude: 5, frequency: 0.5}]
    ramps: [{direction: surge, change: 0.1, from: 1, to: 2}]
    records: [{file: waves.csv, column: heave}]
bodies:
  - name: hull
    box: {min: [1, 0.2, 0.5], max: [1.5, 0.8, 0.7]}
    motion: free
    mass: 100
    inertia: [1, 2, 2.5, 0, 0, 0]
    restitution: 0.1
    forces:
      - {force: [1, 0, 0], from: 1, to: 2}
    moorings:
      - {anchor: [0, 0, 0], attachment: [1, 0.2, 0.5], stiffness: 10}
  - name: rudder
    box: {min: [1.5, 0.4, 0.5], max: [1.6, 0.5, 0.7]}
    motion: commanded
    command: {timeout: 1}
  - name: pier
    box: {min: [0, 0, 0], max: [0.1, 0.1, 1]}
    friction: 0.2
joints:
  - {name: pin, type: hinge, parent: rudder, child: hull, point: [1.5, 0.45, 0.6], axis: [0, 0, 1], limits: [-30, 30]}
  - {name: rope, type: spring, child: hull, point: [1, 0.5, 0.7], parent_point: [1, 0.5, 2], stiffness: 5}
  - {name: strut, type: six_dof, parent: tank, child: hull, point: [1, 0.5, 0.7], six_limits: {heave: [0, 1]}}
instruments: {pose_rate: 50}
)";

// Of the tank, from its motion on.
const char* const prescribed_tank =
    "motion: prescribed\n  prescribed:\n    axis: [0, 1, 0]\n    harmonics: [{direction: roll, amplitude: 5, frequency: 0.5}]\n"
    "    ramps: [{direction: surge, change: 0.1, from: 1, to: 2}]\n    records: [{file: waves.csv, column: heave}]\n";

class BrokenMovingCase : public testing::TestWithParam<Fault> {};

}  // namespace

TEST(SoundMovingCase, Reads) { EXPECT_EQ(error_of(sound), "(no error)"); }

TEST_P(BrokenMovingCase, IsRefusedInOneClearSentence) { expect_refused(sound, GetParam()); }

const auto fault_name = [](const testing::TestParamInfo<Fault>& info) { return std::string(info.param.name); };

INSTANTIATE_TEST_SUITE_P(
    Suggestions, BrokenMovingCase,
    testing::Values(
        Fault{"Body", "mass: 100", "mas: 100", {"case.yaml:16: bodies/0/mas is not a known key; did you mean bodies/0/mass?"}},
        Fault{"Section", "  prescribed:\n", "  prescribd:\n", {"case.yaml:7: tank/prescribd is", "did you mean tank/prescribed?"}},
        Fault{"Harmonic", "amplitude", "amplitud", {"case.yaml:9: tank/prescribed/harmonics/0/amplitud", "harmonics/0/amplitude?"}},
        Fault{"Command", "timeout", "time_out", {"case.yaml:26: bodies/1/command/time_out", "did you mean bodies/1/command/timeout?"}},
        Fault{"Mooring", "attachment", "atachment", {"case.yaml:22: bodies/0/moorings/0/atachment", "bodies/0/moorings/0/attachment?"}},
        Fault{"Joint", "parent_point", "parents_point", {"case.yaml:32: joints/1/parents_point", "did you mean joints/1/parent_point?"}},
        Fault{"Limits", "heave: [0", "heve: [0", {"case.yaml:33: joints/2/six_limits/heve", "did you mean joints/2/six_limits/heave?"}},
        Fault{"Joints", "joints:", "joint:", {"case.yaml:30: joint is not a known key; did you mean joints?"}},
        Fault{"PoseRate", "pose_rate", "poserate", {"case.yaml:34: instruments/poserate", "did you mean instruments/pose_rate?"}}),
    fault_name);

INSTANTIATE_TEST_SUITE_P(
    Motions, BrokenMovingCase,
    testing::Values(
        Fault{"ZeroMass", "mass: 100", "mass: 0", {"case.yaml:16: bodies/0/mass is 0; it must be greater than 0 (kg)"}},
        Fault{"NegativeDensity", "mass: 100", "density: -1", {"case.yaml:16: bodies/0/density is -1; it must be greater than 0 (kg/m³)"}},
        Fault{"MassAndDensity",
              "mass: 100",
              "mass: 100\n    density: 500",
              {"case.yaml:17: bodies/0 has both mass and density; give exactly one of them"}},
        Fault{"NeitherMassNorDensity",
              "    mass: 100\n",
              "",
              {"case.yaml:13: bodies/0/mass is missing; a free body needs exactly one of mass (kg) and density (kg/m³)"}},
        Fault{"FreeTankWithoutMass",
              prescribed_tank,
              "motion: free\n",
              {"case.yaml:4: tank/mass is missing; a free tank needs its mass (kg)"}},
        Fault{"FreeTankWithoutCentreOfMass",
              prescribed_tank,
              "motion: free\n  mass: 50\n  inertia: [1, 1, 1, 0, 0, 0]\n",
              {"case.yaml:4: tank/centre_of_mass is missing; a free tank needs its centre of mass ([x, y, z], m)"}},
        Fault{"FreeTankWithoutInertia",
              prescribed_tank,
              "motion: free\n  mass: 50\n  centre_of_mass: [1, 0.5, 0.8]\n",
              {"case.yaml:4: tank/inertia is missing; a free tank needs its inertia ([xx, yy, zz, xy, xz, yz], kg·m²)"}},
        Fault{"FreePeriodicTank",
              prescribed_tank,
              "motion: free\n  mass: 50\n  centre_of_mass: [1, 0.5, 0.8]\n  inertia: [1, 1, 1, 0, 0, 0]\n  periodic: [x]\n",
              {"case.yaml:10: tank/periodic is for tanks that do not turn, and tank/motion is free; leave it out, or set tank/motion to "
               "fixed "
               "or prescribed"}},
        Fault{"CommandedPeriodicTank",
              prescribed_tank,
              "motion: commanded\n  periodic: [x]\n",
              {"case.yaml:7: tank/periodic is for tanks that do not turn, and tank/motion is commanded"}},
        Fault{"RollingPeriodicTank",
              "size: [2, 1, 2]}\n",
              "size: [2, 1, 2]}\n  periodic: [x]\n",
              {"case.yaml:6: tank/periodic is for tanks that do not turn, and tank/prescribed has a roll, pitch, yaw or angle"}},
        Fault{"PeriodicTankThatFollowsAWholeFile",
              "box: {size: [2, 1, 2]}\n  motion: prescribed\n  prescribed:\n    axis: [0, 1, 0]\n"
              "    harmonics: [{direction: roll, amplitude: 5, frequency: 0.5}]\n"
              "    ramps: [{direction: surge, change: 0.1, from: 1, to: 2}]\n    records: [{file: waves.csv, column: heave}]\n",
              "box: {size: [2, 1, 2]}\n  periodic: [x]\n  motion: prescribed\n  prescribed: {records: [{file: waves.csv}]}\n",
              {"case.yaml:8: tank/prescribed/records/0/column is missing; a periodic tank must not turn"}},
        Fault{"TankOfADensity", "motion: prescribed", "density: 500", {"case.yaml:6: tank/density is not a known key"}},
        Fault{"IndefiniteInertia",
              "[1, 2, 2.5, 0, 0, 0]",
              "[1, 2, 2.5, 1.5, 0, 0]",
              {"case.yaml:17: bodies/0/inertia is [1, 2, 2.5, 1.5, 0, 0]; it must be 6 numbers", "of a positive definite matrix (kg·m²)"}},
        Fault{"SingularInertia", "[1, 2, 2.5, 0, 0, 0]", "[0, 2, 2, 0, 0, 0]", {"of a positive definite matrix"}},
        Fault{"ShortInertia", "[1, 2, 2.5, 0, 0, 0]", "[1, 2, 3]", {"it must be 6 numbers [xx, yy, zz, xy, xz, yz]"}},
        Fault{"Bouncy", "restitution: 0.1", "restitution: 1.1", {"case.yaml:18: bodies/0/restitution is 1.1; it must be from 0 to 1"}},
        Fault{"Slippery", "friction: 0.2", "friction: -0.2", {"case.yaml:29: bodies/2/friction is -0.2; it must be at least 0"}},
        Fault{"UnknownCollision",
              "friction: 0.2",
              "collision: mesh",
              {"bodies/2/collision is mesh; it must be one of automatic, convex_hull"}},
        Fault{"HullOfTheTank", "  motion: prescribed", "  motion: prescribed\n  collision: convex_hull", {"one of automatic, parts, none"}},
        Fault{"NoParts",
              "friction: 0.2",
              "collision: parts",
              {"case.yaml:27: bodies/2/collision_parts is missing or empty; collision: parts needs a list of at least one mesh"}},
        Fault{"PartsOfNothing",
              "friction: 0.2",
              "collision_parts: [{mesh: a.stl}]",
              {"case.yaml:29: bodies/2/collision_parts is for collision: parts only; leave it out, or set bodies/2/collision to parts"}},
        Fault{"PrescribedButFixed",
              "friction: 0.2",
              "prescribed: {}",
              {"case.yaml:29: bodies/2/prescribed is for motion: prescribed only; leave it out, or set bodies/2/motion to prescribed"}},
        Fault{"PrescribedByNothing",
              "friction: 0.2",
              "motion: prescribed\n    prescribed: {axis: [1, 0, 0]}",
              {"case.yaml:29: bodies/2/motion is prescribed, but nothing prescribes it",
               "give bodies/2/prescribed at least one of harmonics, ramps, records and waves"}},
        Fault{"CommandOfAFixedBody",
              "motion: commanded",
              "motion: fixed",
              {"case.yaml:26: bodies/1/command is for motion: commanded only; leave it out, or set bodies/1/motion to commanded"}},
        Fault{"ForcesOnACommandedBody", "command: {timeout: 1}", "forces: []", {"case.yaml:26: bodies/1/forces is for motion: free only"}},
        Fault{"MooredPier", "friction: 0.2", "moorings: []", {"case.yaml:29: bodies/2/moorings is for motion: free only; leave it out"}},
        Fault{"FixedWithAVelocity", "friction: 0.2", "velocity: [1, 0, 0]", {"case.yaml:29: bodies/2/velocity is for motion: free only"}},
        Fault{"FixedWithARotation", "friction: 0.2", "angular_velocity: [1, 0, 0]", {"bodies/2/angular_velocity is for motion: free only"}},
        Fault{"MovingBelt",
              "restitution: 0.1",
              "surface_velocity: [1, 0, 0]",
              {"case.yaml:18: bodies/0/surface_velocity is for bodies that stand only; leave it out, or set bodies/0/motion to fixed"}},
        Fault{"BackwardRamp",
              "from: 1, to: 2}]",
              "from: 2, to: 2}]",
              {"case.yaml:10: tank/prescribed/ramps/0/to is 2; it must be later than tank/prescribed/ramps/0/from (s)"}},
        Fault{"RampOfNoDirection",
              "direction: surge",
              "direction: forwards",
              {"ramps/0/direction is forwards; it must be one of surge, sway"}},
        Fault{"ZeroFrequency", "frequency: 0.5", "frequency: 0", {"harmonics/0/frequency is 0; it must be greater than 0 (Hz)"}},
        Fault{"NoAmplitude", "amplitude: 5, ", "", {"case.yaml:9: tank/prescribed/harmonics/0/amplitude is missing"}},
        Fault{"ZeroAxis", "axis: [0, 1, 0]", "axis: [0, 0, 0]", {"case.yaml:8: tank/prescribed/axis is [0, 0, 0]; it must be of a length"}},
        Fault{"RecordOfNoDirection",
              "column: heave",
              "column: z",
              {"case.yaml:11: tank/prescribed/records/0/direction is missing", "column z is not named as a direction"}},
        Fault{"DirectionOfEveryColumn",
              "column: heave",
              "direction: heave",
              {"case.yaml:11: tank/prescribed/records/0/direction is for a record with a column"}},
        Fault{"RecordWithoutFile", "file: waves.csv, ", "", {"case.yaml:11: tank/prescribed/records/0/file is missing"}},
        Fault{"ZeroLimit", "timeout: 1", "greatest_speed: 0", {"bodies/1/command/greatest_speed is 0; it must be greater than 0, or none"}},
        Fault{"NegativeTimeout", "timeout: 1", "timeout: -1", {"bodies/1/command/timeout is -1; it must be at least 0 (s)"}},
        Fault{"BackwardForce",
              "from: 1, to: 2}\n",
              "from: 1, to: 0.5}\n",
              {"case.yaml:20: bodies/0/forces/0/to is 0.5; it must be later than bodies/0/forces/0/from (s)"}},
        Fault{"NoForce", "force: [1, 0, 0], ", "", {"case.yaml:20: bodies/0/forces/0 has neither a force nor a torque"}},
        Fault{"PhaseOfAConstant", "from: 1, to: 2}\n", "phase: 90}\n", {"bodies/0/forces/0/phase is for harmonic forces only"}},
        Fault{"SpringWithoutStiffness",
              ", stiffness: 10",
              "",
              {"case.yaml:22: bodies/0/moorings/0/stiffness is missing; a mooring of the line spring needs it (number, N/m)"}},
        Fault{"CatenaryWithoutWeight",
              "stiffness: 10",
              "line: catenary, length: 2",
              {"case.yaml:22: bodies/0/moorings/0/weight is missing; a mooring of the line catenary needs it (number, N/m)"}},
        Fault{"CatenaryWithoutLength",
              "stiffness: 10",
              "line: catenary, weight: 2",
              {"case.yaml:22: bodies/0/moorings/0/length is missing; a mooring of the line catenary needs it (number, m)"}},
        Fault{"StiffCatenary",
              "stiffness: 10",
              "line: catenary, weight: 2, length: 2, stiffness: 10",
              {"bodies/0/moorings/0/stiffness is of the line spring only; leave it out, or set bodies/0/moorings/0/line to that"}},
        Fault{"TautCatenary",
              "stiffness: 10",
              "line: catenary, weight: 2, length: 1",
              {"case.yaml:22: bodies/0/moorings/0/length is 1; it must be greater than the distance of its ends at the start, 1.1357"}},
        Fault{"WindWithoutArea", "mass: 100", "mass: 100\n    wind: {velocity: [1, 0, 0]}", {"bodies/0/wind/area is missing"}},
        Fault{"WindOnAPier",
              "friction: 0.2",
              "wind: {velocity: [1, 0, 0], area: 1}",
              {"bodies/2/wind is for motion: free only; leave it out"}},
        Fault{"ImuOfANumber", "mass: 100", "mass: 100\n    imu: 3", {"bodies/0/imu is 3; it must be true, false, or its place, [x, y, z]"}},
        Fault{"SoftMooring", "stiffness: 10", "stiffness: -10", {"bodies/0/moorings/0/stiffness is -10; it must be at least 0 (N/m)"}},
        Fault{"MooringToNothing", "anchor: [0, 0, 0], ", "", {"case.yaml:22: bodies/0/moorings/0/anchor is missing"}}),
    fault_name);

INSTANTIATE_TEST_SUITE_P(
    Joints, BrokenMovingCase,
    testing::Values(
        Fault{"CommandOfASpring",
              "stiffness: 5}",
              "stiffness: 5, command: {}}",
              {"case.yaml:32: joints/1/command does not belong to a joint of type spring, but to hinge, slider only; leave it out"}},
        Fault{"FastEffort",
              "limits: [-30, 30]}",
              "limits: [-30, 30], command: {greatest_velocity: 1}}",
              {"case.yaml:31: joints/0/command/greatest_velocity is of the quantity velocity only"}},
        Fault{"UnknownParent",
              "parent: rudder",
              "parent: ruder",
              {"case.yaml:31: joints/0/parent is ruder; it must be the name of a body, or tank or world: one of hull, pier, rudder, tank, "
               "world"}},
        Fault{"UnknownChild",
              "child: hull",
              "child: hul",
              {"case.yaml:31: joints/0/child is hul; it must be the name of a body, or tank: one"}},
        Fault{"WorldForAChild", "child: hull", "child: world", {"case.yaml:31: joints/0/child is world; it must be the name of a body"}},
        Fault{"ToItself", "parent: rudder", "parent: hull", {"case.yaml:31: joints/0/child is hull, as is its parent"}},
        Fault{"NothingFree",
              "child: hull",
              "child: pier",
              {"case.yaml:31: joints/0/child is pier, which is not free, and nor is its parent, rudder",
               "the motion of at least one of them must be free"}},
        Fault{"DuplicateName", "name: rope", "name: pin", {"case.yaml:32: joints/1/name is pin, as is joints/0/name; every joint must"}},
        Fault{"NoType", "type: hinge, ", "", {"case.yaml:31: joints/0/type is missing"}},
        Fault{"UnknownType",
              "type: hinge",
              "type: hinged",
              {"joints/0/type is hinged; it must be one of fixed, hinge, slider, ball, spring"}},
        Fault{"ZeroAxis", "axis: [0, 0, 1]", "axis: [0, 0, 0]", {"case.yaml:31: joints/0/axis is [0, 0, 0]; it must be of a length"}},
        Fault{"CrossedLimits",
              "limits: [-30, 30]",
              "limits: [30, -30]",
              {"case.yaml:31: joints/0/limits is [30, -30]; it must be [low, high] with low at most 0, the start, and high at least 0 (m "
               "or °)"}},
        Fault{"LimitsAboveTheStart", "limits: [-30, 30]", "limits: [20, 60]", {"case.yaml:31: joints/0/limits is [20, 60]; it must be"}},
        Fault{"LimitsBelowTheStart", "limits: [-30, 30]", "limits: [-60, -20]", {"joints/0/limits is [-60, -20]; it must be"}},
        Fault{"SliderAwayFromTheStart",
              "type: hinge, parent: rudder, child: hull, point: [1.5, 0.45, 0.6], axis: [0, 0, 1], limits: [-30, 30]",
              "type: slider, parent: rudder, child: hull, axis: [0, 0, 1], limits: [0.1, 0.2]",
              {"case.yaml:31: joints/0/limits is [0.1, 0.2]; it must be [low, high] with low at most 0, the start, and high at least 0"}},
        Fault{"SixLimitsAwayFromTheStart", "heave: [0, 1]", "heave: [0.5, 1]", {"joints/2/six_limits/heave is [0.5, 1]; it must be"}},
        Fault{"PitchBeyondTheUpright",
              "heave: [0, 1]",
              "pitch: [-100, 0]",
              {"case.yaml:33: joints/2/six_limits/pitch is [-100, 0]; it must be [low, high] with low from -90 to 0, the start, and high "
               "from "
               "0 to 90 (°)"}},
        Fault{"RollBeyondHalfATurn", "heave: [0, 1]", "roll: [0, 181]", {"six_limits/roll is [0, 181]", "low from -180 to 0", "0 to 180"}},
        Fault{"YawBeyondHalfATurn", "heave: [0, 1]", "yaw: [-360, 0]", {"six_limits/yaw is [-360, 0]", "low from -180 to 0"}},
        Fault{"OneLimit", "limits: [-30, 30]", "limits: 30", {"joints/0/limits is 30; it must be 2 numbers [low, high]"}},
        Fault{"CrossedSixLimits", "heave: [0, 1]", "roll: [1, 0]", {"joints/2/six_limits/roll is [1, 0]; it must be [low, high]", "(°)"}},
        Fault{"LimitsOfABall",
              "type: hinge, parent: rudder, child: hull, point: [1.5, 0.45, 0.6], axis: [0, 0, 1]",
              "type: ball, parent: rudder, child: hull, point: [1.5, 0.45, 0.6]",
              {"case.yaml:31: joints/0/limits does not belong to a joint of type ball, but to hinge, slider only; leave it out"}},
        Fault{"SixLimitsOfAHinge", "limits: [-30, 30]", "six_limits: {}", {"joints/0/six_limits does not belong to a joint of type hinge"}},
        Fault{"LengthOfAHinge",
              "limits: [-30, 30]",
              "length: 1",
              {"joints/0/length does not belong to a joint of type hinge, but to spring"}},
        Fault{"ParentPointOfAHinge", "limits: [-30, 30]", "parent_point: [0, 0, 0]", {"joints/0/parent_point does not belong"}},
        Fault{
            "StiffStrut", "six_limits: {heave: [0, 1]}", "stiffness: 1", {"joints/2/stiffness does not belong to a joint of type six_dof"}},
        Fault{"HingeAnywhere", "point: [1.5, 0.45, 0.6], ", "", {"joints/0/point is missing; a joint of type hinge needs it"}},
        Fault{"SpringFromNowhere",
              ", parent_point: [1, 0.5, 2]",
              "",
              {"case.yaml:32: joints/1/parent_point is missing; a joint of type spring needs it ([x, y, z], m)"}},
        Fault{"LimpSpring", ", stiffness: 5", "", {"case.yaml:32: joints/1/stiffness is missing; a joint of type spring needs it"}},
        Fault{"PushingSpring", "stiffness: 5", "stiffness: -5", {"joints/1/stiffness is -5; it must be at least 0"}},
        Fault{"NegativeDamping", "stiffness: 5", "stiffness: 5, damping: -1", {"joints/1/damping is -1; it must be at least 0"}}),
    fault_name);

namespace {

const char* const flat = R"(dimensions: 2
duration: 2
gravity: [0, -9.81]
fluid: {spacing: 0.1, fill: [{box: {min: [0, 0], max: [1, 1]}}]}
tank: {box: {size: [2, 2]}, motion: prescribed, prescribed: {harmonics: [{direction: surge, amplitude: 0.1, frequency: 1}]}}
bodies:
  - {name: hull, box: {min: [1, 0.5], max: [1.5, 0.7]}, motion: free, mass: 100, inertia: 2, velocity: [1, 0], angular_velocity: 0.1}
joints:
  - {name: pin, type: hinge, child: hull, point: [1, 0.5]}
  - {name: strut, type: six_dof, child: hull, point: [1, 0.5], six_limits: {pitch: [0, 10]}}
)";

class BrokenFlatCase : public testing::TestWithParam<Fault> {};

}  // namespace

TEST(SoundFlatCase, Reads) { EXPECT_EQ(error_of(flat), "(no error)"); }

TEST_P(BrokenFlatCase, IsRefusedInOneClearSentence) { expect_refused(flat, GetParam()); }

INSTANTIATE_TEST_SUITE_P(
    Faults, BrokenFlatCase,
    testing::Values(
        Fault{"Sway",
              "direction: surge",
              "direction: sway",
              {"case.yaml:5: tank/prescribed/harmonics/0/direction is sway; it must be one of surge, heave, pitch, stroke, angle in a 2-D "
               "case"}},
        Fault{"RecordedYaw",
              "harmonics: [{direction: surge, amplitude: 0.1, frequency: 1}]",
              "records: [{file: a.csv, column: yaw}]",
              {"tank/prescribed/records/0/column is yaw; it must be one of surge, heave, pitch, stroke, angle in a 2-D case"}},
        Fault{"StrokeOutOfPlane",
              "direction: surge",
              "direction: stroke",
              {"case.yaml:5: tank/prescribed/axis is [0, 1, 0], the default; it must be within the x–z plane for a stroke in a 2-D case, "
               "[x, z]"}},
        Fault{"AngleInPlane",
              "{harmonics: [{direction: surge",
              "{axis: [1, 0], harmonics: [{direction: angle",
              {"tank/prescribed/axis is [1, 0, 0]; it must be [0, 1, 0] or [0, -1, 0] for an angle in a 2-D case"}},
        Fault{
            "HingeInPlane", "type: hinge", "type: hinge, axis: [1, 0]", {"case.yaml:9: joints/0/axis is [1, 0, 0]; it must be [0, 1, 0]"}},
        Fault{"SliderOutOfPlane",
              "type: hinge",
              "type: slider",
              {"joints/0/axis is [0, 1, 0], the default; it must be within the x–z plane"}},
        Fault{"Roll",
              "six_limits: {pitch",
              "six_limits: {roll",
              {"case.yaml:10: joints/1/six_limits/roll is [0, 10]; it must be left out of a 2-D case, where there is no such motion (°)"}},
        Fault{
            "VelocityOutOfPlane", "velocity: [1, 0]", "velocity: [1, 1, 0]", {"bodies/0/velocity is [1, 1, 0]; it must be within the x–z"}},
        Fault{"Rolling",
              "angular_velocity: 0.1",
              "angular_velocity: [1, 0, 0]",
              {"bodies/0/angular_velocity is [1, 0, 0]; it must be about y alone in a 2-D case, a number or [0, y, 0] (rad/s)"}},
        Fault{
            "ForceOutOfPlane", "mass: 100", "mass: 100, forces: [{force: [0, 1, 0]}]", {"forces/0/force is [0, 1, 0]; it must be within"}},
        Fault{"TorqueInPlane",
              "mass: 100",
              "mass: 100, forces: [{torque: [1, 0]}]",
              {"forces/0/torque is [1, 0]; it must be a number about y"}},
        Fault{"ZeroInertia", "inertia: 2", "inertia: 0", {"bodies/0/inertia is 0; it must be greater than 0 (kg·m²)"}},
        Fault{"ZeroYY",
              "inertia: 2",
              "inertia: [1, 0, 1, 0, 0, 0]",
              {"it must be 6 numbers [xx, yy, zz, xy, xz, yz] with yy greater than 0"}},
        Fault{"ZeroAxis", "type: hinge", "type: hinge, axis: [0, 0]", {"joints/0/axis is [0, 0]; it must be of a length greater than 0"}}),
    fault_name);

TEST(BrokenMovingCases, ByOverride) {
  EXPECT_EQ(error_of(sound, {{"bodies/0/motion", "fixed"}}),
            "case.yaml:19: bodies/0/forces is for motion: free only; leave it out, or set bodies/0/motion to free");
  EXPECT_EQ(error_of(sound, {{"tank/prescribed/harmonics/0/frequency", "-1"}}),
            "--set tank/prescribed/harmonics/0/frequency: tank/prescribed/harmonics/0/frequency is -1; it must be greater than 0 (Hz)");
  EXPECT_EQ(error_of(sound, {{"joints/0/stiffnes", "1"}}),
            "--set joints/0/stiffnes: joints/0/stiffnes is not a known key; did you mean joints/0/stiffness?");
  EXPECT_EQ(error_of(sound, {{"joints/0/stiffnes", "1", "parameter ~"}}),
            "parameter ~joints/0/stiffnes: joints/0/stiffnes is not a known key; did you mean joints/0/stiffness?");
}

}  // namespace wavetank::moving_case_errors_test

// Openings that a case cannot have.
#include "broken_case.h"

namespace wavetank {
namespace {

const char* const sound = R"(dimensions: 3
duration: 2
fluid:
  spacing: 0.1
  fill: [{box: {min: [0, 0, 0], max: [2, 1, 1]}}]
tank:
  box: {size: [2, 1, 2]}
bodies:
  - {name: pier, box: {min: [1, 0.2, 0], max: [1.2, 0.4, 1]}}
openings:
  - name: hose
    kind: inlet
    centre: [0, 0.5, 0.5]
    normal: [1, 0, 0]
    size: [0.4, 0.4]
    discharge: 0.1*t
  - name: drain
    kind: outlet
    centre: [2, 0.5, 0.5]
    normal: [-1, 0, 0]
    diameter: 0.4
    level: 0.9
)";

class BrokenOpening : public testing::TestWithParam<Fault> {};

TEST_P(BrokenOpening, IsRefusedInOneClearSentence) { expect_refused(sound, GetParam()); }

INSTANTIATE_TEST_SUITE_P(
    Faults, BrokenOpening,
    testing::Values(
        Fault{"NoKind", "    kind: inlet\n", "", {"case.yaml:11: openings/0/kind is missing; it must be given (word)"}},
        Fault{"UnknownKind", "kind: inlet", "kind: tap", {"openings/0/kind is tap; it must be one of inlet, outlet, pressure"}},
        Fault{"NegativeDischarge", "0.1*t", "-0.1", {"case.yaml:16: openings/0/discharge is -0.1; it must be at least 0"}},
        Fault{"NoExpression", "0.1*t", "0.1*x", {"openings/0/discharge: \"0.1*x\" is no expression of t"}},
        Fault{"NotFinite", "0.1*t", "1/t", {"openings/0/discharge is 1/t; it must be finite at t = 0 (m³/s)"}},
        Fault{"NoNormal",
              "normal: [1, 0, 0]",
              "normal: [0, 0, 0]",
              {"openings/0/normal is [0, 0, 0]; it must be a direction into the water"}},
        Fault{"NoShape", "    size: [0.4, 0.4]\n", "", {"openings/0 has neither size nor diameter nor part"}},
        Fault{"TwoShapes", "    size:", "    diameter: 1\n    size:", {"openings/0 has both diameter and size"}},
        Fault{"FlatSize",
              "size: [0.4, 0.4]",
              "size: [0.4, 0]",
              {"openings/0/size is [0.4, 0]; it must be greater than 0 in either direction"}},
        Fault{"UpAlongNormal", "    size:", "    up: [2, 0, 0]\n    size:", {"openings/0/up is along openings/0/normal"}},
        Fault{"UpOfADisc", "    diameter:", "    up: [0, 0, 1]\n    diameter:", {"openings/1/up is for rectangles"}},
        Fault{
            "NoLaw",
            "    discharge: 0.1*t\n",
            "",
            {"openings/0/kind is inlet without a law; give one of velocity, discharge, record, command, or an outlet that returns_to it"}},
        Fault{"ReturnToNobody", "    level: 0.9", "    returns_to: tap", {"openings/1/returns_to is tap, which is no opening of the case"}},
        Fault{"ReturnToAnOutlet", "    level: 0.9", "    returns_to: drain", {"openings/1/returns_to is drain, which is no inlet"}},
        Fault{"ReturnToALaw", "    level: 0.9", "    returns_to: hose", {"openings/1/returns_to is hose, which has a law of its own"}},
        Fault{"ReturnOfAnInlet",
              "    discharge:",
              "    returns_to: hose\n    discharge:",
              {"openings/0/returns_to is for outlets, and this one's kind is inlet"}},
        Fault{"PartOfABox",
              "    centre: [0, 0.5, 0.5]\n    normal: [1, 0, 0]\n    size: [0.4, 0.4]\n",
              "    part: port\n",
              {"openings/0/part is port, but the tank is no mesh and has no parts; give centre, normal and size"}},
        Fault{"PartAndCentre", "    size: [0.4, 0.4]", "    part: port", {"openings/0/centre is given as well as part"}},
        Fault{"NoCentre", "    centre: [0, 0.5, 0.5]\n", "", {"openings/0/centre is missing; it must be given"}},
        Fault{"NoProfile",
              "    discharge:",
              "    profile: flat\n    discharge:",
              {"openings/0/profile: \"flat\" is no expression of x, y and z"}},
        Fault{"NegativeProfile",
              "    discharge:",
              "    profile: z - 0.4\n    discharge:",
              {"case.yaml:16: openings/0/profile is z - 0.4, which is -0.05 at (0, 0.35, 0.35) m; it must be finite and at least 0"}},
        Fault{"ProfileOfNothing",
              "    discharge:",
              "    profile: max(z - 1, 0)\n    discharge:",
              {"case.yaml:16: openings/0/profile is max(z - 1, 0), which is 0 wherever water passes"}},
        Fault{
            "ProfileThatIsNoNumber",
            "    discharge:",
            "    profile: sqrt(0.5 - y)\n    discharge:",
            {"case.yaml:16: openings/0/profile is sqrt(0.5 - y), which is", "nan at (0, 0.55, 0.35) m; it must be finite and at least 0"}},
        Fault{"DischargeThatTurns",
              "0.1*t",
              "0.1 - 0.1*t",
              {"case.yaml:16: openings/0/discharge is 0.1 - 0.1*t, which is -0.0002 at t = 1.002 s; it must be finite and at least 0"}},
        Fault{
            "VelocityThatTurnsInPlaces",
            "    discharge: 0.1*t",
            "    velocity: 0.1*t + 0.5 - y",
            {"case.yaml:16: openings/0/velocity is 0.1*t + 0.5 - y, which is -0.05 at (0, 0.55, 0.35) m and t = 0; it must be finite and"}},
        Fault{"TwoLaws", "    discharge:", "    velocity: 1\n    discharge:", {"openings/0/discharge is given as well as velocity"}},
        Fault{"LawOfAnotherKind",
              "    discharge:",
              "    head:",
              {"openings/0/head is not for an opening of kind inlet, which has velocity, discharge, record, command"}},
        Fault{
            "LevelAndDischarge", "    level: 0.9", "    level: 0.9\n    discharge: 1", {"openings/1/level is given as well as discharge"}},
        Fault{"HeadRecordOfAnInlet",
              "    discharge: 0.1*t",
              "    record: {file: a.csv, quantity: head}",
              {"openings/0/record/quantity is head, which an opening of kind inlet does not follow; it must be discharge or velocity"}},
        Fault{"ParabolicUnderALevel",
              "    discharge:",
              "    level: 0.6\n    profile: parabolic\n    discharge:",
              {"openings/0/profile is parabolic, which is for inlets and outlets that are full"}},
        Fault{"NoSuchBody",
              "    kind: outlet",
              "    kind: outlet\n    body: boat",
              {"openings/1/body is boat, which is no body of the case"}},
        Fault{"SameName", "name: drain", "name: pier", {"openings/1/name is pier, as is bodies/0/name"}}),
    [](const testing::TestParamInfo<Fault>& info) { return info.param.name; });

TEST(OpeningOfABodyThatMoves, HasNeitherFreedomNorLevel) {
  const auto with_motion = [](const std::string& motion) {
    return replaced(replaced(sound, "{name: pier,", "{name: pier, " + motion + ","), "    kind: outlet",
                    "    kind: outlet\n    body: pier");
  };
  const std::string free = with_motion("motion: free, density: 500"), level = with_motion("motion: commanded");
  EXPECT_TRUE(contains(error_of(free), "openings/1/body is pier, which moves freely; openings are for bodies that are fixed"))
      << error_of(free);
  EXPECT_TRUE(contains(error_of(level), "openings/1/body is pier, which moves, but the opening has a level or a head")) << error_of(level);
  EXPECT_EQ(error_of(replaced(level, "    level: 0.9\n", "")), "(no error)");
}

// Above its level an inlet carries nothing, whatever an expression has there; a disc has no corners.
TEST(ExpressionsOfOpenings, CountWhereWaterPasses) {
  const std::string below = replaced(sound, "    discharge:", "    level: 0.5\n    profile: 0.5 - z\n    discharge:");
  EXPECT_EQ(error_of(below), "(no error)");
  EXPECT_TRUE(contains(error_of(replaced(below, "level: 0.5", "level: 0.7")), "openings/0/profile is 0.5 - z, which is -0.05 at"));
  const std::string round = replaced(replaced(sound, "    size: [0.4, 0.4]\n", "    diameter: 0.4\n"),
                                     "    discharge:", "    profile: 0.04 - (y - 0.5)^2 - (z - 0.5)^2\n    discharge:");
  EXPECT_EQ(error_of(round), "(no error)");
}

TEST(OpeningOfATankThatMoves, IsRefused) {
  const std::string moving = replaced(sound, "tank:\n", "tank:\n  motion: commanded\n");
  EXPECT_TRUE(contains(error_of(moving), "openings/0/kind is inlet, and tank/motion is not fixed")) << error_of(moving);
}

TEST(OpeningsBetweenGhosts, AreRead) {
  std::string ghosts = replaced(sound, "duration: 2", "duration: 2\nnumerics: {walls: {method: ghost}}");
  ghosts = replaced(ghosts, "bodies:\n  - {name: pier, box: {min: [1, 0.2, 0], max: [1.2, 0.4, 1]}}\n", "");
  EXPECT_EQ(error_of(ghosts), "(no error)");
}

TEST(DiscInTwoDimensions, IsRefused) {
  const std::string flat = replaced(replaced(sound, "dimensions: 3", "dimensions: 2"), "[0.4, 0.4]", "[1, 0.4]");
  EXPECT_TRUE(contains(error_of(flat), "openings/1/diameter is for 3-D cases")) << error_of(flat);
}

TEST(Openings, AreReadAndWritten) {
  EXPECT_EQ(error_of(sound), "(no error)");
  const Case read = read_case_text(sound, "case.yaml", {});
  ASSERT_EQ(read.openings.size(), 2u);
  EXPECT_EQ(read.openings[0].discharge, "0.1*t");
  EXPECT_FALSE(read.openings[0].command);
  EXPECT_EQ(read.openings[1].level, 0.9);
  const std::string commanded = replaced(sound, "    discharge: 0.1*t", "    command: {greatest_discharge: 0.2}");
  const Case again = read_case_text(write_case(read_case_text(commanded, "case.yaml", {})), "again.yaml", {});
  ASSERT_TRUE(again.openings[0].command);
  EXPECT_EQ(again.openings[0].command->greatest_discharge, 0.2);
  EXPECT_FALSE(again.openings[0].command->greatest_rate);
  EXPECT_EQ(again.openings[1].diameter, 0.4);
  std::string returning = replaced(sound, "    discharge: 0.1*t\n", "    profile: 1 - z^2\n");
  returning = replaced(returning, "    level: 0.9", "    returns_to: hose");
  const Case circuit = read_case_text(write_case(read_case_text(returning, "case.yaml", {})), "again.yaml", {});
  EXPECT_EQ(circuit.openings[0].profile, "1 - z^2");
  EXPECT_EQ(circuit.openings[1].returns_to, "hose");
  std::string by_part = replaced(sound, "  box: {size: [2, 1, 2]}", "  mesh: tank.obj");
  by_part = replaced(by_part, "    centre: [0, 0.5, 0.5]\n    normal: [1, 0, 0]\n    size: [0.4, 0.4]\n", "    part: port\n");
  EXPECT_EQ(error_of(by_part), "(no error)");
  EXPECT_EQ(read_case_text(write_case(read_case_text(by_part, "case.yaml", {})), "again.yaml", {}).openings[0].part, "port");
}

}  // namespace
}  // namespace wavetank

#include <gtest/gtest.h>

#include "../common/scratch_directory.h"
#include "broken_case.h"
#include "wavetank/common/error.h"
#include "wavetank/scene/case_reader.h"

namespace wavetank::case_errors_test {

namespace {

// Line by line, so that the numbers below can be counted.
const char* const sound = R"(dimensions: 3
duration: 2
gravity: [0, 0, -9.81]
fluid:
  density: 1000
  spacing: 0.1
  fill:
    - box: {min: [0, 0, 0], max: [1, 1, 1]}
tank:
  box: {size: [2, 1, 2]}
bodies:
  - {name: pier, box: {min: [1, 0, 0], max: [2, 1, 1]}}
numerics:
  support: 3
  courant: 0.4
  walls: {slip: no_slip}
instruments:
  pressure_probes:
    - {name: P1, position: [0, 0, 0]}
  wave_gauges:
    - {name: H1, position: [0, 0]}
  rate: 100
publish_clock: false
)";

class BrokenCase : public testing::TestWithParam<Fault> {};

std::string file_error(const std::string& path) {
  try {
    read_case_file(path);
  } catch (const Error& error) {
    return error.what();
  }
  return "(no error)";
}

}  // namespace

TEST(SoundCase, Reads) { EXPECT_EQ(error_of(sound), "(no error)"); }

TEST_P(BrokenCase, IsRefusedInOneClearSentence) { expect_refused(sound, GetParam()); }

TEST(SoundCase, OfSmoothWallsNeedsAViscosity) {
  std::string text = sound;
  text.replace(text.find("density: 1000"), 13, "viscosity: 0");
  text.replace(text.find("slip: no_slip"), 13, "friction: {law: law_of_the_wall}");
  EXPECT_EQ(
      error_of(text.c_str()),
      "case.yaml:16: numerics/walls/friction/law is law_of_the_wall of a smooth wall, which goes by the viscosity, and fluid/viscosity is "
      "0; give that, or a roughness");
}

INSTANTIATE_TEST_SUITE_P(
    Faults, BrokenCase,
    testing::Values(
        Fault{"UnknownKey", "density:", "densty:", {"case.yaml:5: fluid/densty is not a known key; did you mean fluid/density?"}},
        Fault{"BadExpression",
              "density:",
              "initial: {u: 2*t}\n  density:",
              {"case.yaml:5: fluid/initial/u: \"2*t\" is no expression of x, y and z", "at its character 3"}},
        Fault{"UnknownRootKey", "duration:", "durration:", {"case.yaml:2: durration is not a known key; did you mean duration?"}},
        Fault{"UnknownKeyInAList",
              "position:",
              "postion:",
              {"case.yaml:19: instruments/pressure_probes/0/postion is not", "did you mean instruments/pressure_probes/0/position?"}},
        Fault{"KeyOfAnotherSection",
              "  courant:",
              "  slip: no_slip\n  courant:",
              {"case.yaml:15: numerics/slip", "did you mean numerics/walls/slip?"}},
        Fault{"KeyLikeNoOther",
              "  spacing:",
              "  xyzzyx: 1\n  spacing:",
              {"case.yaml:6: fluid/xyzzyx", "the keys of fluid are density, viscosity"}},
        Fault{"MonolithicFacets",
              "slip: no_slip",
              "shepard: monolithic, elements: facet",
              {"case.yaml:16: numerics/walls/shepard is monolithic", "choose geometric, or other elements"}},
        Fault{"DamperWithoutSymplectic",
              "numerics:",
              "numerics:\n  acoustic_damping: 2\n  integrator: runge_kutta_4",
              {"numerics/acoustic_damping is above 0 and numerics/integrator is runge_kutta_4", "needs symplectic"}},
        Fault{"PeriodicAlongGravity",
              "size: [2, 1, 2]}",
              "size: [2, 1, 2]}\n  periodic: [x, z]",
              {"case.yaml:11: tank/periodic is periodic along z, along which gravity acts; set gravity to zero along z, or leave z out"}},
        Fault{"PeriodicAlongNoAxis",
              "size: [2, 1, 2]}",
              "size: [2, 1, 2]}\n  periodic: [w]",
              {"case.yaml:11: tank/periodic is [w]; it must be a list of the letters x, y and z"}},
        Fault{"RepulsionWithoutGhosts", "slip: no_slip", "repulsion: 0.1", {"case.yaml:16: numerics/walls/repulsion is for ghosts only"}},
        Fault{
            "GhostsWithABody", "slip: no_slip", "method: ghost", {"case.yaml:16: numerics/walls/method is ghost", "leave out the bodies"}},
        Fault{"NegativeDensity", "1000", "-3", {"case.yaml:5: fluid/density is -3; it must be greater than 0 (kg/m³)"}},
        Fault{"WordForANumber", "1000", "heavy", {"case.yaml:5: fluid/density is heavy; it must be a number greater than 0 (kg/m³)"}},
        Fault{"NumberWithAUnit", "1000", "\"1000 kg\"", {"case.yaml:5: fluid/density is 1000 kg; it must be a number"}},
        Fault{"ListForANumber", "1000", "[1, 2]", {"case.yaml:5: fluid/density is [1, 2]; it must be a number"}},
        Fault{"EmptyValue", "density: 1000", "density:", {"case.yaml:5: fluid/density is empty; it must be a number"}},
        Fault{"NotANumber", "1000", ".nan", {"case.yaml:5: fluid/density is .nan; it must be a finite number"}},
        Fault{"Infinite", "duration: 2", "duration: .inf", {"case.yaml:2: duration is .inf; it must be a finite number (s)"}},
        Fault{"TooLargeForADouble", "1000", "1e999", {"case.yaml:5: fluid/density is 1e999; it must be a finite number"}},
        Fault{"BeyondReason", "1000", "1e39", {"case.yaml:5: fluid/density is 1e39; it must be a number from -1e15 to 1e15 (kg/m³)"}},
        Fault{"NextToNothing", "1000", "1e-300", {"case.yaml:5: fluid/density is 1e-300; it must be at least 1e-20 (kg/m³)"}},
        Fault{"BeyondReasonInAVector", "[0, 0, -9.81]", "[0, 0, -1e200]", {"case.yaml:3: gravity/2 is -1e200; it must be a number from"}},
        Fault{"FasterThanAnySound",
              "spacing: 0.1",
              "spacing: 0.1\n  sound_speed: 2e6",
              {"case.yaml:7: fluid/sound_speed is 2e6; it must be"}},
        Fault{"CurrentFasterThanHalfTheSound",
              "spacing: 0.1",
              "spacing: 0.1\n  sound_speed: 20\n  current: [6, 0, 8]",
              {"case.yaml:8: fluid/current is 10 m/s fast, and must be below half of fluid/sound_speed, 10 m/s", "of 100 m/s, ten times"}},
        Fault{"ZeroDuration", "duration: 2", "duration: 0", {"case.yaml:2: duration is 0; it must be greater than 0 (s)"}},
        Fault{"NoDuration", "duration: 2\n", "", {"case.yaml: duration is missing; it must be given (number, s)"}},
        Fault{"FourDimensions", "dimensions: 3", "dimensions: 4", {"case.yaml:1: dimensions is 4; it must be 2 or 3"}},
        Fault{"FractionOfADimension", "dimensions: 3", "dimensions: 2.5", {"case.yaml:1: dimensions is 2.5; it must be 2 or 3"}},
        Fault{"ShortVector", "[0, 0, -9.81]", "[0, -9.81]", {"case.yaml:3: gravity is [0, -9.81]; it must be 3 numbers [x, y, z] (m/s²)"}},
        Fault{"WordInAVector", "[0, 0, -9.81]", "[0, 0, down]", {"case.yaml:3: gravity/2 is down; it must be a number"}},
        Fault{
            "NoGravityForASoundSpeed", "[0, 0, -9.81]", "[0, 0, 0]", {"case.yaml:3: fluid/sound_speed is auto", "give fluid/sound_speed"}},
        Fault{"SpacingAndParticles",
              "  spacing: 0.1",
              "  spacing: 0.1\n  particles: 10",
              {"case.yaml:7: fluid has both spacing and particles; give exactly one of spacing and particles"}},
        Fault{"NeitherSpacingNorParticles",
              "  spacing: 0.1\n",
              "",
              {"case.yaml:4: fluid has neither spacing nor particles; give exactly one"}},
        Fault{"ZeroSpacing", "spacing: 0.1", "spacing: 0", {"case.yaml:6: fluid/spacing is 0; it must be greater than 0 (m)"}},
        Fault{"HalfAParticle", "spacing: 0.1", "particles: 10.5", {"case.yaml:6: fluid/particles is 10.5; it must be a whole number"}},
        Fault{"NoFill",
              "  fill:\n    - box: {min: [0, 0, 0], max: [1, 1, 1]}\n",
              "",
              {"case.yaml:4: fluid/fill is missing; it must be given"}},
        Fault{"EmptyFill",
              "fill:\n    - box: {min: [0, 0, 0], max: [1, 1, 1]}",
              "fill: []",
              {"case.yaml:7: fluid/fill is []; it must be a list of at least one region, where there are no openings"}},
        Fault{"FillIsNoList",
              "fill:\n    - box:",
              "fill:\n      box:",
              {"case.yaml:7: fluid/fill is {box:", "must be a list, each entry a map of keys: box, seed"}},
        Fault{"FillBoxInsideOut",
              "max: [1, 1, 1]",
              "max: [1, 0, 1]",
              {"case.yaml:8: fluid/fill/0/box/max is [1, 0, 1]; it must be greater than fluid/fill/0/box/min, [0, 0, 0], in y (m)"}},
        Fault{
            "SeedWithoutLevel", "box: {min: [0, 0, 0], max: [1, 1, 1]}", "seed: [0, 0, 1]", {"case.yaml:8: fluid/fill/0/level is missing"}},
        Fault{"SeedAboveTheLevel",
              "box: {min: [0, 0, 0], max: [1, 1, 1]}",
              "{seed: [0, 0, 1], level: 0.5}",
              {"case.yaml:8: fluid/fill/0/level is 0.5; it must be above the seed, [0, 0, 1] (m)"}},
        Fault{"SoundSpeed",
              "  spacing:",
              "  sound_speed: -1\n  spacing:",
              {"case.yaml:6: fluid/sound_speed is -1; it must be greater than 0 and at most 1000000, or auto (m/s)"}},
        Fault{"SoundSpeedWord",
              "  spacing:",
              "  sound_speed: fast\n  spacing:",
              {"case.yaml:6: fluid/sound_speed is fast; it must be a number greater than 0 and at most 1000000, or auto (m/s)"}},
        Fault{"NoTank", "tank:\n  box: {size: [2, 1, 2]}\n", "", {"case.yaml: tank is missing"}},
        Fault{"TankOfBothKinds",
              "size: [2, 1, 2]}",
              "size: [2, 1, 2]}\n  mesh: a.stl",
              {"case.yaml:11: tank has both box and mesh", "exactly one of box and mesh"}},
        Fault{"ScaledBox",
              "size: [2, 1, 2]}",
              "size: [2, 1, 2]}\n  scale: 2",
              {"case.yaml:11: tank has both box and scale", "exactly one of box and mesh"}},
        Fault{"ScaleWithoutMesh", "box: {size: [2, 1, 2]}", "scale: 2", {"case.yaml:9: tank/mesh is missing"}},
        Fault{"FlattenedMesh",
              "box: {size: [2, 1, 2]}",
              "mesh: a.stl\n  scale: [1, 0, 1]",
              {"case.yaml:11: tank/scale is [1, 0, 1]; it must be a number greater than 0, or three along x, y and z, each other than 0"}},
        Fault{"MirroringByOneNumber",
              "box: {size: [2, 1, 2]}",
              "mesh: a.stl\n  scale: -1",
              {"case.yaml:11: tank/scale is -1; it must be greater than 0"}},
        Fault{"FlatTank",
              "size: [2, 1, 2]",
              "size: [2, 0, 2]",
              {"case.yaml:10: tank/box/size is [2, 0, 2]; it must be greater than 0 in every direction (m)"}},
        Fault{"BodyWithoutShape",
              "box: {min: [1, 0, 0], max: [2, 1, 1]}",
              "motion: fixed",
              {"case.yaml:12: bodies/0 has neither box nor mesh"}},
        Fault{"UnknownMotion",
              "name: pier",
              "name: pier, motion: floating",
              {"case.yaml:12: bodies/0/motion is floating; it must be one of fixed, free, prescribed, commanded"}},
        Fault{"BodyNamedTank", "name: pier", "name: tank", {"case.yaml:12: bodies/0/name is tank, which is reserved"}},
        Fault{"BodyNamedWorld", "name: pier", "name: world", {"case.yaml:12: bodies/0/name is world, which is reserved"}},
        Fault{"NameOfTheFrame",
              "publish_clock: false",
              "world_frame: P1",
              {"case.yaml:19: instruments/pressure_probes/0/name is P1, which is the world_frame"}},
        Fault{"NameGivenTwice",
              "name: H1",
              "name: P1",
              {"case.yaml:21: instruments/wave_gauges/0/name is P1, as is instruments/pressure_probes/0/name; every"}},
        Fault{"NameWithASpace",
              "name: H1",
              "name: H 1",
              {"case.yaml:21: instruments/wave_gauges/0/name is H 1; it must be a letter followed by"}},
        Fault{"NameFromADigit", "name: H1", "name: 1H", {"case.yaml:21: instruments/wave_gauges/0/name is 1H; it must be a letter"}},
        Fault{"ProbeWithoutName", "name: P1, ", "", {"case.yaml:19: instruments/pressure_probes/0/name is missing"}},
        Fault{"FrictionWithoutSlip",
              "{slip: no_slip}",
              "{slip: free_slip, friction: {law: coefficient}}",
              {"case.yaml:16: numerics/walls/friction/law is coefficient, of walls without slip, and numerics/walls/slip is free_slip"}},
        Fault{"ViscousFrictionWithoutSlip",
              "{slip: no_slip}",
              "{slip: free_slip, friction: {law: viscous}}",
              {"case.yaml:16: numerics/walls/friction/law is viscous, of walls without slip, and numerics/walls/slip is free_slip"}},
        Fault{"FrictionAtGhosts",
              "  - {name: pier, box: {min: [1, 0, 0], max: [2, 1, 1]}}\nnumerics:\n  support: 3\n  courant: 0.4\n  walls: {slip: no_slip}",
              "  []\nnumerics:\n  walls: {method: ghost, friction: {law: law_of_the_wall}}",
              {"numerics/walls/friction/law is law_of_the_wall, which boundary integrals have and ghosts have not"}},
        Fault{"RoughnessOfAnotherLaw",
              "name: pier",
              "name: pier, skin_friction: {law: viscous, roughness: 0.01}",
              {"case.yaml:12: bodies/0/skin_friction/roughness is of the law law_of_the_wall only"}},
        Fault{"CoefficientOfAnotherLaw",
              "{slip: no_slip}",
              "{friction: {coefficient: 0.01}}",
              {"case.yaml:16: numerics/walls/friction/coefficient is of the law coefficient only"}},
        Fault{"NegativeRoughness",
              "{slip: no_slip}",
              "{friction: {law: law_of_the_wall, roughness: -1}}",
              {"numerics/walls/friction/roughness is -1; it must be at least 0 (m)"}},
        Fault{"EddiesWithoutAModel",
              "support: 3",
              "smagorinsky_coefficient: 0.2",
              {"case.yaml:14: numerics/smagorinsky_coefficient is of numerics/turbulence: smagorinsky only"}},
        Fault{"LimiterWithoutRiemannProblems",
              "support: 3",
              "limiter: 2",
              {"case.yaml:14: numerics/limiter is of the schemes riemann_parshikov and riemann_ale only"}},
        Fault{"SensorOfNegativeSize",
              "name: P1, ",
              "name: P1, diameter: -0.01, ",
              {"instruments/pressure_probes/0/diameter is -0.01; it must be at least 0 (m)"}},
        Fault{"VelocityProbeOnNoBody",
              "rate: 100",
              "velocity_probes: [{name: V1, position: [0, 0, 0], body: quay}]",
              {"case.yaml:22: instruments/velocity_probes/0/body is quay, which is no body of the case; name one of pier, or leave"}},
        Fault{"VelocityProbeOfAGaugesName",
              "rate: 100",
              "velocity_probes: [{name: H1, position: [0, 0, 0]}]",
              {"case.yaml:22: instruments/velocity_probes/0/name is H1, as is instruments/wave_gauges/0/name; every"}},
        Fault{"SectionWithoutASize",
              "rate: 100",
              "sections: [{name: S, centre: [0, 0, 0], normal: [1, 0, 0]}]",
              {"case.yaml:22: instruments/sections/0", "size", "diameter"}},
        Fault{"SectionWithoutADirection",
              "rate: 100",
              "sections: [{name: S, centre: [0, 0, 0], normal: [0, 0, 0], diameter: 1}]",
              {"case.yaml:22: instruments/sections/0/normal is", "it must be a direction through it, not all 0"}},
        Fault{"SectionStandingOnItsNormal",
              "rate: 100",
              "sections: [{name: S, centre: [0, 0, 0], normal: [1, 0, 0], size: [1, 1], up: [3, 0, 0]}]",
              {"instruments/sections/0/up is along instruments/sections/0/normal; it must be a direction within the section"}},
        Fault{"UnknownWord", "no_slip", "sticky", {"case.yaml:16: numerics/walls/slip is sticky; it must be one of no_slip, free_slip"}},
        Fault{"SupportTooSmall", "support: 3", "support: 1", {"case.yaml:14: numerics/support is 1; it must be from 2 to 8, or auto (Δx)"}},
        Fault{"CourantTooGreat",
              "courant: 0.4",
              "courant: 2",
              {"case.yaml:15: numerics/courant is 2; it must be greater than 0 and at most 1.5"}},
        Fault{"ZeroRate", "rate: 100", "rate: 0", {"case.yaml:22: instruments/rate is 0; it must be greater than 0", "(Hz)"}},
        Fault{"NumberForAFlag", "publish_clock: false", "publish_clock: 1", {"case.yaml:23: publish_clock is 1; it must be true or false"}},
        Fault{"FrameWithASlash", "publish_clock: false", "world_frame: /map", {"case.yaml:23: world_frame is /map; it must be a tf frame"}},
        Fault{"SectionIsANumber",
              "walls: {slip: no_slip}",
              "walls: 3",
              {"case.yaml:16: numerics/walls is 3; it must be a map of keys: method,"}},
        Fault{"KeyGivenTwice", "  courant:", "  support: 4\n  courant:", {"case.yaml:15: support is given twice, first on line 14"}},
        Fault{"SectionGivenTwice", "publish_clock: false", "tank: {mesh: a.stl}", {"case.yaml:23: tank is given twice, first on line 9"}},
        Fault{"UnclosedBracket", "[0, 0, -9.81]", "[0, 0, -9.81", {"case.yaml:", "not valid YAML"}},
        Fault{"Tab", "  density", "\tdensity", {"case.yaml:", "not valid YAML"}},
        Fault{"SecondDocument", "tank:", "---\ntank:", {"a second YAML document begins; a case is one document"}},
        Fault{"AliasOfItself", "publish_clock: false", "title: &a [*a]", {"case.yaml:23: "}},
        Fault{"ListForAKey", "publish_clock: false", "[1, 2]: 3", {"case.yaml:23: a key must be a single word, not a list or a map"}},
        Fault{"KeyOfTwoWords", "  density:", "  water density:", {"case.yaml:5: a key must be a single word, not water density"}},
        Fault{"UnclosedQuote", "  density:", "  \"density:", {"case.yaml:"}}),
    [](const testing::TestParamInfo<Fault>& info) { return std::string(info.param.name); });

TEST(BrokenCases, GravityOutOfPlane) {
  const std::string flat = replaced(replaced(sound, "dimensions: 3", "dimensions: 2"), "[0, 0, -9.81]", "[0, 1, -9.81]");
  EXPECT_EQ(error_of(flat),
            "case.yaml:3: gravity is [0, 1, -9.81]; it must be within the x–z plane of a 2-D case, [x, 0, z] or [x, z] (m/s²)");
}

TEST(BrokenCases, LevelBeyondTheSeedWhereGravityPointsUp) {
  const std::string upside_down = replaced(sound, "[0, 0, -9.81]", "[0, 0, 9.81]");
  EXPECT_EQ(error_of(replaced(upside_down, "box: {min: [0, 0, 0], max: [1, 1, 1]}", "{seed: [0, 0, 0.5], level: 0.6}")),
            "case.yaml:8: fluid/fill/0/level is 0.6; it must be less than the seed's z, [0, 0, 0.5] (m)");
}

TEST(BrokenCases, GhostsInAMovingTank) {
  const std::string empty = replaced(sound, "  - {name: pier, box: {min: [1, 0, 0], max: [2, 1, 1]}}", "  []");
  const std::string moving = replaced(empty, "size: [2, 1, 2]}", "size: [2, 1, 2]}\n  motion: commanded");
  EXPECT_EQ(error_of(moving), "(no error)");
  EXPECT_EQ(
      error_of(replaced(moving, "slip: no_slip", "method: ghost")),
      "case.yaml:17: numerics/walls/method is ghost, whose images stand still; set tank/motion to fixed, or choose boundary_integral");
}

TEST(BrokenCases, AsAWhole) {
  EXPECT_TRUE(contains(error_of(""), "case.yaml: the case is empty; it must be a map of keys: title, dimensions")) << error_of("");
  EXPECT_TRUE(contains(error_of("# nothing\n# at all\n"), "the case is empty"));
  EXPECT_TRUE(contains(error_of("- 1\n- 2\n"), "case.yaml:1: the case is a list")) << error_of("- 1\n- 2\n");
  EXPECT_TRUE(contains(error_of("solid cube\nfacet normal 0 0 1\n"), "case.yaml:1: the case is a single value, solid cube"));
  EXPECT_TRUE(contains(error_of(std::string("title: a\nx: \0\1", 13)), "case.yaml:2: not a text file (byte 0 "));
  EXPECT_TRUE(contains(error_of("title: a\nx: \xff\xfe\n"), "case.yaml:2: not a text file (byte 255 "));
  const std::string deep = "title: " + std::string(300, '[') + std::string(300, ']') + "\n\n";
  EXPECT_TRUE(contains(error_of(deep), "case.yaml:1: nested or repeated without end")) << error_of(deep);
}

// Parameters have no lines: a text of one line is not said to have any.
TEST(BrokenCases, InParametersHaveNoLine) {
  const std::string message = error_of("{duration: 2, fluid: {densty: 3}}");
  EXPECT_EQ(message, "case.yaml: fluid/densty is not a known key; did you mean fluid/density?");
}

TEST(BrokenFiles, AreRefused) {
  const ScratchDirectory directory;
  EXPECT_EQ(file_error(directory.file("none.yaml")),
            directory.file("none.yaml") + ": cannot open the case file: No such file or directory");
  EXPECT_EQ(file_error(directory.path().string()), directory.path().string() + ": is a directory; a case is a YAML file");
  EXPECT_TRUE(contains(file_error(""), "cannot open the case file"));
  const std::string stl = directory.write("cube.stl", std::string(80, '\0') + "\x0c");
  EXPECT_TRUE(contains(file_error(stl), stl + ":1: not a text file")) << file_error(stl);
  const std::string broken = directory.write("broken.yaml", replaced(sound, "density:", "densty:"));
  EXPECT_EQ(file_error(broken), broken + ":5: fluid/densty is not a known key; did you mean fluid/density?");
  EXPECT_TRUE(contains(file_error("/dev/zero"), "larger than 16 MiB")) << file_error("/dev/zero");
}

TEST(BrokenFiles, ThatTheCaseNamesAreRefusedByLineAndKey) {
  const ScratchDirectory directory;
  const std::string box = "box: {size: [2, 1, 2]}";
  const auto refusal = [&](const std::string& from, const std::string& to) {
    return file_error(directory.write("case.yaml", replaced(sound, from, to)));
  };
  const std::string file = directory.file("case.yaml"), none = directory.file("none.stl");
  EXPECT_EQ(refusal(box, "mesh: none.stl"), file + ":10: tank/mesh: mesh file '" + none + "' does not exist");
  EXPECT_EQ(refusal(box, "mesh: " + none), file + ":10: tank/mesh: mesh file '" + none + "' does not exist");
  EXPECT_EQ(refusal(box, "mesh: file://" + none), file + ":10: tank/mesh: mesh file '" + none + "' does not exist");
  EXPECT_EQ(refusal("  - {name: pier, box: {min: [1, 0, 0], max: [2, 1, 1]}}", "  - name: pier\n    mesh: none.stl"),
            file + ":13: bodies/0/mesh: mesh file '" + none + "' does not exist");
  EXPECT_EQ(refusal(box, box + "\n  collision: parts\n  collision_parts: [{mesh: .}]"),
            file + ":12: tank/collision_parts/0/mesh: mesh file '" + directory.file(".") + "' is not a regular file");
  EXPECT_EQ(refusal(box, box + "\n  motion: prescribed\n  prescribed:\n    records:\n      - {file: none.csv}"),
            file + ":14: tank/prescribed/records/0/file: motion record file '" + directory.file("none.csv") + "' does not exist");
  EXPECT_EQ(refusal(box, "mesh: package://none/none.stl"), "(no error)") << "only ROS can tell";
  EXPECT_EQ(refusal(box, "mesh: 'shape://sphere?radius=1'"), "(no error)");
}

TEST(BrokenOverrides, NameTheOption) {
  const auto message = [](const std::string& key, const std::string& value) { return error_of(sound, {{key, value}}); };
  EXPECT_EQ(message("fluid/densty", "3"), "--set fluid/densty: fluid/densty is not a known key; did you mean fluid/density?");
  EXPECT_EQ(message("fluid/density", "-3"), "--set fluid/density: fluid/density is -3; it must be greater than 0 (kg/m³)");
  EXPECT_EQ(message("fluid/density/x", "3"),
            "--set fluid/density/x: fluid/density is a single value and has no keys, so fluid/density/x is not a known key");
  EXPECT_EQ(message("bodies/3/name", "a"),
            "--set bodies/3/name: bodies has 1 entry; its index must be from 0 to 1 (the last adds one), not 3");
  EXPECT_TRUE(contains(message("bodies/pier/name", "a"), "its index must be from 0 to 1 (the last adds one), not pier"));
  EXPECT_TRUE(contains(message("gravity/3", "1"), "--set gravity/3: gravity has 3 entries; its index must be from 0 to 2, not 3"));
  EXPECT_TRUE(contains(message("", "1"), "--set: the key is empty"));
  EXPECT_TRUE(contains(message("/duration", "1"), "--set /duration:"));
  EXPECT_TRUE(contains(message("fluid/", "1"), "--set fluid/: fluid/ is not a known key"));
  EXPECT_TRUE(contains(message("duration", ""), "--set duration: duration is empty; it must be a number"));
  EXPECT_TRUE(contains(message("duration", "[1"), "--set duration: not valid YAML"));
  EXPECT_TRUE(contains(message("numerics/walls", "{slp: no_slip}"),
                       "--set numerics/walls: numerics/walls/slp is not a known key; did you mean numerics/walls/slip?"));
  EXPECT_TRUE(contains(message("bodies/1/name", "buoy"), "--set bodies/1/name: bodies/1 has neither box nor mesh"));
  EXPECT_TRUE(contains(error_of(replaced(sound, "walls: {slip: no_slip}", "walls: 3"), {{"numerics/walls/slip", "no_slip"}}),
                       "--set numerics/walls/slip: numerics/walls is 3 (case.yaml:16), which is not a map of keys"));
}

/// The parser takes nothing of these, and would find one document after the other there.
TEST(CaseText, ThatBeginsWithWhatCannotBeginIsRefused) {
  for (const char* text : {", mass\n", "# a comment\n\n, b: 2\n", "]\n", "}: 1\n"}) {
    const std::string message = error_of(text);
    EXPECT_TRUE(contains(message, "case.yaml:") && contains(message, "not valid YAML")) << text << message;
  }
}

}  // namespace wavetank::case_errors_test

// Waves by theory and damping zones that a case cannot have.
#include "broken_case.h"

namespace wavetank::wave_errors_test {
namespace {

const char* const sound = R"(dimensions: 2
duration: 2
fluid:
  spacing: 0.05
  sound_speed: 30
  fill: [{box: {min: [0.2, 0], max: [6, 0.4]}}]
  damping:
    - {box: {min: [4, 0], max: [6, 1]}, direction: [1, 0], strength: 8, velocity: [0.1, 0]}
tank:
  box: {size: [6, 1]}
bodies:
  - name: paddle
    box: {min: [0.1, 0], max: [0.2, 0.8]}
    motion: prescribed
    prescribed:
      point: [0.1, 0]
      waves: {kind: regular, depth: 0.4, height: 0.05, period: 1.2}
)";

const char* const regular = "{kind: regular, depth: 0.4, height: 0.05, period: 1.2}";

class BrokenWaves : public testing::TestWithParam<Fault> {};

TEST_P(BrokenWaves, AreRefusedInOneClearSentence) { expect_refused(sound, GetParam()); }

INSTANTIATE_TEST_SUITE_P(
    Faults, BrokenWaves,
    testing::Values(
        Fault{"NoKind", "kind: regular, ", "", {"bodies/0/prescribed/waves/kind is missing"}},
        Fault{"NoDepth", "depth: 0.4, ", "", {"bodies/0/prescribed/waves/depth is missing"}},
        Fault{
            "NoHeight", "height: 0.05, ", "", {"case.yaml:17: bodies/0/prescribed/waves/height is missing; waves of kind regular need it"}},
        Fault{"FlatWaves", "height: 0.05", "height: 0", {"bodies/0/prescribed/waves/height is 0; it must be greater than 0 (m)"}},
        Fault{"KeyOfAnotherKind",
              "period: 1.2",
              "period: 1.2, peak_period: 1",
              {"bodies/0/prescribed/waves/peak_period is not for waves of kind regular; leave it out"}},
        Fault{"SeaWithoutAPeak", regular, "{kind: irregular, depth: 0.4, significant_height: 0.1}", {"waves/peak_period is missing"}},
        Fault{"FocusNowhere", regular, "{kind: focused, depth: 0.4, height: 0.1, peak_period: 1}", {"waves/focus is missing"}},
        Fault{"ThirdOrder", "period: 1.2", "period: 1.2, order: 3", {"waves/order is 3; it must be from 1 to 2"}},
        Fault{"SecondOrderFlap", "period: 1.2", "period: 1.2, order: 2, direction: pitch", {"waves/order is 2, which is for pistons"}},
        Fault{"Heave", "period: 1.2", "period: 1.2, direction: heave", {"waves/direction makes no waves; it must be one of surge"}},
        Fault{"HingeOfAPiston", "period: 1.2", "period: 1.2, hinge: 0.1", {"waves/hinge is for a flap"}},
        Fault{"HingeInTheAir", "period: 1.2", "period: 1.2, direction: pitch, hinge: 0.5", {"waves/hinge is 0.5; it must be less than"}},
        Fault{"SolitaryFlap", regular, "{kind: solitary, depth: 0.4, height: 0.1, direction: pitch}", {"waves/kind is solitary"}},
        Fault{"NoRecord",
              regular,
              "{kind: record, depth: 0.4, record: {file: /no/such/waves.csv}}",
              {"bodies/0/prescribed/waves/record/file: wave record file '/no/such/waves.csv' does not exist"}},
        Fault{"FlapWithoutAPoint",
              "      point: [0.1, 0]\n      waves: {kind: regular, depth: 0.4, height: 0.05, period: 1.2",
              "      waves: {kind: regular, depth: 0.4, height: 0.05, period: 1.2, direction: pitch",
              {"bodies/0/prescribed/point is missing; a flap that makes waves needs it"}},
        Fault{"WavesOfTheTank",
              "  box: {size: [6, 1]}",
              "  box: {size: [6, 1]}\n  motion: prescribed\n  prescribed: {waves: {kind: regular, depth: 0.4, height: 0.05, period: 1.2}}",
              {"tank/prescribed/waves is given, but waves are made by a body"}},
        Fault{"ZonesOfAFreeTank",
              "  box: {size: [6, 1]}",
              "  box: {size: [6, 1]}\n  motion: free\n  mass: 100\n  centre_of_mass: [3, 0.5]\n  inertia: 100",
              {"fluid/damping is given, and tank/motion is free"}},
        Fault{"NoGravity", "duration: 2", "duration: 2\ngravity: [0, 0]", {"gravity is zero, without which there are no waves"}},
        Fault{"NoStrength", ", strength: 8", "", {"fluid/damping/0/strength is missing"}},
        Fault{"NoDirection", "direction: [1, 0]", "direction: [0, 0]", {"fluid/damping/0/direction is [0, 0, 0]; it must be a direction"}},
        Fault{"InsideOut",
              "{min: [4, 0], max: [6, 1]}",
              "{min: [6, 0], max: [4, 1]}",
              {"fluid/damping/0/box/max is [4, 1]; it must be greater than"}},
        Fault{"AbsorptionWithoutAGauge", "period: 1.2", "period: 1.2, absorption: {}", {"waves/absorption/gauge is missing"}},
        Fault{"AbsorptionByNoGaugeAtAll",
              "period: 1.2",
              "period: 1.2, absorption: {gauge: front}",
              {"case.yaml:17: bodies/0/prescribed/waves/absorption/gauge is front, which is no wave gauge of the case; it has none"}},
        Fault{"AbsorptionByAnUnknownGauge",
              "period: 1.2}",
              "period: 1.2, absorption: {gauge: front}}\ninstruments: {wave_gauges: [{name: before, position: [0.4]}]}",
              {"case.yaml:17: bodies/0/prescribed/waves/absorption/gauge is front", "name one of before"}},
        Fault{"AbsorptionFromBehind",
              "period: 1.2}",
              "period: 1.2, absorption: {gauge: front}}\ninstruments: {wave_gauges: [{name: front, position: [0.05]}]}",
              {"case.yaml:17: bodies/0/prescribed/waves/absorption/gauge is front, which stands 0.15 m behind the paddle's front"}},
        Fault{"AbsorptionBehindAReversedPaddle",
              "period: 1.2}",
              "period: 1.2, reversed: true, absorption: {gauge: front}}\ninstruments: {wave_gauges: [{name: front, position: [0.4]}]}",
              {"absorption/gauge is front, which stands 0.3 m behind the paddle's front"}},
        Fault{"AbsorbingFlap",
              "period: 1.2",
              "period: 1.2, direction: pitch, absorption: {gauge: front}",
              {"waves/absorption is for pistons; leave it out"}}),
    [](const testing::TestParamInfo<Fault>& info) { return info.param.name; });

TEST(Absorption, IsForTanksThatStand) {
  const std::string moving = replaced(sound, "  box: {size: [6, 1]}",
                                      "  box: {size: [6, 1]}\n  motion: prescribed\n  prescribed: {harmonics: [{direction: surge, "
                                      "amplitude: 0.1, frequency: 1}]}");
  const std::string message = error_of(replaced(moving, "period: 1.2", "period: 1.2, absorption: {gauge: front}"));
  EXPECT_TRUE(contains(message, "bodies/0/prescribed/waves/absorption is given, and tank/motion is not fixed")) << message;
}

const char* const at_start = R"(dimensions: 2
duration: 2
fluid:
  spacing: 0.05
  fill: [{box: {min: [0, 0], max: [6, 0.4]}}]
  initial:
    waves: {kind: linear, depth: 0.4, height: 0.02, wavelength: 3}
tank:
  box: {size: [6, 1]}
)";

const char* const linear = "waves: {kind: linear, depth: 0.4, height: 0.02, wavelength: 3}";

class BrokenStart : public testing::TestWithParam<Fault> {};

TEST_P(BrokenStart, IsRefusedInOneClearSentence) { expect_refused(at_start, GetParam()); }

INSTANTIATE_TEST_SUITE_P(
    Faults, BrokenStart,
    testing::Values(
        Fault{"NeitherLengthNorPeriod", ", wavelength: 3", "", {"case.yaml:7: fluid/initial/waves/wavelength is missing"}},
        Fault{"LengthAndPeriod", "wavelength: 3", "wavelength: 3, period: 1", {"case.yaml:7: fluid/initial/waves/period is given beside"}},
        Fault{"SolitaryOfALength", "linear", "solitary", {"case.yaml:7: fluid/initial/waves/wavelength is not for a solitary wave"}},
        Fault{"StandingOfSecondOrder", "kind: linear", "kind: stokes_2, standing: true", {"fluid/initial/waves/standing is of linear"}},
        Fault{"Upwards",
              "wavelength: 3",
              "wavelength: 3, direction: [0, 1]",
              {"fluid/initial/waves/direction is [0, 0, 1]; it must be level"}},
        Fault{"AsHighAsMcCowan",
              linear,
              "waves: {kind: solitary, depth: 0.4, height: 0.32}",
              {"case.yaml:7: fluid/initial/waves/height is 0.32 m, with which they would break: higher than McCowan's 0.78 of the depth, "
               "0.312 m; make it less"}},
        Fault{"AsSteepAsMiche",
              "height: 0.02, wavelength: 3",
              "height: 0.1, wavelength: 0.5",
              {"case.yaml:7: fluid/initial/waves/height is 0.1 m, with which they would break: higher than Miche's 0.142 L tanh kd, "
               "0.07099"}},
        Fault{"BesideAnExpression",
              linear,
              "waves: {kind: linear, depth: 0.4, height: 0.02, wavelength: 3}\n    u: x",
              {"case.yaml:8: fluid/initial/u is given beside fluid/initial/waves"}},
        Fault{"Settling",
              "tank:",
              "numerics: {packing: {settling: 1}}\ntank:",
              {"case.yaml:8: numerics/packing/settling is above 0, with which the water comes to rest, and fluid/initial/waves is given"}},
        Fault{"TwoLevels",
              "max: [6, 0.4]}}]",
              "max: [3, 0.4]}}, {box: {min: [3, 0], max: [6, 0.3]}}]",
              {"fluid/fill/1 is filled to another level than fluid/fill/0"}},
        Fault{"SidewaysGravity",
              "duration: 2",
              "duration: 2\ngravity: [9.81, 0]",
              {"fluid/initial/waves is given, which is for gravity along −z"}},
        Fault{"NoWholeWavesInAPeriodicTank",
              "box: {size: [6, 1]}",
              "box: {size: [6.5, 1]}\n  periodic: [x]",
              {"case.yaml:7: fluid/initial/waves/wavelength is of waves 3 m long, of which the tank, periodic along x, holds 2.1666",
               "in its 6.5 m; it must hold a whole number of them"}},
        Fault{"ElevationOfHeight",
              linear,
              "elevation: 0.1*z",
              {"case.yaml:7: fluid/initial/elevation: \"0.1*z\" is no expression of x and y"}},
        Fault{
            "ElevationThatIsNone", linear, "elevation: 0.1*sin(", {"case.yaml:7: fluid/initial/elevation: \"0.1*sin(\" is no expression"}}),
    [](const testing::TestParamInfo<Fault>& info) { return info.param.name; });

TEST(WavesAtTheStart, FitAPeriodicTank) {
  const std::string periodic = replaced(at_start, "box: {size: [6, 1]}", "box: {size: [6, 1]}\n  periodic: [x]");
  EXPECT_EQ(error_of(periodic), "(no error)");
  EXPECT_EQ(error_of(replaced(periodic, linear, "waves: {kind: linear, depth: 0.4, height: 0.02, wavelength: 2.9999}")), "(no error)");
  // β = √(3H/(4d²(d + H))) = 0.968/m: after 1 m 44 % of the height, after 5 m 0.03 %
  const std::string solitary = replaced(periodic, "size: [6, 1]", "size: [10, 1]");
  EXPECT_EQ(error_of(replaced(solitary, linear, "waves: {kind: solitary, depth: 0.4, height: 0.1, crest: 5}")), "(no error)");
  const std::string message = error_of(replaced(solitary, linear, "waves: {kind: solitary, depth: 0.4, height: 0.1, crest: 1}"));
  EXPECT_TRUE(contains(message, "fluid/initial/waves/crest is 1 m, with which the solitary wave is 0.04")) << message;
  EXPECT_TRUE(contains(message, "m high at x = 0 m, an end of the periodic tank")) << message;
}

TEST(WavesAtTheStart, AreReadAndWritten) {
  EXPECT_EQ(error_of(at_start), "(no error)");
  for (const std::string& waves :
       {std::string(linear), std::string("waves: {kind: solitary, depth: 0.4, height: 0.1, direction: [-1, 0], crest: -2}"),
        std::string("waves: {kind: linear, depth: 0.4, height: 0.02, period: 1.5, standing: true}"),
        std::string("waves: {kind: stokes_2, depth: 0.4, height: 0.02, period: 1.5}"), std::string("elevation: 0.01*cos(x)")}) {
    const Case read = read_case_text(replaced(at_start, linear, waves), "case.yaml", {});
    const std::string written = write_case(read);
    EXPECT_EQ(write_case(read_case_text(written, "again.yaml", {})), written) << waves;
    EXPECT_EQ(read.fluid.initial.waves.has_value(), read.fluid.initial.elevation.empty()) << waves;
  }
}

TEST(Waves, AreReadAndWritten) {
  EXPECT_EQ(error_of(sound), "(no error)");
  for (const std::string waves :
       {std::string(regular), std::string("{kind: irregular, depth: 0.4, significant_height: 0.1, peak_period: 1.5, seed: 7, rise: 3}"),
        std::string(
            "{kind: focused, depth: 0.4, height: 0.1, peak_period: 1.5, focus: {distance: 3, time: 12}, spectrum: pierson_moskowitz}"),
        std::string("{kind: solitary, depth: 0.4, height: 0.1, reversed: true}"),
        std::string("{kind: regular, depth: 0.4, height: 0.1, period: 1, direction: pitch, hinge: -0.2}"),
        std::string("{kind: regular, depth: 0.4, height: 0.1, period: 1, order: 2}"),
        std::string("{kind: regular, depth: 0.4, height: 0.1, period: 1, absorption: {gauge: front, recall: 6, reach: 0.05}}")}) {
    const Case read =
        read_case_text(replaced(sound, regular, waves) + "instruments: {wave_gauges: [{name: front, position: [0.4]}]}\n", "case.yaml", {});
    ASSERT_TRUE(read.bodies[0].rigid.prescribed.waves) << waves;
    const Case again = read_case_text(write_case(read), "again.yaml", {});
    EXPECT_EQ(write_case(again), write_case(read)) << waves;
    const WaveCase &first = *read.bodies[0].rigid.prescribed.waves, &second = *again.bodies[0].rigid.prescribed.waves;
    EXPECT_EQ(second.kind, first.kind);
    EXPECT_EQ(second.direction, first.direction);
    EXPECT_EQ(second.reversed, first.reversed);
    EXPECT_EQ(second.order, first.order);
    EXPECT_EQ(second.seed, first.seed);
    EXPECT_EQ(second.rise, first.rise);
    EXPECT_EQ(second.hinge, first.hinge);
    EXPECT_EQ(second.spectrum, first.spectrum);
    EXPECT_EQ(second.focus.time, first.focus.time);
    EXPECT_EQ(second.focus.distance, first.focus.distance);
    EXPECT_EQ(second.record.file, first.record.file);
    EXPECT_EQ(second.record.distance, first.record.distance);
    EXPECT_EQ(again.fluid.damping[0].velocity, Vector3d(0.1, 0, 0));
  }
  const Case read = read_case_text(sound, "case.yaml", {});
  const WaveCase& wave = *read.bodies[0].rigid.prescribed.waves;
  EXPECT_EQ(wave.height, 0.05);
  EXPECT_EQ(wave.order, 1);
  EXPECT_FALSE(wave.rise);
  ASSERT_EQ(read.fluid.damping.size(), 1u);
  EXPECT_EQ(read.fluid.damping[0].strength, 8);
}

}  // namespace
}  // namespace wavetank::wave_errors_test

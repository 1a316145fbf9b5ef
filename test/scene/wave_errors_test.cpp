// Waves by theory and damping zones that a case cannot have.
#include "broken_case.h"

namespace wavetank {
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
              {"fluid/damping/0/box/max is [4, 1]; it must be greater than"}}),
    [](const testing::TestParamInfo<Fault>& info) { return info.param.name; });

TEST(Waves, AreReadAndWritten) {
  EXPECT_EQ(error_of(sound), "(no error)");
  for (const std::string waves :
       {std::string(regular), std::string("{kind: irregular, depth: 0.4, significant_height: 0.1, peak_period: 1.5, seed: 7, rise: 3}"),
        std::string(
            "{kind: focused, depth: 0.4, height: 0.1, peak_period: 1.5, focus: {distance: 3, time: 12}, spectrum: pierson_moskowitz}"),
        std::string("{kind: solitary, depth: 0.4, height: 0.1, reversed: true}"),
        std::string("{kind: regular, depth: 0.4, height: 0.1, period: 1, direction: pitch, hinge: -0.2}"),
        std::string("{kind: regular, depth: 0.4, height: 0.1, period: 1, order: 2}")}) {
    const Case read = read_case_text(replaced(sound, regular, waves), "case.yaml", {});
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
}  // namespace wavetank

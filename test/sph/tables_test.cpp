// What the kernels know as fields and numbers is said once, in rows.
#include <cstring>
#include <sstream>

#include "../../src/sph/tables/device_sizes.h"
#include "../../src/sph/tables/fields.h"
#include "../../src/sph/tables/parameters.h"
#include "../common/error_of.h"
#include "sph_fixture.h"
#include "wavetank/sph/kernel_sources.h"

namespace wavetank::tables_test {
namespace {

constexpr ParticleArray state = ParticleArray::state, rates = ParticleArray::rates;

TEST(FieldTable, AddsRatesAndSumsOfWhatEvolves) {
  const FieldTable fields({{ParticleArray::state, {"salt"}, "kg", "dissolved", true, FieldRow::Evolution::conjugate},
                           {ParticleArray::state, {"heat"}, "", "of it", true, FieldRow::Evolution::follower}});
  EXPECT_EQ(fields.header(),
            "#define FIELD_SALT 0  // dissolved, kg\n#define FIELD_HEAT 1  // of it\n#define FIELD_COUNT 2\n"
            "#define RATE_SALT 0  // of change, kg/s\n#define RATE_HEAT 1  // of change, 1/s\n#define RATE_COUNT 2\n"
            "#define SUM_SALT 0  // of weighted rates of change, kg/s\n#define SUM_HEAT 1  // of weighted rates of change, 1/s\n"
            "#define SUM_COUNT 2\n#define EACH_CONJUGATE(DO) DO(SALT)\n#define EACH_FOLLOWER(DO) DO(HEAT)\n");
}

TEST(FieldTable, GivesEachComponentItsPlaceInItsArray) {
  const FieldTable fields({{state, {"x", "z"}, "m", "place"}, {rates, {"x"}, "m/s", "its rate"}, {state, {"salt"}, "", "dissolved"}});
  EXPECT_EQ(fields.at(state, "x"), 0);
  EXPECT_EQ(fields.at(state, "z"), 1);
  EXPECT_EQ(fields.at(state, "salt"), 2);
  EXPECT_EQ(fields.at(rates, "x"), 0);
  EXPECT_EQ(fields.count(state), 3);
  EXPECT_EQ(fields.count(rates), 1);
  EXPECT_EQ(fields.header(),
            "#define FIELD_X 0  // place, m\n#define FIELD_Z 1  // place, m\n#define FIELD_SALT 2  // dissolved\n#define FIELD_COUNT 3\n"
            "#define RATE_X 0  // its rate, m/s\n#define RATE_COUNT 1\n#define SUM_COUNT 0\n#define EACH_CONJUGATE(DO)\n#define "
            "EACH_FOLLOWER(DO)\n");
}

TEST(FieldTable, RefusesNamesThatAreTakenOrUnknown) {
  EXPECT_EQ(error_of([] {
              FieldTable({{state, {"x"}, "", ""}, {state, {"x"}, "", ""}});
            }),
            "two fields of the particles' state are called \"x\"");
  EXPECT_EQ(error_of([] { FieldTable({{state, {"x"}, "", ""}}).at(rates, "x"); }), "no field of the particles' rates is called \"x\"");
}

/// A size that a kernel file also gave a value of its own would be two truths.
TEST(DeviceSizes, AreOnlyInTheirRows) {
  const std::string header = sizes_header();
  EXPECT_NE(header.find("#define WALL_TANGENT_X 9  // along them\n"), std::string::npos);
  EXPECT_NE(header.find("#define SHIFT_MOST R(0.2"), std::string::npos);
  std::istringstream lines(header);
  int rows = 0;
  for (std::string line; std::getline(lines, line); ++rows) {
    const std::string start = line.substr(0, line.find(' ', 8) + 1);
    for (const auto& [file, text] : kernel_sources()) EXPECT_EQ(text.find(start), std::string::npos) << start << "in " << file;
  }
  EXPECT_GT(rows, 40);
}

TEST(Parameters, AreLaidOutAsTheDeviceDeclaresThem) {
  const auto value = [](double number) { return [number](const ParameterSource&) { return number; }; };
  const std::vector<ParameterRow> rows{{"steps", "", "how many", value(7), ParameterRow::Kind::integer},
                                       {"width", "m", "of it", value(0.5)}};
  EXPECT_EQ(parameters_header(rows), "real width;  // of it, m\nint steps;  // how many\n");
  const Tank tank(box_case(Vector3d(0.5, 0, 0.4), 0.25, 0.025));
  const ParameterSource source{tank.scene, tank.layout, tank.discretisation, {}, 0};
  ParameterBlock block(rows, source);
  const auto read = [&](auto real) {
    struct {
      decltype(real) width;
      int steps;
    } values{};
    const std::vector<char> bytes = block.bytes<decltype(real)>();
    EXPECT_EQ(bytes.size(), sizeof values);
    std::memcpy(&values, bytes.data(), sizeof values);
    EXPECT_EQ(values.width, decltype(real)(block.at("width")));
    EXPECT_EQ(values.steps, 7);
  };
  block.set("width", 0.25);
  read(0.0F);
  read(0.0);
  EXPECT_EQ(error_of([&] { block.set("height", 1); }), "no parameter of the kernels is called \"height\"");
  EXPECT_EQ(error_of([&] { ParameterBlock({rows[0], rows[0]}, source); }), "two parameters of the kernels are called \"steps\"");
}

}  // namespace
}  // namespace wavetank::tables_test

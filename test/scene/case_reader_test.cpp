#include "wavetank/scene/case_reader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <locale>

#include "../common/scratch_directory.h"
#include "wavetank/common/error.h"

namespace wavetank::case_reader_test {

namespace {

const double pi = std::acos(-1.0);

const char* const smallest = R"(
duration: 2
fluid: {spacing: 0.1, fill: [{box: {min: [0, 0, 0], max: [1, 1, 1]}}]}
tank: {box: {size: [2, 1, 2]}}
)";

const char* const smallest_flat = R"(
dimensions: 2
gravity: [0, -9.81]
duration: 2
fluid: {spacing: 0.1, fill: [{box: {min: [0, 0], max: [1, 1]}}]}
tank: {box: {size: [2, 2]}}
)";

// Every key with a value that is not its default.
const char* const everything = R"(title: "A title: with a colon, # and \"quotes\""
dimensions: 3
gravity: [0.1, 0.2, -1.62]
duration: 0.3333333333333333
device: "0:1"
fluid:
  density: 998.2
  viscosity: 8.94e-4
  sound_speed: 41.5
  particles: 20000
  fill:
    - {box: {min: [0.1, 0.2, 0.3], max: [1.1, 1.2, 1.3]}}
    - {seed: [2, 0.5, 0.1], level: 0.4}
tank: {mesh: meshes/hull.stl, scale: 0.001, translation: [1, 2, 3], rotation: [90, -45, 30]}
bodies:
  - {name: pier, box: {min: [0.4, 0.4, 0], max: [0.6, 0.6, 0.5]}, motion: fixed}
  - {name: hull, mesh: "package://some where/hull.obj", scale: 2, rotation: [0, 0, 180]}
numerics:
  scheme: delta_sph
  support: 3.5
  walls: {method: boundary_integral, shepard: geometric, elements: numerical, slip: free_slip, guard_distance: 0.2}
  density_diffusion: antuono
  density_diffusion_coefficient: 0.2
  artificial_viscosity: 0.05
  equation_of_state: cole
  viscosity_model: morris
  negative_pressure: clamped
  shifting: none
  integrator: symplectic
  courant: 0.3
  precision: double
  packing: {iterations: 20}
instruments:
  pressure_probes: [{name: P1, position: [0.1, 0.2, 0.3]}, {name: P2, position: [1, 2, 3]}]
  wave_gauges: [{name: H1, position: [0.7, 0.8]}, {name: H2, position: [0.5, 0.6, 9]}]
  velocity_probes: [{name: V1, position: [0.4, 0.5, 0.6]}, {name: V2, position: [1, 2, 3], body: pier}]
  sections:
    - {name: gap, centre: [0.5, 0.4, 0.3], normal: [2, 0, 0], size: [0.6, 0.7], up: [0, 1, 0]}
    - {name: hole, centre: [0.5, 0.4, 0.3], normal: [0, 0, 1], diameter: 0.2}
  rate: 500
  gauge_rate: 100
  wrench_rate: 250
  energy_rate: 50
rates: {cloud: 10, cloud_bag: 25}
max_points: 1000
reference_pressure: 101325
world_frame: basin/floor
publish_clock: true
real_time_factor: 0.5
)";

void expect_close(const Vector3d& value, const Vector3d& expected) {
  EXPECT_LT((value - expected).norm(), 1e-14) << value.transpose() << " is not " << expected.transpose();
}

void expect_everything(const Case& read, const std::string& mesh) {
  EXPECT_EQ(read.title, "A title: with a colon, # and \"quotes\"");
  EXPECT_EQ(read.dimensions, 3);
  expect_close(read.gravity, {0.1, 0.2, -1.62});
  EXPECT_DOUBLE_EQ(read.duration, 1.0 / 3.0);
  EXPECT_EQ(read.device, "0:1");
  EXPECT_DOUBLE_EQ(read.fluid.density, 998.2);
  EXPECT_DOUBLE_EQ(read.fluid.viscosity, 8.94e-4);
  EXPECT_EQ(read.fluid.sound_speed, 41.5);
  EXPECT_EQ(read.fluid.particles, 20000u);
  EXPECT_FALSE(read.fluid.spacing);
  ASSERT_EQ(read.fluid.fill.size(), 2u);
  expect_close(std::get<Box>(read.fluid.fill[0]).min, {0.1, 0.2, 0.3});
  expect_close(std::get<Box>(read.fluid.fill[0]).max, {1.1, 1.2, 1.3});
  expect_close(std::get<FloodFill>(read.fluid.fill[1]).seed, {2, 0.5, 0.1});
  EXPECT_DOUBLE_EQ(std::get<FloodFill>(read.fluid.fill[1]).level, 0.4);
  const auto& tank = std::get<MeshSource>(read.tank.shape);
  EXPECT_EQ(tank.uri, mesh);
  EXPECT_EQ(tank.scale, Vector3d::Constant(0.001));
  expect_close(tank.translation, {1, 2, 3});
  expect_close(tank.rotation, {pi / 2, -pi / 4, pi / 6});
  ASSERT_EQ(read.bodies.size(), 2u);
  EXPECT_EQ(read.bodies[0].name, "pier");
  expect_close(std::get<Box>(read.bodies[0].shape).max, {0.6, 0.6, 0.5});
  EXPECT_EQ(std::get<MeshSource>(read.bodies[1].shape).uri, "package://some where/hull.obj");
  expect_close(std::get<MeshSource>(read.bodies[1].shape).rotation, {0, 0, pi});
  EXPECT_EQ(read.numerics.support, 3.5);
  EXPECT_EQ(read.numerics.walls.slip, Slip::free_slip);
  EXPECT_DOUBLE_EQ(read.numerics.walls.guard_distance, 0.2);
  EXPECT_EQ(read.numerics.density_diffusion, DensityDiffusion::antuono);
  EXPECT_DOUBLE_EQ(read.numerics.density_diffusion_coefficient, 0.2);
  EXPECT_DOUBLE_EQ(read.numerics.artificial_viscosity, 0.05);
  EXPECT_EQ(read.numerics.equation_of_state, EquationOfState::cole);
  EXPECT_EQ(read.numerics.viscosity_model, ViscosityModel::morris);
  EXPECT_EQ(read.numerics.negative_pressure, NegativePressure::clamped);
  EXPECT_DOUBLE_EQ(read.numerics.courant, 0.3);
  EXPECT_EQ(read.numerics.precision, Precision::double_);
  EXPECT_EQ(read.numerics.packing.iterations, 20);
  ASSERT_EQ(read.instruments.pressure_probes.size(), 2u);
  EXPECT_EQ(read.instruments.pressure_probes[1].name, "P2");
  expect_close(read.instruments.pressure_probes[1].position, {1, 2, 3});
  ASSERT_EQ(read.instruments.wave_gauges.size(), 2u);
  expect_close(read.instruments.wave_gauges[0].position, {0.7, 0.8, 0});
  expect_close(read.instruments.wave_gauges[1].position, {0.5, 0.6, 0});
  ASSERT_EQ(read.instruments.velocity_probes.size(), 2u);
  EXPECT_EQ(read.instruments.velocity_probes[0].name, "V1");
  expect_close(read.instruments.velocity_probes[0].position, {0.4, 0.5, 0.6});
  EXPECT_EQ(read.instruments.velocity_probes[1].body, "pier");
  ASSERT_EQ(read.instruments.sections.size(), 2u);
  const FlowSectionCase& gap = read.instruments.sections[0];
  EXPECT_EQ(gap.name, "gap");
  expect_close(gap.centre, {0.5, 0.4, 0.3});
  expect_close(gap.normal, {2, 0, 0});
  EXPECT_EQ(gap.size, (std::array<double, 2>{0.6, 0.7}));
  expect_close(gap.up.value(), {0, 1, 0});
  EXPECT_FALSE(gap.diameter);
  EXPECT_EQ(read.instruments.sections[1].diameter, 0.2);
  EXPECT_DOUBLE_EQ(read.instruments.rate, 500);
  EXPECT_EQ(read.instruments.gauge_rate, 100);
  EXPECT_EQ(read.instruments.wrench_rate, 250);
  EXPECT_EQ(read.instruments.energy_rate, 50);
  EXPECT_DOUBLE_EQ(read.publishing.cloud_rate, 10);
  EXPECT_DOUBLE_EQ(read.publishing.cloud_bag_rate, 25);
  EXPECT_EQ(read.publishing.max_points, 1000);
  EXPECT_DOUBLE_EQ(read.publishing.reference_pressure, 101325);
  EXPECT_EQ(read.publishing.world_frame, "basin/floor");
  EXPECT_TRUE(read.publishing.publish_clock);
  EXPECT_DOUBLE_EQ(read.publishing.real_time_factor, 0.5);
}

}  // namespace

TEST(CaseReader, ReadsEveryKey) { expect_everything(read_case_text(everything, "everything"), "meshes/hull.stl"); }

TEST(CaseReader, WritesWhatItReads) {
  const ScratchDirectory scratch;
  const std::string mesh = scratch.write("meshes/hull.stl", "something");
  Case read = read_case_text(everything, "everything");
  read.directory = scratch.path();
  const std::string written = write_case(read);
  const Case again = read_case_text(written, "written");
  expect_everything(again, mesh);
  EXPECT_EQ(write_case(again), written);
}

TEST(CaseReader, FillsInTheStructsDefaults) {
  const Case read = read_case_text(smallest, "smallest"), defaults;
  EXPECT_EQ(read.dimensions, defaults.dimensions);
  EXPECT_EQ(read.gravity, defaults.gravity);
  EXPECT_EQ(read.fluid.density, defaults.fluid.density);
  EXPECT_FALSE(read.fluid.sound_speed);
  EXPECT_FALSE(read.numerics.support);
  EXPECT_EQ(read.instruments.rate, defaults.instruments.rate);
  EXPECT_FALSE(std::get<BoxTank>(read.tank.shape).closed);
  const std::string written = write_case(read);
  for (const char* line : {"sound_speed: auto", "support: auto", "gauge_rate: auto", "courant: 0.5", "bodies: []", "world_frame: tank"}) {
    EXPECT_NE(written.find(line), std::string::npos) << line;
  }
}

TEST(CaseReader, FlatPositionsAreInTheXZPlane) {
  const Case read = read_case_text(std::string(smallest_flat) + R"(
bodies: [{name: pier, box: {min: [0.5, -7, 0], max: [0.6, -8, 0.3]}}]
instruments:
  pressure_probes: [{name: P1, position: [0.1, 0.3]}, {name: P2, position: [0.1, 5, 0.3]}]
  wave_gauges: [{name: H1, position: [0.5]}, {name: H2, position: [0.5, 2]}, {name: H3, position: [0.5, 1, 2]}]
)",
                                   "flat");
  EXPECT_EQ(read.gravity, Vector3d(0, 0, -9.81));
  EXPECT_EQ(std::get<Box>(read.fluid.fill[0]).max, Vector3d(1, 0, 1));
  EXPECT_EQ(std::get<BoxTank>(read.tank.shape).size, Vector3d(2, 0, 2));
  EXPECT_EQ(std::get<Box>(read.bodies[0].shape).max, Vector3d(0.6, 0, 0.3));
  for (const auto& probe : read.instruments.pressure_probes) EXPECT_EQ(probe.position, Vector3d(0.1, 0, 0.3)) << probe.name;
  for (const auto& gauge : read.instruments.wave_gauges) EXPECT_EQ(gauge.position, Vector3d(0.5, 0, 0)) << gauge.name;
  EXPECT_EQ(write_case(read_case_text(write_case(read), "written")), write_case(read));
}

// Parameters come back sorted by name, with numbers as whole ones, and with 1e-3 as text where YAML 1.1 does not see a number.
TEST(CaseReader, ReadsWhatTheParameterServerMakesOfACase) {
  const Case read = read_case_text(
      R"({"bodies": [], "dimensions": 2, "duration": 2, "fluid": {"fill": [{"box": {"max": [1, 1], "min": [0, 0]}}], "spacing": "5e-2"},)"
      R"( "gravity": [0, -10], "publish_clock": True, "tank": {"box": {"size": [2, 2]}}, "title": 2005})",
      "/wavetank");
  EXPECT_EQ(read.fluid.spacing, 0.05);
  EXPECT_EQ(read.gravity, Vector3d(0, 0, -10));
  EXPECT_TRUE(read.publishing.publish_clock);
  EXPECT_EQ(read.title, "2005");
}

TEST(CaseReader, EveryDemoCaseReads) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(WAVETANK_SOURCE_DIRECTORY) + "/config")) {
    if (entry.path().extension() != ".yaml") continue;
    SCOPED_TRACE(entry.path());
    ++count;
    const Case read = read_case_file(entry.path().string());
    EXPECT_FALSE(read.title.empty());
    EXPECT_GT(read.instruments.pressure_probes.size() + read.instruments.wave_gauges.size(), 0u) << "a demo measures something";
    EXPECT_EQ(read.directory, entry.path().parent_path().string());
    EXPECT_EQ(write_case(read_case_text(write_case(read), "written")), write_case(read));
  }
  EXPECT_GE(count, 4);
}

TEST(CaseReader, DamBreakHasTheExperimentsProbes) {
  const Case read = read_case_file(std::string(WAVETANK_SOURCE_DIRECTORY) + "/config/dam_break_3d.yaml");
  const auto& probes = read.instruments.pressure_probes;
  ASSERT_EQ(probes.size(), 8u);
  const double heights[] = {0.021, 0.061, 0.101, 0.141};
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(probes[i].name, "P" + std::to_string(i + 1));
    expect_close(probes[i].position, {0.8245, 0.4745, heights[i]});
    EXPECT_EQ(probes[i + 4].name, "P" + std::to_string(i + 5));
    expect_close(probes[i + 4].position, {0.8245 - heights[i], 0.4745, 0.161});
  }
  EXPECT_NEAR(*read.fluid.spacing, 0.55 / 30, 1e-8);
  EXPECT_EQ(read.fluid.sound_speed, 25.0);
  EXPECT_EQ(read.fluid.density, 998.0);
}

TEST(CaseReader, NumbersDoNotDependOnTheLocale) {
  struct DecimalComma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };
  const std::locale before = std::locale::global(std::locale(std::locale(), new DecimalComma));
  const Case read = read_case_text(smallest, "smallest", {{"fluid/density", "1025.5"}, {"max_points", "50000"}});
  const std::string written = write_case(read), page = describe_case_keys();
  std::locale::global(before);
  EXPECT_EQ(read.fluid.density, 1025.5);
  EXPECT_NE(written.find("density: 1025.5\n"), std::string::npos);
  EXPECT_NE(written.find("max_points: 50000\n"), std::string::npos);
  EXPECT_EQ(page, describe_case_keys());
}

TEST(Overrides, ReplaceAndAddKeys) {
  const Case read = read_case_text(smallest, "smallest",
                                   {{"fluid/density", "1025"},
                                    {"fluid/fill/0/box/max", "[1, 1, 0.5]"},
                                    {"fluid/fill/0/box/max/0", "0.7"},
                                    {"numerics/walls/slip", "free_slip"},
                                    {"instruments/pressure_probes/0", "{name: P1, position: [0, 0, 0]}"},
                                    {"instruments/pressure_probes/1/name", "P2"},
                                    {"instruments/pressure_probes/1/position", "[0, 0, 0.1]"},
                                    {"bodies", "[{name: pier, box: {min: [0, 0, 0], max: [1, 1, 1]}}]"}});
  EXPECT_EQ(read.fluid.density, 1025);
  EXPECT_EQ(std::get<Box>(read.fluid.fill[0]).max, Vector3d(0.7, 1, 0.5));
  EXPECT_EQ(read.numerics.walls.slip, Slip::free_slip);
  ASSERT_EQ(read.instruments.pressure_probes.size(), 2u);
  EXPECT_EQ(read.instruments.pressure_probes[1].name, "P2");
  EXPECT_EQ(read.bodies.at(0).name, "pier");
}

TEST(Overrides, OneAlternativeReplacesTheOther) {
  const Case counted = read_case_text(smallest, "smallest", {{"fluid/particles", "5000"}});
  EXPECT_EQ(counted.fluid.particles, 5000u);
  EXPECT_FALSE(counted.fluid.spacing);
  const Case spaced = read_case_text(everything, "everything", {{"fluid/spacing", "0.02"}, {"fluid/sound_speed", "auto"}});
  EXPECT_EQ(spaced.fluid.spacing, 0.02);
  EXPECT_FALSE(spaced.fluid.particles);
  EXPECT_FALSE(spaced.fluid.sound_speed);
  const Case boxed = read_case_text(everything, "everything", {{"tank/box/size", "[5, 5, 5]"}});
  EXPECT_EQ(std::get<BoxTank>(boxed.tank.shape).size, Vector3d(5, 5, 5));
}

TEST(Overrides, WriteASettledCaseWithBothSpacingAndParticles) {
  Case settled = read_case_text(smallest, "smallest");
  settled.fluid.particles = 1000;
  EXPECT_EQ(read_case_text(write_case(settled), "written").fluid.spacing, 0.1);
}

TEST(CaseReader, RiemannSchemesHaveNoOtherDissipationUnlessItIsGiven) {
  const Case plain = read_case_text(smallest, "smallest", {{"numerics/scheme", "riemann_parshikov"}});
  EXPECT_EQ(plain.numerics.density_diffusion, DensityDiffusion::none);
  EXPECT_EQ(plain.numerics.artificial_viscosity, 0);
  const Case given = read_case_text(smallest, "smallest", {{"numerics/scheme", "riemann_ale"}, {"numerics/artificial_viscosity", "0.01"}});
  EXPECT_EQ(given.numerics.density_diffusion, DensityDiffusion::none);
  EXPECT_EQ(given.numerics.artificial_viscosity, 0.01);
  EXPECT_EQ(read_case_text(smallest, "smallest").numerics.density_diffusion, DensityDiffusion::fourtakas);
}

TEST(CaseReader, TheAcousticDamperIsOnWithDeltaSphAndTheSymplecticIntegrator) {
  const auto damping = [](const std::vector<Override>& set) { return read_case_text(smallest, "smallest", set).numerics.acoustic_damping; };
  EXPECT_EQ(damping({}), 2);
  EXPECT_EQ(damping({{"numerics/acoustic_damping", "0"}}), 0);
  EXPECT_EQ(damping({{"numerics/scheme", "riemann_parshikov"}}), 0);
  EXPECT_EQ(damping({{"numerics/scheme", "riemann_ale"}, {"numerics/acoustic_damping", "1"}}), 1);
  EXPECT_EQ(damping({{"numerics/integrator", "runge_kutta_4"}}), 0);
}

TEST(CaseReader, ReadsFrictionAndSensorsAndWritesThemBack) {
  const Case read = read_case_text(
      smallest, "smallest",
      {{"numerics/walls/friction/law", "law_of_the_wall"},
       {"numerics/walls/friction/roughness", "0.002"},
       {"numerics/turbulence", "smagorinsky"},
       {"bodies/0", "{name: hull, box: {min: [0, 0, 0], max: [0.5, 0.5, 0.5]}, skin_friction: {law: coefficient, coefficient: 0.004}}"},
       {"instruments/pressure_probes/0", "{name: P, position: [0, 0.5, 0.5], diameter: 0.02}"}});
  for (const Case& scene : {read, read_case_text(write_case(read), "written")}) {
    EXPECT_EQ(friction_of(scene, 0).law, FrictionLaw::law_of_the_wall);
    EXPECT_EQ(friction_of(scene, 0).roughness, 0.002);
    EXPECT_EQ(friction_of(scene, 1).law, FrictionLaw::coefficient);
    EXPECT_EQ(friction_of(scene, 1).coefficient, 0.004);
    EXPECT_EQ(scene.numerics.turbulence, Turbulence::smagorinsky);
    EXPECT_EQ(scene.instruments.pressure_probes[0].diameter, 0.02);
  }
}

TEST(CaseReader, ReadsInitialFieldsAndWritesThemBack) {
  const std::string text = std::string(smallest) + "numerics: {shifting: michel, tensile: plain, expected_speed: 2.5}\n";
  const Case read = read_case_text(text, "smallest", {{"fluid/initial/u", "sin(2*pi*x)"}, {"fluid/initial/pressure", "1000*9.81*(1 - z)"}});
  EXPECT_EQ(read.fluid.initial.u, "sin(2*pi*x)");
  EXPECT_EQ(read.fluid.initial.w, "");
  EXPECT_EQ(read.numerics.shifting, Shifting::michel);
  EXPECT_EQ(read.numerics.expected_speed, 2.5);
  const Case again = read_case_text(write_case(read), "written");
  EXPECT_EQ(again.fluid.initial.pressure, "1000*9.81*(1 - z)");
  EXPECT_EQ(again.numerics.tensile, Tensile::plain);
}

}  // namespace wavetank::case_reader_test

// A field, a number and a reported value are each one row, which nothing else needs to know of.
#include "../../src/sph/tables/rows.h"

#include "../common/error_of.h"
#include "sph_fixture.h"

namespace wavetank::rows_test {
namespace {

const FieldRow salt{ParticleArray::state, {"salt"}, "", "of a particle", true};
const ParameterRow salinity{"salinity", "", "of salt", [](const ParameterSource& source) { return 2 * source.scene.fluid.density; }};
const ReportRow highest_pressure{"highest_pressure", ReportRow::Kind::greatest, "Pa", "of all", "state[FIELD_PRESSURE * stride + i]"};
const ReportRow saltiest{"saltiest", ReportRow::Kind::greatest, "", "of all", "p->salinity * state[FIELD_SALT * stride + i]"};
const ReportRow fresh{"fresh", ReportRow::Kind::count, "", "particles without salt", "state[FIELD_SALT * stride + i] == R(0.0) ? 1 : 0"};
const ReportRow first_fresh{"first_fresh", ReportRow::Kind::first, "", "of those", "state[FIELD_SALT * stride + i] == R(0.0)"};

class Rows : public ::testing::Test {
 protected:
  Rows() {
    SolverRows rows;
    rows.fields.push_back(salt);
    rows.parameters.push_back(salinity);
    for (const ReportRow& row : {highest_pressure, saltiest, fresh, first_fresh}) rows.reports.push_back(row);
    Case scene = box_case(Vector3d(0.6, 0, 0.4), 0.25, 0.025);
    scene.fluid.fill = {Box{Vector3d::Zero(), Vector3d(0.2, 0, 0.3)}};
    const Layout layout = lay_out(scene);
    const Case settled_case = settled(scene, layout);
    solver = make_solver_of(rows, test_device(), settled_case, layout, discretise(settled_case, layout), {Vector3d::Zero()});
    density = settled_case.fluid.density;
  }

  std::unique_ptr<Solver> solver;
  double density = 0;
};

TEST_F(Rows, AFieldGoesWithItsParticleAndIsSaved) {
  solver->start();
  StateBytes<float> before(*solver);
  for (std::size_t id = 0; id < before.count; ++id) before.set("salt", id, static_cast<double>(id) + 1);
  solver->restore(before.bytes());
  for (int k = 0; k < 100; ++k) ASSERT_TRUE(solver->advance().valid());
  const FluidState fluid = solver->download();
  bool sorted = false;
  for (std::size_t i = 0; i < fluid.id.size(); ++i) sorted = sorted || fluid.id[i] != i;
  EXPECT_TRUE(sorted) << "no particle has changed its place: nothing is shown";
  StateBytes<float> after(*solver);
  for (std::size_t id = 0; id < after.count; ++id) EXPECT_EQ(after.get("salt", id), id + 1.0F);
}

TEST(ReportTable, RefusesNamesThatAreTaken) {
  EXPECT_EQ(error_of([] {
              ReportTable({fresh, {"Fresh", ReportRow::Kind::greatest, "", "", "0"}});
            }),
            "two values of a step's report are called \"Fresh\"");
  EXPECT_EQ(error_of([] {
              ReportTable({{"count", ReportRow::Kind::count, "", "", "0"}});
            }),
            "no value of a step's report may be called \"count\": it is how many there are");
}

TEST_F(Rows, AStepReportsTheValues) {
  solver->start();
  StateBytes<float> state(*solver);
  for (std::size_t id = 0; id < state.count; ++id) state.set("salt", id, id % 5 == 0 ? 0.0 : static_cast<double>(id));
  solver->restore(state.bytes());
  const StepReport report = solver->advance();
  ASSERT_TRUE(report.valid());
  const FluidState fluid = solver->download();
  double highest = 0, first = -1;
  for (std::size_t i = 0; i < fluid.id.size(); ++i) {
    highest = std::max(highest, fluid.pressure[i]);
    if (first < 0 && fluid.id[i] % 5 == 0) first = static_cast<double>(i);
  }
  EXPECT_EQ(report.more.at("highest_pressure"), highest);
  const std::size_t last = state.count - 1, most = last % 5 == 0 ? last - 1 : last;
  EXPECT_FLOAT_EQ(static_cast<float>(report.more.at("saltiest")), static_cast<float>(2 * density * static_cast<double>(most)));
  EXPECT_EQ(report.more.at("fresh"), static_cast<double>((state.count + 4) / 5));
  EXPECT_EQ(report.more.at("first_fresh"), first);
  EXPECT_EQ(report.more.size(), 4u);
}

/// The explicit midpoint rule: a step of any length of a free fall is exact.
Schedule midpoint(const Case&, StepEngine* engine) {
  return {"midpoint",
          state_of("now") + at("now", {"walls"}),
          {{"rates of the start", state_of("now") + at("now", {"walls"}), at("now", {"acceleration", "compression rate"}),
            [engine] {
              engine->find_accelerations(Slot::now);
              engine->find_compression_rates(Slot::now);
            },
            0, true},
           {"to the middle", state_of("now") + at("now", {"acceleration", "compression rate"}),
            state_of("middle") + at("step", {"sum of rates"}), [engine] { engine->go_on_trial(Slot::now, true, 0.0, 0.5); }, 0.5},
           {"rates of the middle", state_of("middle") + at("now", {"walls"}), at("middle", {"acceleration", "compression rate"}),
            [engine] {
              engine->find_accelerations(Slot::trial);
              engine->find_compression_rates(Slot::trial);
            },
            0.5, true},
           {"to the end", state_of("now") + at("step", {"sum of rates"}) + at("middle", {"velocity", "acceleration", "compression rate"}),
            state_of("now"), [engine] { engine->take_sum(1.0); }, 1},
           sort_stage(engine)}};
}

TEST(IntegratorRow, IsAScheduleOfTheEnginesStages) {
  SolverRows rows;
  rows.integrator = midpoint;
  Case scene = box_case(Vector3d(1, 0, 1), 0.5, 0.05);
  scene.numerics.precision = Precision::double_;
  const Layout layout = loose_particles({Vector3d::Zero(), Vector3d(1, 0, 1)}, 0.05, {Vector3d(0.5, 0, 0.5)}, 2);
  scene = settled(scene, layout);
  const auto solver = make_solver_of(rows, test_device(), scene, layout, discretise(scene, layout), {Vector3d::Zero()});
  const double step = solver->start().time_step;
  ASSERT_TRUE(solver->advance().valid());
  const FluidState fluid = solver->download();
  EXPECT_NEAR(fluid.position[0].z() - 0.5, -0.5 * 9.81 * step * step, 1e-9 * step);
  EXPECT_NEAR(fluid.velocity[0].z(), -9.81 * step, 1e-9);
}

TEST(IntegratorRow, IsCheckedWhenTheSolverIsMade) {
  SolverRows rows;
  rows.integrator = [](const Case&, StepEngine*) {
    return Schedule("hasty", state_of("now"), {{"to the end", at("step", {"sum of rates"}), state_of("now"), [] {}, 1}});
  };
  Case scene = box_case(Vector3d(1, 0, 1), 0.5, 0.05);
  const Layout layout = lay_out(scene);
  scene = settled(scene, layout);
  const std::string message =
      error_of([&] { make_solver_of(rows, test_device(), scene, layout, discretise(scene, layout), {Vector3d::Zero()}); });
  EXPECT_EQ(message, "integrator hasty: stage 'to the end' reads sum of rates (step), which no stage before it has written.");
}

/// Water whose pairs push each other with a constant pressure, and whose density does not change.
const char* const constant_pressure = R"(
typedef struct {
  tile nothing;
} scheme_own_t;

INLINE scheme_own_t scheme_own(__constant const parameters_t* p, const neighbours_t* n, __global const real* gradient, int first) {
  const scheme_own_t own = {(tile)(R(0.0))};
  return own;
}

typedef struct {
  tile pressure, divergence;
} exchange_t;

INLINE exchange_t pair_exchange(const scheme_own_t* own, __constant const parameters_t* p, const neighbours_t* n, __global const real* gradient,
                                const pair_t* pair) {
  const exchange_t exchange = {(tile)(p->constant_pressure), (tile)(R(0.0))};
  return exchange;
}
)";

TEST(SchemeRow, IsItsDeviceCodeAndWhatItBrings) {
  SolverRows rows;
  rows.methods = [](const Case& scene) {
    Methods methods = methods_of(scene);
    methods[0] = {"scheme", "constant_pressure"};
    methods[0].parameters = {{"constant_pressure", "Pa", "of every pair", [](const ParameterSource&) { return 4000.0; }}};
    methods[0].code = constant_pressure;
    return methods;
  };
  Case scene = box_case(Vector3d(1, 0, 1), 0.5, 0.05);
  scene.numerics.precision = Precision::double_;
  scene.numerics.density_diffusion = DensityDiffusion::none;
  scene.numerics.artificial_viscosity = 0;
  scene.fluid.viscosity = 0;
  scene.gravity = Vector3d::Zero();
  scene.fluid.sound_speed = 10;
  const double apart = 0.04, volume = 0.05 * 0.05;
  const Layout layout =
      loose_particles({Vector3d::Zero(), Vector3d(1, 0, 1)}, 0.05, {Vector3d(0.5, 0, 0.5), Vector3d(0.5 + apart, 0, 0.5)}, 2);
  scene = settled(scene, layout);
  const Discretisation d = discretise(scene, layout);
  const auto solver = make_solver_of(rows, test_device(), scene, layout, d, {Vector3d::Zero()});
  solver->start();
  const double step = solver->shorten_step(1e-4);
  ASSERT_TRUE(solver->advance().valid());
  // ρ du/dt = P F r V with F = 5 α/h² (1 − q/2)³, α = 7/(4 π h²)
  const double h = d.smoothing_length;
  const double slope = 5 * 7 / (4 * M_PI * h * h) / (h * h) * std::pow(1 - 0.5 * apart / h, 3);
  const double acceleration = 4000 * slope * apart * volume / 1000;
  const FluidState fluid = solver->download();
  for (std::size_t i = 0; i < 2; ++i) {
    const double sign = fluid.id[i] == 0 ? -1 : 1;
    EXPECT_NEAR(fluid.velocity[i].x(), sign * acceleration * step, 1e-6 * acceleration * step);
    EXPECT_EQ(fluid.compression[i], 0);
  }
}

}  // namespace
}  // namespace wavetank::rows_test

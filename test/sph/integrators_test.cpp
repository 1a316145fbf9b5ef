// Every integrator: its order on a smooth problem, bodies, and a restart to the same bits.
#include <cmath>

#include "periodic_square.h"

namespace wavetank::integrators_test {
namespace {

struct Expected {
  std::string word;
  Integrator integrator;
  double order;
};

std::vector<Expected> all_integrators() {
  std::vector<Expected> all;
  for (const MethodWord<Integrator>& known : method_words<Integrator>())
    all.push_back({known.word, known.choice, known.choice == Integrator::runge_kutta_4 ? 4.0 : 2.0});
  return all;
}

const std::vector<Expected> every_integrator = all_integrators();

NumericsCase of_integrator(Integrator integrator) {
  NumericsCase numerics;
  numerics.integrator = integrator;
  numerics.precision = Precision::double_;
  numerics.courant = 1.0;
  return numerics;
}

/// Of 20 by 20 particles, with a standing wave in it.
struct StandingWave : PeriodicSquare {
  explicit StandingWave(Integrator integrator) : PeriodicSquare(0.05, of_integrator(integrator)) {
    // a standing wave along x, at rest: s = S cos(2π x/L)
    StateBytes<double> state(*solver);
    for (std::size_t i = 0; i < state.count; ++i) {
      const double x = state.get("x", i) + discretisation.origin.x();
      const double compression = 0.01 * std::cos(2 * M_PI * x / side);
      state.set("compression", i, compression);
      state.set("pressure", i, scene.fluid.density * sound_speed * sound_speed * compression);
      state.set("volume", i, state.get("mass", i) / (scene.fluid.density * (1 + compression)));
    }
    solver->restore(state.bytes());
  }

  /// Velocities along x by id, after `steps` equal steps over a quarter of the wave's period.
  std::vector<double> after(int steps) {
    const double step = 0.25 * side / sound_speed / steps;
    solver->limit_time_step(step);
    solver->shorten_step(step);
    for (int k = 0; k < steps; ++k) {
      const StepReport report = solver->advance();
      EXPECT_NEAR(report.time_step, step, 1e-12 * step) << "the step is bounded by something else";
    }
    const FluidState fluid = solver->download();
    std::vector<double> speeds(fluid.id.size());
    for (std::size_t i = 0; i < fluid.id.size(); ++i) speeds[fluid.id[i]] = fluid.velocity[i].x();
    return speeds;
  }
};

double rms_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double square = 0;
  for (std::size_t i = 0; i < a.size(); ++i) square += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(square / static_cast<double>(a.size()));
}

TEST(Integrators, HaveTheirOrder) {
  if (!has_precision(Precision::double_)) GTEST_SKIP() << "needs double precision";
  const std::vector<double> exact = StandingWave(Integrator::runge_kutta_4).after(512);
  for (const auto& [word, integrator, order] : every_integrator) {
    const double coarse = rms_difference(StandingWave(integrator).after(32), exact);
    const double fine = rms_difference(StandingWave(integrator).after(64), exact);
    const double found = std::log2(coarse / fine);
    std::printf("%-20s error %.3e with 32 steps, %.3e with 64: order %.2f\n", word.c_str(), coarse, fine, found);
    EXPECT_NEAR(found, order, 0.2) << word;
  }
}

/// Water 10 spacings deep with a body under it that is driven.
Case tank_with_paddle(Integrator integrator) {
  Case scene = box_case(Vector3d(0.8, 0, 0.5), 0.25, 0.025);
  scene.numerics.integrator = integrator;
  BodyCase paddle{"paddle", Box{Vector3d(0.3, 0, 0.1), Vector3d(0.5, 0, 0.2)}, Motion::commanded};
  scene.bodies.push_back(paddle);
  return scene;
}

/// Moves the body upwards, and keeps what it is told.
class Carrier final : public WallMover {
 public:
  std::vector<int> coupled() const override { return {1}; }
  WallMotions at(double time_step, double fraction) override { return moved(fraction * time_step); }
  WallMotions to_end(double time_step, const std::vector<WallWrench>& wrenches) override {
    const WallMotions motions = moved(time_step);
    gone += speed * time_step;
    told = wrenches.at(0);
    return motions;
  }

  WallWrench told;

 private:
  WallMotions moved(double by) const {
    WallMotions motions;
    motions.owners.resize(2);
    motions.owners[1].velocity = Vector3d(0, 0, speed);
    motions.owners[1].displacement = Vector3d(0, 0, gone + speed * by);
    return motions;
  }
  static constexpr double speed = 0.01;  // m/s
  double gone = 0;                       // m
};

TEST(Integrators, GiveBodiesWhatTheWaterLoses) {
  for (const auto& [word, integrator, order] : every_integrator) {
    Tank tank(tank_with_paddle(integrator));
    tank.pack_and_start(100);
    tank.solver->settle(1, {});
    Carrier carrier;
    double mean = 0;
    constexpr int steps = 200;
    for (int k = 0; k < steps; ++k) {
      ASSERT_TRUE(tank.solver->advance(&carrier).valid()) << word;
      mean += carrier.told[0].z() / steps;
    }
    std::printf("%-20s a rising box is lifted by %.1f N; Archimedes' force is 196.2 N\n", word.c_str(), mean);
    EXPECT_NEAR(mean, 196.2, 10) << word;
  }
}

TEST(Integrators, RestartToTheSameBits) {
  for (const auto& [word, integrator, order] : every_integrator) {
    Tank tank(tank_with_paddle(integrator));
    tank.pack_and_start(20);
    for (int k = 0; k < 20; ++k) tank.solver->advance();
    const std::vector<char> saved = tank.solver->save();
    for (int k = 0; k < 20; ++k) tank.solver->advance();
    const std::vector<char> whole = tank.solver->save();
    tank.solver->restore(saved);
    for (int k = 0; k < 20; ++k) tank.solver->advance();
    EXPECT_TRUE(tank.solver->save() == whole) << word;
  }
}

}  // namespace
}  // namespace wavetank::integrators_test

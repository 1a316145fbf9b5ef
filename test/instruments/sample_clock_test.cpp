// Samples lie exactly on k / rate, each exactly once, whatever the steps are.
#include "../sph/sph_fixture.h"
#include "wavetank/instruments/recorder.h"

namespace wavetank::sample_clock_test {
namespace {

TEST(SampleClock, TicksAtMultiplesOfItsPeriodWithoutDrift) {
  SampleClock clock(1000);
  for (std::uint64_t k = 0; k < 2000000; ++k) {
    ASSERT_EQ(clock.next(), static_cast<double>(k) / 1000);
    clock.tick();
  }
  EXPECT_EQ(clock.next(), 2000.0);
  clock.set_index(7);
  EXPECT_EQ(clock.next(), 0.007);
}

/// A fluid whose pressure grows with time, to be sampled; nothing of it is computed.
class ClockedFluid final : public Solver {
 public:
  double time = 0;
  mutable int readings = 0;

  PackingReport pack(int, const std::function<void(double)>&) override { return {}; }
  StepReport start() override { return {}; }
  StepReport settle(double, const std::function<void(double)>&) override { return {}; }
  StepReport advance(WallMover*) override { return {}; }
  void set_wall_motions(const WallMotions&) override {}
  void set_film(const std::vector<FilmLump>&) override {}
  void limit_time_step(double) override {}
  double shorten_step(double) override { return 0; }
  std::size_t particle_count() const override { return 0; }
  void let_in(const NewParticles&) override {}
  void set_drains(const std::vector<Drain>&) override {}
  void set_zones(const std::vector<ImposedZone>&) override {}
  std::optional<ThinWall> thinnest_wall() const override { return {}; }
  std::unique_ptr<PointSet> make_points(const std::vector<Eigen::Vector3d>& points, PointValues) const override {
    auto set = std::make_unique<Points>();
    set->count = points.size();
    return set;
  }
  std::vector<PointValue> evaluate(const PointSet& points) override {
    ++readings;
    return std::vector<PointValue>(dynamic_cast<const Points&>(points).count, PointValue{5 + 100 * time, 0, 1});
  }
  std::vector<WallWrench> wrenches() override { return {}; }
  FluidEnergies energies() override { return {time, 0, 0, 1}; }
  LostVolume lost_volume() override { return {}; }
  FluidState download() override { return {}; }
  FluidSurface find_surface() override { return {}; }
  PairCount count_pairs() override { return {}; }
  std::vector<char> save() const override { return {}; }
  void restore(const std::vector<char>&) override {}
  std::size_t device_memory() const override { return 0; }

 private:
  struct Points final : PointSet {
    void set(const std::vector<Eigen::Vector3d>& points) override { count = points.size(); }
    std::size_t count = 0;
  };
};

class Sampling : public ::testing::Test {
 protected:
  Sampling() {
    scene.instruments.rate = 1000;
    scene.instruments.energy_rate = 30;
    scene.instruments.pressure_probes = {{"probe", Vector3d::Zero()}};
  }

  /// Records over the given steps.
  Samples record(const std::vector<double>& steps) {
    Recorder recorder(scene, layout, fluid, world);
    fluid.time = 0;
    recorder.start(fluid);
    for (const double step : steps) {
      const double time = fluid.time;
      recorder.before_step(fluid, time, time + step);
      fluid.time = time + step;
      recorder.after_step(fluid, time, fluid.time);
    }
    return recorder.take();
  }

  /// All of them, up to the fluid's time.
  void expect_clock(const Samples& samples) {
    const double end = fluid.time;
    const auto expected = [&](double rate) { return static_cast<std::size_t>(std::floor(end * rate)) + 1; };
    ASSERT_EQ(samples.pressures.size(), expected(1000));
    for (std::size_t k = 0; k < samples.pressures.size(); ++k) {
      ASSERT_EQ(samples.pressures[k].time, static_cast<double>(k) / 1000);
      ASSERT_NEAR(samples.pressures[k].pressures[0], 5 + 100 * samples.pressures[k].time, 1e-9) << "not interpolated to its time";
    }
    ASSERT_EQ(samples.energies.size(), expected(30));
    for (std::size_t k = 0; k < samples.energies.size(); ++k) ASSERT_EQ(samples.energies[k].time, static_cast<double>(k) / 30);
  }

  static Layout tank_alone() {
    Layout layout;
    layout.spacing = 0.1;
    layout.meshes.resize(1);
    return layout;
  }

  Case scene;
  Layout layout = tank_alone();
  RigidWorld world{scene, layout};  // in which nothing moves
  ClockedFluid fluid;
};

TEST_F(Sampling, HasEverySampleOnceWithStepsShorterThanThePeriod) {
  const std::vector<double> steps(30011, 0.000137);
  expect_clock(record(steps));
}

TEST_F(Sampling, HasEverySampleOnceWithStepsLongerThanThePeriod) {
  const std::vector<double> steps(1003, 0.0037);
  expect_clock(record(steps));
}

TEST_F(Sampling, HasEverySampleOnceWithUnevenSteps) {
  std::vector<double> steps;
  for (int k = 0; k < 5000; ++k) steps.push_back(1e-4 * (1 + k % 17) + 1e-7 * k);
  expect_clock(record(steps));
}

TEST_F(Sampling, HasASampleOnceWhereAStepEndsOnIt) {
  const std::vector<double> steps(1024, 1.0 / 1024);  // exact in binary: 1 s is the end of a step
  const Samples samples = record(steps);
  EXPECT_EQ(fluid.time, 1.0);
  expect_clock(samples);
  EXPECT_EQ(samples.pressures.back().time, 1.0);
}

TEST_F(Sampling, ReadsOnlyWhereASampleIsDue) {
  scene.instruments.rate = 1;
  record(std::vector<double>(500, 0.001));
  EXPECT_LE(fluid.readings, 2) << "at the start alone";
}

TEST_F(Sampling, ContinuesFromStoredIndices) {
  Recorder first(scene, layout, fluid, world), second(scene, layout, fluid, world);
  fluid.time = 0;
  first.start(fluid);
  first.before_step(fluid, 0, 0.0105);
  fluid.time = 0.0105;
  first.after_step(fluid, 0, 0.0105);
  second.set_clock_indices(first.clock_indices());
  second.before_step(fluid, 0.0105, 0.0125);
  fluid.time = 0.0125;
  second.after_step(fluid, 0.0105, 0.0125);
  const Samples samples = second.take();
  ASSERT_EQ(samples.pressures.size(), 2u);
  EXPECT_EQ(samples.pressures[0].time, 0.011);
  EXPECT_EQ(samples.pressures[1].time, 0.012);
}

}  // namespace
}  // namespace wavetank::sample_clock_test

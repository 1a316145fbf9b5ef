// What a case costs, before it is run.
#include <chrono>

#include "simulation_fixture.h"

namespace wavetank::estimate_test {
namespace {

TEST(Estimate, AParticleTakesSomeTwoHundredBytes) {
  const Estimate cost = estimate(box_case(Vector3d(0.6, 0.4, 0.4), 0.3, 0.0125));
  EXPECT_EQ(cost.particles, 48u * 32u * 24u);
  const double bytes = cost.device_memory / static_cast<double>(cost.particles);
  std::printf("%zu particles, %zu wall elements: %.0f bytes a particle\n", cost.particles, cost.wall_elements, bytes);
  EXPECT_LT(bytes, 240) << "180 are measured here, up to 219 with what else a case may ask for";
  EXPECT_GT(bytes, 150) << "state, its copy, rates and grid take more than that";
  EXPECT_GT(cost.wall_seconds, 0);
}

/// The dam break with many gauges, at so many readings a second.
Case with_instruments(double rate) {
  Case scene = dam_break(0.02);
  scene.instruments.rate = rate;
  for (int k = 0; k < 20; ++k) scene.instruments.wave_gauges.push_back({"more", Vector3d(0.05 * k, 0, 0)});
  return scene;
}

TEST(Estimate, CountsTheInstrumentsAtTheirRates) {
  const Estimate seldom = estimate(with_instruments(10)), often = estimate(with_instruments(1e5));
  std::printf("instruments at 10 Hz %.3f s, at 100 kHz %.3f s beside %.3f s of steps\n", seldom.instrument_seconds,
              often.instrument_seconds, often.step_seconds);
  EXPECT_GT(seldom.instrument_seconds, 0);
  EXPECT_GT(often.instrument_seconds, 10 * seldom.instrument_seconds) << "read in each step instead of in one of hundred";
  EXPECT_NEAR(often.wall_seconds, often.start_seconds + often.step_seconds + often.instrument_seconds, 1e-9);
}

/// Only prints: how busy the machine is decides.
TEST(Estimate, BesideARunOf200Steps) {
  Case still_3d = box_case(Vector3d(0.6, 0.4, 0.4), 0.3, 0.025);
  Case floating = box_case(Vector3d(1, 0, 0.6), 0.3, 0.01);
  BodyCase body;
  body.name = "box";
  body.shape = Box{Vector3d(0.4, 0, 0.2), Vector3d(0.6, 0, 0.35)};
  body.motion = Motion::free;
  body.rigid.density = 500;
  floating.bodies.push_back(body);
  for (const auto& [name, given] : {std::pair<const char*, Case>{"dam break", dam_break(0.01)},
                                    {"with instruments", with_instruments(1e4)},
                                    {"still water, 3-D", still_3d},
                                    {"floating box", floating}}) {
    Case scene = given;
    scene.duration = 200 * estimate(scene).time_step;
    const Estimate expected = estimate(scene);
    using Clock = std::chrono::steady_clock;
    const Clock::time_point begin = Clock::now();
    Simulation simulation(scene);
    const double start = std::chrono::duration<double>(Clock::now() - begin).count();
    while (simulation.state().time < scene.duration) simulation.advance();
    const double all = std::chrono::duration<double>(Clock::now() - begin).count();
    std::printf("%-18s estimated %.2f s (start %.2f, steps %.2f, instruments %.2f), took %.2f s (start %.2f, %llu steps): %+.0f %%\n", name,
                expected.wall_seconds, expected.start_seconds, expected.step_seconds, expected.instrument_seconds, all, start,
                static_cast<unsigned long long>(simulation.state().step), 100 * (expected.wall_seconds / all - 1));
  }
}

}  // namespace
}  // namespace wavetank::estimate_test

// A simulation that may not go on says which particle, where, when and in which step, and stops.
#include <limits>

#include "../../src/simulation/snapshot.h"
#include "../sph/state_bytes.h"
#include "simulation_fixture.h"
#include "wavetank/common/log.h"

namespace wavetank::watchdog_test {
namespace {

class Watchdog : public SimulationTest {
 protected:
  /// Runs the dam break a little, puts `value` into one field of the particle `id` of its snapshot, and goes on from there.
  std::string violation_of(std::uint32_t id, const std::string& field, float value) {
    Simulation simulation(scene);
    for (int k = 0; k < 7; ++k) simulation.advance();
    simulation.save(path("snapshot"));
    Snapshot snapshot = read_snapshot(path("snapshot"));
    StateBytes<float> state(snapshot.fluid, simulation.state().particles);
    state.set(field, id, value);
    snapshot.fluid = state.bytes();
    write_snapshot(path("edited"), snapshot);
    simulation.restore(path("edited"));
    time = simulation.state().time + simulation.state().time_step;
    simulation.take_samples();
    try {
      simulation.advance();
    } catch (const Violation& violation) {
      simulation.take_samples();  // those up to then can still be taken
      return violation.what();
    }
    ADD_FAILURE() << "no Violation was thrown";
    return "";
  }

  static std::string shown(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
  }

  void expect_parts(const std::string& message, const std::vector<std::string>& parts) const {
    for (const std::string& part : parts) EXPECT_NE(message.find(part), std::string::npos) << "\"" << part << "\" is not in: " << message;
    std::printf("%s\n", message.c_str());
  }

  Case scene = dam_break(0.04);
  double time = 0;  ///< of the step that fails
};

TEST_F(Watchdog, ReportsAValueThatIsNotFinite) {
  const std::string message = violation_of(12, "w", std::numeric_limits<float>::quiet_NaN());
  expect_parts(message, {"not finite", "particle ", "t = " + shown(time) + " s", "step 8"});
}

TEST_F(Watchdog, TellsOnceOfWaterThatIsFastBesideItsSound) {
  for (const bool fast : {false, true}) {
    if (fast) scene.fluid.sound_speed = 6;
    std::vector<std::string> warnings;
    set_log_sink([&](LogLevel level, const std::string& line) {
      if (level == LogLevel::warning && line.find("Mach") != std::string::npos) warnings.push_back(line);
    });
    Simulation simulation(scene);
    while (simulation.state().time < 0.25) simulation.advance();
    set_log_sink({});
    ASSERT_EQ(warnings.size(), fast ? 1U : 0U);
    if (fast) expect_parts(warnings[0], {"the fastest particle moves at ", "Mach 0.15", "fluid/sound_speed above 6 m/s"});
  }
}

TEST_F(Watchdog, ReportsAParticleOutside) {
  // coordinates on the device begin half a spacing outside the tank
  const std::string message = violation_of(12, "x", 1.5f);
  expect_parts(message, {"1 outside the tank", "particle 12 ", "(1.48", "t = " + shown(time) + " s", "step 8"});
}

TEST_F(Watchdog, ReportsAParticleThatIsTooFast) {
  const std::string message = violation_of(12, "w", 20.0f);
  expect_parts(message, {"faster than half the speed of sound", "particle 12 ", "velocity", "t = " + shown(time) + " s", "step 8"});
}

// All the water in half of its space, at the densities that it had.
TEST_F(Watchdog, ReportsVolumeThatIsLost) {
  Simulation simulation(scene);
  while (simulation.state().step % 200 != 199) simulation.advance();
  simulation.save(path("snapshot"));
  Snapshot snapshot = read_snapshot(path("snapshot"));
  StateBytes<float> state(snapshot.fluid, simulation.state().particles);
  for (std::size_t id = 0; id < state.count; ++id) state.set("z", id, 0.5F * state.get("z", id));
  snapshot.fluid = state.bytes();
  write_snapshot(path("edited"), snapshot);
  simulation.advance();  // as it is, nothing is lost
  simulation.restore(path("edited"));
  std::string message;
  try {
    simulation.advance();
  } catch (const Violation& violation) {
    message = violation.what();
  }
  expect_parts(message, {"of the water's volume of 0.159", " m² are missing", "upon each other", "step 200"});
}

TEST_F(Watchdog, StopsACaseThatExplodes) {
  scene.fluid.sound_speed = 1.5;  // the fall alone reaches 2.8 m/s
  Simulation simulation(scene);
  std::string message;
  for (int k = 0; k < 5000 && message.empty(); ++k) try {
      simulation.advance();
    } catch (const Violation& violation) {
      message = violation.what();
    }
  ASSERT_FALSE(message.empty()) << "it went on to t = " << simulation.state().time;
  expect_parts(message, {"particle ", " m with velocity ", "t = " + shown(simulation.state().time) + " s",
                         "step " + std::to_string(simulation.state().step)});
  const Samples samples = simulation.take_samples();
  EXPECT_GT(samples.pressures.size(), 1u);
  for (const PressureSample& sample : samples.pressures)
    for (const double pressure : sample.pressures) EXPECT_TRUE(std::isfinite(pressure));
  simulation.save(path("at_the_end"));  // the state can still be written
}

}  // namespace
}  // namespace wavetank::watchdog_test

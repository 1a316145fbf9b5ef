// Spans add up whatever the steps are, and what cannot be asked for is refused. That they change no bit of a run: test/python, live_node.
#include "wavetank/simulation/lock_step.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "../common/error_of.h"

namespace wavetank::lock_step_test {
namespace {

/// A simulation whose steps are all as long.
struct Steps {
  SolverState state;
  double time_step;
  /// Runs until the span is over; how many steps it took.
  int go_on(LockStep& lock_step) {
    int steps = 0;
    while (!lock_step.is_reached(state)) {
      state.time += time_step;
      ++steps;
    }
    return steps;
  }
};

TEST(LockStep, SpansAddUp) {
  Steps run{{}, 0.003};
  LockStep lock_step;
  const int expected[] = {4, 3, 3, 4, 3, 3, 4};  // of 0.01 s: the steps' ends at 0.012, 0.021, 0.03, 0.042 s and so on
  for (const int steps : expected) {
    lock_step.ask(run.state, 0.01, 1.0);
    EXPECT_EQ(run.go_on(lock_step), steps);
  }
}

TEST(LockStep, SpansShorterThanAStepTakeNoneNowAndThen) {
  Steps run{{}, 0.003};
  LockStep lock_step;
  int steps = 0;
  for (int k = 0; k < 1000; ++k) {
    lock_step.ask(run.state, 0.001, 10.0);
    const int taken = run.go_on(lock_step);
    EXPECT_LE(taken, 1);
    steps += taken;
  }
  EXPECT_EQ(steps, 334);  // the first that ends at 1 s or later, in spite of a thousand sums
}

TEST(LockStep, CountsFromWhereSomethingElseHasMovedTheSimulation) {
  Steps run{{}, 0.003};
  LockStep lock_step;
  lock_step.ask(run.state, 0.01, 1.0);
  run.go_on(lock_step);
  run.state.time = 0.5;
  lock_step.ask(run.state, 0.01, 1.0);
  run.go_on(lock_step);
  EXPECT_NEAR(run.state.time, 0.512, 1e-12);
  lock_step.ask(run.state, 0.01, 1.0);
  run.state.time += 0.003;  // cut short here
  lock_step.ask(run.state, 0.01, 1.0);
  run.go_on(lock_step);
  EXPECT_NEAR(run.state.time, 0.527, 1e-12);
}

TEST(LockStep, AnInstantThatIsOverTakesNothingBack) {
  Steps run{{}, 0.003};
  LockStep lock_step;
  lock_step.ask(run.state, 0.01, 1.0);
  run.go_on(lock_step);
  for (const double past : {0.0, 0.005, 0.01}) {
    lock_step.ask_until(run.state, past, 1.0);
    EXPECT_EQ(run.go_on(lock_step), 0) << past;
  }
  lock_step.ask(run.state, 0.01, 1.0);
  run.go_on(lock_step);
  EXPECT_NEAR(run.state.time, 0.021, 1e-12) << "the first step's end from 0.02 s on";
  run.state.time = 0.5;  // something else has moved it
  lock_step.ask_until(run.state, 0.1, 1.0);
  EXPECT_EQ(run.go_on(lock_step), 0);
  lock_step.ask(run.state, 0.01, 1.0);
  run.go_on(lock_step);
  EXPECT_NEAR(run.state.time, 0.512, 1e-12) << "from where it stands";
}

TEST(LockStep, RefusesWhatCannotBe) {
  LockStep lock_step;
  SolverState state;
  state.time = 0.5;
  for (const double seconds : {-0.1, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_NE(error_of([&] { lock_step.ask(state, seconds, 1.0); }).find("at least 0"), std::string::npos) << seconds;
  }
  for (const double time : {-0.1, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_NE(error_of([&] { lock_step.ask_until(state, time, 1.0); }).find("at least 0"), std::string::npos) << time;
  }
  EXPECT_EQ(error_of([&] { lock_step.ask(state, 0.6, 1.0); }),
            "from 0.5 s it cannot be advanced to 1.1 s: the run ends at 1 s, its case's duration");
  lock_step.ask(state, 0.5, 1.0);
  EXPECT_FALSE(lock_step.is_reached(state));
  lock_step.ask_until(state, 0.2, 1.0);
  EXPECT_TRUE(lock_step.is_reached(state)) << "it is over";
}

}  // namespace
}  // namespace wavetank::lock_step_test

#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "sample_rows.h"
#include "wavetank/scene/case.h"
#include "wavetank/simulation/lock_step.h"
#include "wavetank/simulation/simulation.h"

namespace wavetank {

/// A simulation as a script drives it: span by span, with its samples as rows. Knows nothing of Python.
class SteeredSimulation {
 public:
  /// `interrupted`: called often while it starts and advances, may throw to abandon that. `restore`: a snapshot to go on from; empty =
  /// none.
  SteeredSimulation(const Case& checked, const ResourceResolver& resolve, const std::string& restore, std::function<void()> interrupted);

  /// As LockStep has it. Throws Violation when the watchdog stops the simulation, and again until it is reset.
  void advance(double seconds);
  void advance_to(double time);
  void reset();

  SampleRows& samples() { return rows_; }
  Simulation& simulation() { return simulation_; }

 private:
  void go_on();

  Simulation simulation_;
  std::function<void()> interrupted_;
  LockStep lock_step_;
  SampleRows rows_;
  std::string stopped_;  ///< why, by the watchdog; empty = it was not
};

}  // namespace wavetank

#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "wavetank/node/bag_writer.h"
#include "wavetank/node/messages.h"
#include "wavetank/node/progress.h"
#include "wavetank/node/run_options.h"
#include "wavetank/simulation/simulation.h"

namespace wavetank {

/// One simulation from its start to its end with everything written to a bag: what wavetank_run does.
class BagRun {
 public:
  enum class Outcome { done, interrupted, violated };

  /// Reads the case and opens the bag, so that whatever is wrong with them shows before the long start. `interrupted` is watched
  /// throughout.
  BagRun(const RunOptions& options, const std::atomic<int>& interrupted);

  /// Starts and runs the simulation, ends the bag and reports on standard output. Throws Error for whatever stops it but a violation.
  Outcome run();

 private:
  using Clock = std::chrono::steady_clock;
  void start();
  void step_to_the_end();
  void write_samples();
  void write_first_messages();
  void write_status(const EnergySample& energies);
  void write_clouds();
  void finish();
  void save_violation();
  void report() const;
  void say(const std::string& text);
  double elapsed() const;

  const RunOptions& options_;
  const std::atomic<int>& interrupted_;
  Case case_;
  std::unique_ptr<BagWriter> bag_;
  Progress progress_;
  std::unique_ptr<Simulation> simulation_;
  std::vector<BodyFrame> frames_;
  std::unique_ptr<SampleMessages> messages_;
  StampClock clock_;
  std::string device_;
  SolverState first_, last_;
  EnergySample energies_;
  double next_status_ = 0, next_cloud_ = 0;  ///< s of simulated time
  Clock::time_point began_;
  double seconds_ = 0;  ///< of wall time, stepping
  std::string violation_;
};

}  // namespace wavetank

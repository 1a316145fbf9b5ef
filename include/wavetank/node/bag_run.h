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

  /// Starts and runs the simulation, ends the bag and reports on standard output. Throws Error for whatever stops it but a violation; where
  /// the disk does not take the bag or the snapshot any more, after all that could be was kept, and what() says where.
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
  void finish_bag();
  std::string failure_snapshot() const;
  void save_violation();
  void save_what_is_left();
  void save_at_end();
  std::string save_anywhere(const std::string& wanted);
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
  std::string cut_short_;     ///< why bag or snapshot are not as they were asked for, and where they are; empty = they are
  std::string save_problem_;  ///< why the snapshot is not where it was wanted
  bool bag_is_whole_ = false;
};

}  // namespace wavetank

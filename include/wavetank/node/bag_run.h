#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "wavetank/node/messages.h"
#include "wavetank/node/progress.h"
#include "wavetank/node/run_options.h"
#include "wavetank/node/run_recorder.h"
#include "wavetank/node/vtk_recorder.h"
#include "wavetank/ranks/ranks.h"
#include "wavetank/simulation/simulation.h"

namespace wavetank {

/// One simulation from its start to its end with everything written to a bag, and to files for ParaView: what wavetank_run does.
class BagRun {
 public:
  enum class Outcome { done, interrupted, violated };

  /// Reads the case and opens the bag, so that whatever is wrong with them shows before the long start. `interrupted` is watched
  /// throughout. `ranks`: of which this process is the first; null of one that is alone.
  BagRun(const RunOptions& options, const std::atomic<int>& interrupted, parallel::Ranks* ranks = nullptr);

  /// Starts and runs the simulation, ends the bag and reports on standard output. Throws Error for whatever stops it but a violation; where
  /// the disk does not take the bag, the files for ParaView or the snapshot any more, after all that could be was kept, and what() says
  /// where.
  Outcome run();

  /// From another thread: ends the process as an interrupted start ends, with this exit code, if the run has not come to its first step
  /// yet. For where a start may not take the time until it next looks at `interrupted`: compilers take seconds, and a launcher waits for
  /// one.
  void leave_start(int exit_code);

 private:
  using Clock = std::chrono::steady_clock;
  void start();
  void make_simulation();
  void tell_of_start();
  void step_to_the_end();
  void write_samples();
  void record(const Samples& samples);
  void finish();
  void finish_vtk();
  void finish_bag();
  Outcome left_start();
  /// Nobody leaves the start any more but who does so here; does not return if it was left.
  void pass_start();
  void cut_short(const Error& full);
  RunState run_state(std::uint8_t phase) const;
  std::string failure_snapshot() const;
  void save_when_due();
  void save_violation();
  void save_what_is_left();
  void save_at_end();
  std::string save_anywhere(const std::string& wanted);
  void report() const;
  void say(const std::string& text);
  double elapsed() const;

  const RunOptions& options_;
  const std::atomic<int>& interrupted_;
  parallel::Ranks* ranks_;
  Case case_;
  StampClock clock_;
  std::unique_ptr<RunRecorder> recorder_;
  std::unique_ptr<VtkRecorder> vtk_;
  Progress progress_;
  std::unique_ptr<Simulation> simulation_;
  std::unique_ptr<SampleMessages> messages_;
  std::string device_;
  SolverState first_, last_;
  EnergySample energies_;
  Clock::time_point began_;
  double seconds_ = 0;          ///< of wall time, stepping
  double waited_at_start_ = 0;  ///< s, for other ranks, before the first step
  std::string violation_;
  std::string cut_short_;     ///< why bag, files or snapshot are not as they were asked for, and where they are; empty = they are
  std::string save_problem_;  ///< why the snapshot is not where it was wanted
  bool bag_is_whole_ = false;
  double next_save_ = 0;  ///< s of simulated time, of --save-every
  bool told_of_save_ = false;
  std::atomic<bool> is_past_start_{false};  ///< or it was left
};

}  // namespace wavetank

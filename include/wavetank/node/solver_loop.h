#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <future>
#include <mutex>
#include <string>
#include <thread>

#include "wavetank/simulation/lock_step.h"
#include "wavetank/simulation/simulation.h"

namespace wavetank {

enum class LoopPhase { starting, running, paused, finished, failed };

struct LoopStatus {
  LoopPhase phase = LoopPhase::starting;
  bool paused = false;
  double start_progress = 0;  ///< 0…1
  bool has_started = false;   ///< the case is laid out, and a snapshot restored: what fails from then on is the simulation
  bool is_violation = false;  ///< the watchdog stopped it, before the start or after
  std::string failure;        ///< why the phase is failed
  SolverState solver;
  EnergySample energies;
  std::string device;
};

struct Reply {
  bool success = false;
  std::string message;
  double time = 0;          ///< s of simulated time, of advance_by
  std::uint64_t stamp = 0;  ///< ns, the same as the hook `stamp` had it when the answer was made
};

/// What the loop's owner does with a simulation; each is called in the solver's thread, and none may keep the reference.
struct LoopHooks {
  std::function<void(const Simulation&)> started;                  ///< once, before the first samples
  std::function<void(const Simulation&, const Samples&)> stepped;  ///< at the start, after each step and after a reset
  std::function<void()> violated;                ///< once, after a step that ended in a Violation, before its samples; may be empty
  std::function<void(Simulation&)> before_step;  ///< before each step; empty = nothing to do
  std::function<void(const SolverState& last)> restarted;  ///< after a reset, before its samples; `last` = the state left
  std::function<std::uint64_t(double time)> stamp;         ///< ns, of a simulated time (s) as samples bear it now
  std::function<void(const Simulation&)> idle;             ///< often while there is nothing to step; and after each step
  std::function<void(const LoopStatus&)> ended;            ///< once, when no step will follow; may throw
};

struct LoopSettings {
  std::string restore_from;         ///< snapshot to go on from; empty = start at time 0
  std::string failure_snapshot;     ///< written when the simulation fails after its start; empty = none. No file is replaced: see free_path
  std::function<bool()> may_start;  ///< the first step waits until this is true; empty = at once
  bool paused = false;              ///< at the start
};

/// Runs a simulation in a thread of its own: starts it, steps it until its duration has passed, and between two steps does what others ask
/// for. Knows nothing of ROS. All members may be called from any thread.
class SolverLoop {
 public:
  SolverLoop(Case checked, SimulationOptions options, LoopSettings settings, LoopHooks hooks);
  ~SolverLoop();
  SolverLoop(const SolverLoop&) = delete;
  SolverLoop& operator=(const SolverLoop&) = delete;

  /// Stops after the step in progress, abandons a start in progress; returns when the hook `ended` has. Whoever waits for an answer gets
  /// one. Not to be called by two threads at once; the second time it does nothing.
  void stop();

  /// Once it is answered, no step is in progress. During the start: the run will begin paused, or not.
  Reply pause(bool paused);
  Reply step();  ///< one step; only while paused and before the end
  /// Goes on by a span of simulated time, s, while paused, as LockStep has it; answered when it is done. Pauses, resets and failures cut it
  /// short, which is answered as no success.
  Reply advance_by(double seconds);
  Reply reset();  ///< back to time 0; paused stays paused
  /// Writes a snapshot to the path that is made from the state saved, and answers with it.
  Reply save(const std::function<std::string(const SolverState&)>& path);

  LoopStatus status() const;

 private:
  using Clock = std::chrono::steady_clock;
  using Request = std::packaged_task<Reply(Simulation&)>;

  void run();
  void start();
  void loop();
  void advance();
  void pass_on_samples();
  void serve_requests();
  void refuse_requests();
  void fail(const std::string& why);
  Reply reply_at(bool success, const std::string& message, double time) const;
  void answer_advance();
  void cut_advance_short(const std::string& why);
  bool wait_for_pace();
  Reply ask(std::function<Reply(Simulation&)> what);

  Case case_;
  SimulationOptions options_;
  LoopSettings settings_;
  LoopHooks hooks_;
  std::unique_ptr<Simulation> simulation_;
  std::atomic<bool> stopping_{false};

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  LoopStatus status_;
  std::deque<Request> requests_;
  bool accepts_requests_ = false;
  std::exception_ptr failure_in_request_;           ///< of the solver's thread only
  LockStep lock_step_;                              ///< likewise
  std::shared_ptr<std::promise<Reply>> advancing_;  ///< likewise: of the span in progress; null = none

  bool pace_known_ = false;
  Clock::time_point pace_wall_;
  double pace_time_ = 0;

  std::thread thread_;
};

}  // namespace wavetank

// What a live node says about itself: status, diagnostics, and when to leave.
#include <filesystem>

#include "wavetank/common/whole_file.h"
#include "wavetank/node/tank_node.h"

namespace wavetank {

namespace {

constexpr int seconds_of_error = 5;     ///< that a failed node stays up, so that its diagnostics are seen
constexpr int seconds_of_farewell = 2;  ///< that a finished one does, so that its last samples arrive

std::uint8_t phase_code(LoopPhase phase) {
  switch (phase) {
    case LoopPhase::starting:
      return SolverStatus::STARTING;
    case LoopPhase::running:
      return SolverStatus::RUNNING;
    case LoopPhase::paused:
      return SolverStatus::PAUSED;
    case LoopPhase::finished:
      return SolverStatus::FINISHED;
    case LoopPhase::failed:
      return SolverStatus::FAILED;
  }
  return SolverStatus::FAILED;
}

std::string time_text(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4fs", seconds);
  return text;
}

}  // namespace

std::string TankNode::snapshot_path(const std::string& what) const {
  const std::string node = graph_name(ros::this_node::getName().substr(1));
  const std::filesystem::path folder = setup_.parameters.snapshot_directory.empty() ? "." : setup_.parameters.snapshot_directory;
  return std::filesystem::absolute(folder / (node + "_" + what + ".snapshot")).lexically_normal().string();
}

/// What an earlier run saved at that time stays; what this one did is replaced.
std::string TankNode::path_to_save(double time) {
  const std::filesystem::path wanted = snapshot_path(time_text(time));
  std::string& saved = saved_[wanted.string()];
  if (saved.empty()) saved = free_path(std::filesystem::path(wanted).replace_extension().string(), wanted.extension().string());
  return saved;
}

void TankNode::every_second() {
  const LoopStatus status = loop_->status();
  measure_rates(status);
  status_.publish(status_message(case_, status.solver, status.energies, run_state(status), clock_));
  note_clock(status);
  if (!status.device.empty()) diagnostics_.setHardwareID(status.device);
  // Not update(): that paces itself by ROS time, which stands still while paused.
  diagnostics_.force_update();
  decide_about_exit(status);
}

void TankNode::measure_rates(const LoopStatus& status) {
  const Clock::time_point now = Clock::now();
  const double elapsed = std::chrono::duration<double>(now - last_tick_).count();
  const bool went_on = status.phase == LoopPhase::running && status.solver.step >= last_step_;
  real_time_factor_ = went_on ? (status.solver.time - last_time_) / elapsed : 0.0;
  steps_per_second_ = went_on ? static_cast<double>(status.solver.step - last_step_) / elapsed : 0.0;
  last_tick_ = now;
  last_time_ = status.solver.time;
  last_step_ = status.solver.step;
}

RunState TankNode::run_state(const LoopStatus& status) const {
  RunState run;
  run.phase = phase_code(status.phase);
  run.paused = status.paused;
  run.start_progress = status.start_progress;
  run.real_time_factor = real_time_factor_;
  run.steps_per_second = steps_per_second_;
  run.device = status.device;
  run.failure = status.failure;
  return run;
}

void TankNode::fill_diagnostics(diagnostic_updater::DiagnosticStatusWrapper& report) {
  using diagnostic_msgs::DiagnosticStatus;
  const LoopStatus status = loop_ ? loop_->status() : LoopStatus();
  switch (status.phase) {
    case LoopPhase::starting:
      report.summaryf(DiagnosticStatus::OK, "starting, %.0f %%", 100.0 * status.start_progress);
      break;
    case LoopPhase::running:
      report.summary(DiagnosticStatus::OK, "running");
      break;
    case LoopPhase::paused:
      report.summary(DiagnosticStatus::OK, "paused");
      break;
    case LoopPhase::finished:
      report.summary(DiagnosticStatus::OK, "finished");
      break;
    case LoopPhase::failed:
      report.summary(DiagnosticStatus::ERROR, status.failure);
      break;
  }
  report.add("simulated time (s)", status.solver.time);
  report.add("step", status.solver.step);
  report.add("time step (s)", status.solver.time_step);
  report.add("real-time factor", real_time_factor_.load());
  report.add("steps per second", steps_per_second_.load());
  report.add("particles", status.solver.particles);
  report.add("greatest speed (m/s)", status.solver.greatest_speed);
  report.add("guard hits", status.solver.guard_hits);
  report.add("shepard factors bounded", status.solver.shepard_bounded);
  report.add("fits of first order", status.solver.fits_of_first_order);
  report.add("fits below first order", status.solver.fits_below_first_order);
}

void TankNode::decide_about_exit(const LoopStatus& status) {
  const bool has_failed = status.phase == LoopPhase::failed;
  const bool has_finished = status.phase == LoopPhase::finished && setup_.parameters.exit_at_end;
  seconds_since_end_ = has_failed || has_finished ? seconds_since_end_ + 1 : 0;
  const int seconds_to_stay = has_finished ? seconds_of_farewell : status.has_started ? seconds_of_error : 0;
  if (seconds_since_end_ > seconds_to_stay) wants_to_exit_ = true;
}

}  // namespace wavetank

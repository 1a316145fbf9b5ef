#include "wavetank/node/bag_run.h"

#include <unistd.h>

#include <algorithm>
#include <climits>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "wavetank/common/ending_signals.h"
#include "wavetank/common/log.h"
#include "wavetank/common/visible_text.h"
#include "wavetank/common/whole_file.h"
#include "wavetank/node/resources.h"

namespace wavetank {

namespace fs = std::filesystem;

namespace {

constexpr double least_time_left = 1e-9;  ///< s, below any step

/// The script that shows such files in ParaView.
std::string vtk_view() {
  const std::string path = resolve_resource("package://wavetank/config/paraview/view.py");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error("'" + path + "' cannot be read, which --vtk copies into its folder");
  return {std::istreambuf_iterator<char>(file), {}};
}

void refuse_same_paths(const RunOptions& options) {
  const std::pair<const char*, const std::string&> outputs[] = {{"--bag", options.bag}, {"--save", options.save}, {"--vtk", options.vtk}};
  const auto whole = [](const std::string& path) {
    const fs::path normal = fs::absolute(path).lexically_normal();
    return normal.has_filename() ? normal : normal.parent_path();  // "out/" is "out"
  };
  for (const auto& [flag, path] : outputs)
    for (const auto& [other_flag, other] : outputs)
      if (&path < &other && !path.empty() && !other.empty() && whole(path) == whole(other))
        throw Error(std::string(flag) + " and " + other_flag + " are both '" + path + "'; give each a name of its own");
}

struct Interrupted : std::exception {
  const char* what() const noexcept override { return "interrupted"; }
};

}  // namespace

BagRun::BagRun(const RunOptions& options, const std::atomic<int>& interrupted, parallel::Ranks* ranks)
    : options_(options),
      interrupted_(interrupted),
      ranks_(ranks),
      case_(read_case_file(options.case_file, options.overrides, {resolve_resource, {}})),
      progress_(Progress::fitting(options.quiet), 0.0, case_.duration) {
  check_names(case_);
  // a snapshot is written at the end of hours: a name that will not do is to be told at the beginning
  if (!options_.save.empty()) check_writable(options_.save, "the snapshot");
  refuse_same_paths(options_);
  if (!options_.bag.empty())
    recorder_ = std::make_unique<RunRecorder>(options_.bag, "/wavetank", case_, clock_,
                                              RecordedPictures{options_.clouds, options_.particles, options_.surface});
  if (!options_.vtk.empty()) vtk_ = std::make_unique<VtkRecorder>(options_.vtk, options_.vtk_rate, case_, vtk_view(), options_.surface);
}

BagRun::Outcome BagRun::run() {
  try {
    start();
    tell_of_start();
    step_to_the_end();
  } catch (const Interrupted&) {
    return left_start();
  } catch (const EndRequested&) {
    return left_start();
  } catch (const Violation& violation) {
    progress_.clear();
    if (!simulation_) {  // before the start: there is no state to save, and the bag has nothing
      log(LogLevel::error, violation.what());
      return Outcome::violated;
    }
    violation_ = violation.what();
  } catch (const BagError& full) {
    cut_short(full);
  } catch (const VtkError& full) {
    cut_short(full);
  } catch (const Error&) {
    if (ranks_ == nullptr || interrupted_ == 0 || simulation_) throw;
    return left_start();  // all ranks were asked to end, and another was first to leave what it did
  }
  progress_.clear();
  finish();
  if (!options_.quiet) report();
  if (!violation_.empty()) {
    if (!cut_short_.empty()) log(LogLevel::warning, cut_short_);
    return Outcome::violated;
  }
  if (!cut_short_.empty()) throw Error(cut_short_);
  return interrupted_ != 0 ? Outcome::interrupted : Outcome::done;
}

void BagRun::pass_start() {
  if (is_past_start_.exchange(true))
    while (true) pause();
}

void BagRun::leave_start(int exit_code) {
  if (is_past_start_.exchange(true)) return;
  recorder_.reset();  // which the start does not touch, and neither the other
  vtk_.reset();
  left_start();
  std::fflush(nullptr);
  _exit(exit_code);
}

BagRun::Outcome BagRun::left_start() {
  progress_.clear();
  say("interrupted during the start: nothing was simulated and no bag is written");
  return Outcome::interrupted;
}

/// While it is caught.
void BagRun::cut_short(const Error& full) {
  if (last_.step == first_.step) throw;  // there is nothing to keep yet
  cut_short_ = full.what();
}

void BagRun::start() {
  const struct End {
    BagRun& run;
    ~End() { run.pass_start(); }
  } end{*this};
  make_simulation();
}

void BagRun::make_simulation() {
  SimulationOptions simulation_options;
  simulation_options.resolve = resolve_resource;
  simulation_options.time_kernels = options_.profile;
  simulation_options.team = ranks_;
  simulation_options.progress = [this](const std::string& what, double fraction) {
    if (interrupted_ != 0) throw Interrupted();
    progress_.starting(what, fraction);
  };
  simulation_ = std::make_unique<Simulation>(case_, simulation_options);
  if (!options_.restore.empty()) simulation_->restore(options_.restore);
}

void BagRun::tell_of_start() {
  progress_.clear();
  say(simulation_->summary());
  device_ = simulation_->device_description();
  first_ = last_ = simulation_->state();
  energies_ = simulation_->energies();
  progress_.set_begin(first_.time);
  next_save_ = first_.time + options_.save_every;
  const std::vector<BodyFrame> frames = body_frames(case_, reference_points(simulation_->bodies()));
  messages_ = std::make_unique<SampleMessages>(case_, simulation_->layout(), frames);
  if (recorder_) recorder_->start(*simulation_, frames);
  if (vtk_) vtk_->start(*simulation_);
}

void BagRun::step_to_the_end() {
  began_ = Clock::now();
  if (ranks_ != nullptr) waited_at_start_ = ranks_->waited();
  write_samples();
  while (last_.time < case_.duration - least_time_left && interrupted_ == 0) {
    try {
      simulation_->advance();
    } catch (const Violation& violation) {
      violation_ = violation.what();  // which counts whatever becomes of the bag
      if (recorder_) recorder_->draw_no_more();
    }
    write_samples();
    if (!violation_.empty()) return;
    if (options_.save_every > 0 && last_.time >= next_save_ - least_time_left) save_when_due();
    progress_.running(last_.time, last_.step);
  }
  seconds_ = elapsed();
}

void BagRun::write_samples() {
  const Samples samples = simulation_->take_samples();
  last_ = simulation_->state();
  if (!samples.energies.empty()) energies_ = samples.energies.back();
  seconds_ = elapsed();
  if (recorder_) record(samples);
  if (vtk_) vtk_->record(*simulation_, samples);
}

void BagRun::record(const Samples& samples) {
  messages_->emit(samples, clock_, [this](const std::string& topic, const ros::Time& stamp, const auto& message) {
    recorder_->write(topic, stamp, message);
  });
  RunState run = run_state(SolverStatus::RUNNING);
  if (seconds_ > 0) {
    run.real_time_factor = (last_.time - first_.time) / seconds_;
    run.steps_per_second = static_cast<double>(last_.step - first_.step) / seconds_;
  }
  recorder_->record(*simulation_, samples.energies, run);
}

RunState BagRun::run_state(std::uint8_t phase) const {
  RunState run;
  run.phase = phase;
  run.start_progress = 1.0;
  run.device = device_;
  return run;
}

void BagRun::finish() {
  if (!violation_.empty()) save_violation();
  if (vtk_) finish_vtk();
  if (recorder_ && recorder_->is_open()) finish_bag();
  if (!violation_.empty()) return;
  if (!cut_short_.empty())
    save_what_is_left();
  else if (!options_.save.empty())
    save_at_end();
}

void BagRun::finish_vtk() {
  try {
    vtk_->finish(*simulation_);
  } catch (const std::exception& error) {  // whatever it is, the bag is still to be ended
    if (cut_short_.empty()) cut_short_ = error.what();
  }
}

void BagRun::finish_bag() {
  RunState run = run_state(violation_.empty() && cut_short_.empty() ? SolverStatus::FINISHED : SolverStatus::FAILED);
  run.failure = violation_.empty() ? cut_short_ : violation_;
  try {
    recorder_->finish(last_, energies_, run);
  } catch (const BagError& error) {
    cut_short_ = error.what();
  }
  bag_is_whole_ = recorder_->is_whole();
}

/// A state that nobody asked for takes no other file's place.
std::string BagRun::failure_snapshot() const {
  const fs::path beside = options_.bag.empty() ? fs::path(options_.case_file).filename() : fs::path(options_.bag);
  return free_path(fs::path(beside).replace_extension().string(), ".snapshot");
}

/// What is in the snapshot is in the bag too, whatever becomes of this process. Where it cannot be written the run goes on, and its end
/// tries again.
void BagRun::save_when_due() {
  const double late = std::max(0.0, last_.time - next_save_);
  next_save_ += options_.save_every * (1 + std::floor(late / options_.save_every));
  if (recorder_) recorder_->keep();
  try {
    simulation_->save(options_.save);
  } catch (const Error& error) {
    progress_.clear();
    if (!told_of_save_) log(LogLevel::warning, std::string(error.what()) + "; the run goes on, and tries again at the next snapshot");
    told_of_save_ = true;
  }
}

void BagRun::save_violation() {
  try {
    violation_ += "; its state is in '" + save_anywhere(failure_snapshot()) + "'";
  } catch (const Error& error) {
    log(LogLevel::warning, error.what());
  }
  log(LogLevel::error, violation_);
}

/// After the bag could not go on: adds to the sentence what there is to go on from.
void BagRun::save_what_is_left() {
  char time[32];
  std::snprintf(time, sizeof time, "%.6g s", last_.time);
  cut_short_ += std::string("; the run stops at ") + time;
  if (bag_is_whole_) cut_short_ += ", and the bag has all samples until then";
  try {
    cut_short_ += "; its state is in '" + save_anywhere(options_.save.empty() ? failure_snapshot() : options_.save) +
                  "', from which --restore goes on";
  } catch (const Error& error) {
    cut_short_ += std::string("; ") + error.what();
  }
}

void BagRun::save_at_end() {
  try {
    const std::string path = save_anywhere(options_.save);
    if (path != options_.save) cut_short_ = save_problem_ + "; it is in '" + path + "' instead";
  } catch (const Error& error) {
    cut_short_ = error.what();
  }
}

/// Writes a snapshot there or, where that disk does not take it, in the working directory or the one for temporary files; returns where.
std::string BagRun::save_anywhere(const std::string& wanted) {
  try {
    simulation_->save(wanted);
    return wanted;
  } catch (const Error& error) {
    save_problem_ = error.what();
  }
  std::error_code ignored;
  std::string tried;
  for (const fs::path& folder : {fs::current_path(ignored), fs::temp_directory_path(ignored)}) {
    const fs::path base = folder / fs::path(wanted).filename();
    const std::string path = free_path(fs::path(base).replace_extension().string(), base.extension().string());
    try {
      simulation_->save(path);
      return path;
    } catch (const Error&) {
      tried += (tried.empty() ? " nor in '" : " nor '") + folder.string() + "'";
    }
  }
  throw Error("the state could not be saved: " + save_problem_ + "," + tried);
}

void BagRun::report() const {
  const double simulated = last_.time - first_.time;
  const auto steps = static_cast<double>(last_.step - first_.step);
  std::printf("simulated time    %.6g s of %.6g s%s\n", last_.time, case_.duration, interrupted_ != 0 ? " (interrupted)" : "");
  std::printf("steps             %.0f\n", steps);
  std::printf("wall time         %s", duration_text(seconds_).c_str());
  if (simulated > 0) std::printf(", %.3g times the simulated", seconds_ / simulated);
  std::printf("\nparticle-steps/s  %.3g\n", seconds_ > 0 ? steps * static_cast<double>(last_.particles) / seconds_ : 0.0);
  std::printf("guard hits        %llu\n", static_cast<unsigned long long>(last_.guard_hits));
  if (last_.parts > 1)
    std::printf(
        "parts             %d, the largest with %.2f times the mean, cut %llu times; exchanges took %.0f %% of the first one's time\n",
        last_.parts, last_.imbalance, static_cast<unsigned long long>(last_.cuts), 100 * last_.exchange_share);
  if (bag_is_whole_) std::printf("bag               %s\n", visible_text(recorder_->path(), PATH_MAX).c_str());
  if (vtk_ && vtk_->has_frames()) std::printf("for ParaView      %s\n", visible_text(vtk_->path(), PATH_MAX).c_str());
  if (!options_.save.empty() && violation_.empty() && cut_short_.empty())
    std::printf("snapshot          %s\n", visible_text(options_.save, PATH_MAX).c_str());
  if (!options_.profile) return;
  std::printf("\n%-32s %10s %12s %8s\n", "kernel", "launches", "seconds", "share");
  const std::vector<KernelTime> kernels = simulation_->kernel_times();
  double all = 0.0;
  for (const KernelTime& kernel : kernels) all += kernel.seconds;
  for (const KernelTime& kernel : kernels)
    std::printf("%-32s %10llu %12.4f %6.1f %%\n", kernel.kernel.c_str(), static_cast<unsigned long long>(kernel.launches), kernel.seconds,
                all > 0 ? 100.0 * kernel.seconds / all : 0.0);
  if (ranks_ != nullptr) std::printf("%-32s %10s %12.4f\n", "(this rank waited for others)", "", ranks_->waited() - waited_at_start_);
}

void BagRun::say(const std::string& text) {
  if (!options_.quiet) std::printf("%s%s", text.c_str(), !text.empty() && text.back() == '\n' ? "" : "\n");
  std::fflush(stdout);
}

double BagRun::elapsed() const { return std::chrono::duration<double>(Clock::now() - began_).count(); }

}  // namespace wavetank

#include "wavetank/node/bag_run.h"

#include <tf2_msgs/TFMessage.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "wavetank/common/log.h"
#include "wavetank/node/clouds.h"
#include "wavetank/node/markers.h"
#include "wavetank/node/resources.h"

namespace wavetank {

namespace fs = std::filesystem;

namespace {

constexpr double status_period = 0.01;  ///< s of simulated time
constexpr double rounding = 1e-9;       ///< s, below any instrument's period

struct Interrupted : std::exception {
  const char* what() const noexcept override { return "interrupted"; }
};

/// A snapshot is written at the end of hours: a name that will not do is to be told at the beginning.
void check_writable(const std::string& path) {
  std::error_code ignored;
  const fs::path parent = fs::path(path).parent_path();
  const fs::path folder = parent.empty() ? fs::path(".") : parent;
  if (fs::is_directory(path, ignored)) throw Error("cannot write snapshot '" + path + "': it is a folder; give the name of a file");
  if (!fs::is_directory(folder, ignored)) throw Error("cannot write snapshot '" + path + "': there is no folder '" + folder.string() + "'");
  if (access(folder.c_str(), W_OK) != 0) throw Error("cannot write snapshot '" + path + "': " + std::strerror(errno));
}

}  // namespace

BagRun::BagRun(const RunOptions& options, const std::atomic<int>& interrupted)
    : options_(options),
      interrupted_(interrupted),
      case_(read_case_file(options.case_file, options.overrides, {resolve_resource, {}})),
      progress_(Progress::fitting(options.quiet), 0.0, case_.duration) {
  check_names(case_);
  if (!options_.save.empty()) check_writable(options_.save);
  if (!options_.bag.empty()) bag_ = std::make_unique<BagWriter>(options_.bag, "/wavetank");
}

BagRun::Outcome BagRun::run() {
  try {
    start();
    step_to_the_end();
  } catch (const Interrupted&) {
    progress_.clear();
    say("interrupted during the start: nothing was simulated and no bag is written");
    return Outcome::interrupted;
  } catch (const Violation& violation) {
    progress_.clear();
    violation_ = violation.what();
  }
  progress_.clear();
  finish();
  if (!options_.quiet) report();
  if (!violation_.empty()) return Outcome::violated;
  return interrupted_ != 0 ? Outcome::interrupted : Outcome::done;
}

void BagRun::start() {
  SimulationOptions simulation_options;
  simulation_options.resolve = resolve_resource;
  simulation_options.time_kernels = options_.profile;
  simulation_options.progress = [this](const std::string& what, double fraction) {
    if (interrupted_ != 0) throw Interrupted();
    progress_.starting(what, fraction);
  };
  simulation_ = std::make_unique<Simulation>(case_, simulation_options);
  if (!options_.restore.empty()) simulation_->restore(options_.restore);
  progress_.clear();
  say(simulation_->summary());
  device_ = simulation_->device_description();
  first_ = last_ = simulation_->state();
  energies_ = simulation_->energies();
  next_status_ = next_cloud_ = first_.time;
  progress_.set_begin(first_.time);
  frames_ = body_frames(case_, reference_points(simulation_->bodies()));
  messages_ = std::make_unique<SampleMessages>(case_, simulation_->layout(), frames_);
  if (bag_) write_first_messages();
}

void BagRun::step_to_the_end() {
  began_ = Clock::now();
  write_samples();
  while (last_.time < case_.duration - rounding && interrupted_ == 0) {
    try {
      simulation_->advance();
    } catch (const Violation&) {
      write_samples();
      throw;
    }
    write_samples();
    progress_.running(last_.time, last_.step);
  }
  seconds_ = elapsed();
}

void BagRun::write_samples() {
  const Samples samples = simulation_->take_samples();
  last_ = simulation_->state();
  if (!samples.energies.empty()) energies_ = samples.energies.back();
  seconds_ = elapsed();
  if (!bag_) return;
  messages_->emit(samples, clock_,
                  [this](const std::string& topic, const ros::Time& stamp, const auto& message) { bag_->write(topic, stamp, message); });
  for (const EnergySample& energies : samples.energies) write_status(energies);
  if (options_.clouds) write_clouds();
}

void BagRun::write_first_messages() {
  const ros::Time stamp = clock_.at(first_.time);
  bag_->write_latched("case", stamp, case_message(simulation_->scene(), device_));
  bag_->write_latched("markers", stamp, markers(case_, simulation_->layout(), frames_));
  tf2_msgs::TFMessage transforms;
  transforms.transforms = static_transforms(case_, frames_);
  bag_->write_latched("/tf_static", stamp, transforms);
}

void BagRun::write_status(const EnergySample& energies) {
  if (energies.time < next_status_ - rounding) return;
  next_status_ += status_period;
  RunState run;
  run.phase = SolverStatus::RUNNING;
  run.start_progress = 1.0;
  run.device = device_;
  if (seconds_ > 0) {
    run.real_time_factor = (last_.time - first_.time) / seconds_;
    run.steps_per_second = static_cast<double>(last_.step - first_.step) / seconds_;
  }
  SolverState solver = last_;
  solver.time = energies.time;
  bag_->write("status", clock_.at(energies.time), status_message(case_, solver, energies, run, clock_));
}

void BagRun::write_clouds() {
  if (last_.time < next_cloud_ - rounding) return;
  next_cloud_ += 1.0 / case_.publishing.cloud_bag_rate;
  const auto cloud =
      cloud_message(simulation_->free_surface(), CloudFields::surface, case_.publishing.max_points, case_.publishing.world_frame, clock_);
  bag_->write("free_surface", cloud.header.stamp, cloud);
}

void BagRun::finish() {
  if (!violation_.empty()) save_violation();
  if (bag_) {
    RunState run;
    run.phase = violation_.empty() ? SolverStatus::FINISHED : SolverStatus::FAILED;
    run.start_progress = 1.0;
    run.device = device_;
    run.failure = violation_;
    bag_->write("status", clock_.at(last_.time), status_message(case_, last_, energies_, run, clock_));
    bag_->finish();
  }
  if (violation_.empty() && !options_.save.empty()) simulation_->save(options_.save);
}

void BagRun::save_violation() {
  const fs::path beside = options_.bag.empty() ? fs::path(options_.case_file).filename() : fs::path(options_.bag);
  const std::string snapshot = fs::path(beside).replace_extension(".snapshot").string();
  try {
    simulation_->save(snapshot);
    violation_ += "; its state is in '" + snapshot + "'";
  } catch (const Error& error) {
    log(LogLevel::warning, error.what());
  }
  log(LogLevel::error, violation_);
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
  if (bag_) std::printf("bag               %s\n", bag_->path().c_str());
  if (!options_.save.empty() && violation_.empty()) std::printf("snapshot          %s\n", options_.save.c_str());
  if (!options_.profile) return;
  std::printf("\n%-32s %10s %12s %8s\n", "kernel", "launches", "seconds", "share");
  const std::vector<KernelTime> kernels = simulation_->kernel_times();
  double all = 0.0;
  for (const KernelTime& kernel : kernels) all += kernel.seconds;
  for (const KernelTime& kernel : kernels)
    std::printf("%-32s %10llu %12.4f %6.1f %%\n", kernel.kernel.c_str(), static_cast<unsigned long long>(kernel.launches), kernel.seconds,
                all > 0 ? 100.0 * kernel.seconds / all : 0.0);
}

void BagRun::say(const std::string& text) {
  if (!options_.quiet) std::printf("%s%s", text.c_str(), !text.empty() && text.back() == '\n' ? "" : "\n");
  std::fflush(stdout);
}

double BagRun::elapsed() const { return std::chrono::duration<double>(Clock::now() - began_).count(); }

}  // namespace wavetank

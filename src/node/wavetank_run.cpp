// Simulates a case without a ROS master and writes a bag: everything but the process's own affairs is in BagRun.
#include <atomic>
#include <chrono>
#include <cstdio>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "wavetank/common/ending_signals.h"
#include "wavetank/common/log.h"
#include "wavetank/common/standard_output.h"
#include "wavetank/common/visible_text.h"
#include "wavetank/compute/device.h"
#include "wavetank/node/bag_run.h"
#include "wavetank/node/check_report.h"
#include "wavetank/node/rank_programs.h"
#include "wavetank/node/resources.h"
#include "wavetank/node/run_options.h"
#include "wavetank/sph/schedule_page.h"

namespace {

using namespace wavetank;

constexpr int exit_error = 2;
constexpr int exit_violation = 3;
constexpr int exit_signal = 128;  // plus the signal's number, as shells have it

std::atomic<int> caught_signal{0};

bool is_quiet = false;

void log_to_console(LogLevel level, const std::string& line) {
  if (level == LogLevel::info) {
    if (!is_quiet) std::printf("%s\n", line.c_str());
    return;
  }
  std::fprintf(stderr, "wavetank_run: %s%s\n", level == LogLevel::warning ? "warning: " : "", line.c_str());
}

void list_devices() {
  const std::vector<compute::DeviceInfo> devices = compute::list_devices();
  if (devices.empty())
    throw Error("there is no OpenCL device here: install pocl-opencl-icd for the CPU, or your graphics card's OpenCL driver");
  for (const compute::DeviceInfo& device : devices) std::printf("%s\n", device.describe().c_str());
}

void check(const RunOptions& options) {
  const Case checked = read_case_file(options.case_file, options.overrides, {resolve_resource, {}});
  check_names(checked);
  SimulationOptions simulation_options;
  simulation_options.resolve = resolve_resource;
  if (options.parts > 0) {
    std::fputs(parts_report(checked, estimate_parts(checked, options.parts, simulation_options)).c_str(), stdout);
    return;
  }
  std::fputs(check_report(checked, estimate(checked, simulation_options)).c_str(), stdout);
}

void print_schedule(const RunOptions& options) {
  std::fputs(schedule_page(read_case_file(options.case_file, options.overrides, {resolve_resource, {}})).c_str(), stdout);
}

void catch_signal(int number) { caught_signal = number; }

/// The run of this process while mpirun may end it, which kills a second after it has asked.
class RunUnderLauncher {
 public:
  explicit RunUnderLauncher(BagRun& run) { set(&run); }
  ~RunUnderLauncher() { set(nullptr); }
  RunUnderLauncher(const RunUnderLauncher&) = delete;
  RunUnderLauncher& operator=(const RunUnderLauncher&) = delete;

  static void end_soon(int number) {
    catch_signal(number);
    std::this_thread::sleep_for(std::chrono::milliseconds(400));
    const std::lock_guard<std::mutex> lock(mutex_);
    if (run_ != nullptr) run_->leave_start(exit_signal + number);
  }

 private:
  static void set(BagRun* run) {
    const std::lock_guard<std::mutex> lock(mutex_);
    run_ = run;
  }

  static inline std::mutex mutex_;
  static inline BagRun* run_ = nullptr;
};

int run(const RunOptions& options, parallel::Ranks* ranks) {
  std::optional<EndingSignals> signals;
  if (ranks == nullptr) signals.emplace(catch_signal);
  BagRun bag_run(options, caught_signal, ranks);
  std::optional<RunUnderLauncher> under_launcher;
  if (ranks != nullptr) under_launcher.emplace(bag_run);
  switch (bag_run.run()) {
    case BagRun::Outcome::done:
      return 0;
    case BagRun::Outcome::violated:
      return exit_violation;
    case BagRun::Outcome::interrupted:
      return exit_signal + caught_signal;
  }
  return exit_error;
}

/// `ranks`: null of a process that is alone.
int program(int argc, char** argv, parallel::Ranks* ranks) {
  try {
    const RunOptions options = read_command_line(argc, argv);
    is_quiet = options.quiet;
    switch (options.action) {
      case RunOptions::Action::list_devices:
        list_devices();
        finish_printing();
        return 0;
      case RunOptions::Action::check:
        check(options);
        finish_printing();
        return 0;
      case RunOptions::Action::schedule:
        print_schedule(options);
        finish_printing();
        return 0;
      case RunOptions::Action::run:
        return run(options, ranks);
      case RunOptions::Action::nothing:
        finish_printing();
        return 0;
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "wavetank_run: %s\n", visible_lines(error.what()).c_str());
  }
  return exit_error;
}

/// One of the processes that mpirun has started.
int rank_program(int argc, char** argv) {
  const EndingSignals signals(RunUnderLauncher::end_soon);  // before MPI has threads
  std::unique_ptr<parallel::Ranks> ranks;
  try {
    ranks = parallel::join_ranks();
  } catch (const std::exception& error) {
    if (parallel::rank_by_launcher() == 0) std::fprintf(stderr, "wavetank_run: %s\n", error.what());
    return exit_error;
  }
  if (ranks->rank() > 0) return serve_first_rank(*ranks);
  return ranks->end(program(argc, argv, ranks.get()));
}

}  // namespace

int main(int argc, char** argv) {
  let_writing_fail();
  set_log_sink(log_to_console);
  return parallel::is_under_launcher() ? rank_program(argc, argv) : program(argc, argv, nullptr);
}

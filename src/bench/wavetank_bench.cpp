// Measures how fast this machine simulates stock cases: everything but the process's own affairs is in BenchRun.
#include <atomic>
#include <cstdio>
#include <exception>

#include "bench_options.h"
#include "bench_run.h"
#include "own_command.h"
#include "parts_model.h"
#include "wavetank/common/ending_signals.h"
#include "wavetank/common/log.h"
#include "wavetank/common/standard_output.h"
#include "wavetank/common/whole_file.h"

namespace {

using namespace wavetank;
using namespace wavetank::bench;

constexpr int exit_error = 2;
constexpr int exit_signal = 128;  // plus the signal's number, as shells have it

std::atomic<int> caught_signal{0};

void log_warnings(LogLevel level, const std::string& line) {
  if (level != LogLevel::info) std::fprintf(stderr, "wavetank_bench: warning: %s\n", line.c_str());
}

void list(const BenchOptions& options) {
  const std::vector<BenchCase> cases = options.short_set         ? short_cases()
                                       : options.filters.empty() ? all_cases()
                                                                 : chosen_cases(options.filters);
  for (const BenchCase& bench_case : cases) std::printf("%s\n", bench_case.name.c_str());
}

void print_start_up(const BenchOptions& options) {
  std::printf("%s\n", text_of(start(make_case(case_named(options.start_up_of), options.device)).time).c_str());
}

int run(const BenchOptions& options, int argc) {
  const std::vector<BenchCase> cases = options.short_set ? short_cases() : chosen_cases(options.filters);
  if (!options.json.empty()) check_writable(options.json, "the report");
  const EndingSignals signals([](int number) { caught_signal = number; });
  const compute::DeviceInfo device = compute::choose_device(options.device);
  const std::vector<std::string> command = options.cold_build ? own_command(argc) : std::vector<std::string>();
  const Report report = BenchRun(options, device, command, [] { return caught_signal != 0; }).run(cases);
  std::printf("%s", table_of(report).c_str());
  if (!options.json.empty()) write_whole(options.json, json_of(report), "the report");
  finish_printing();
  return report.interrupted ? exit_signal + caught_signal : 0;
}

int run_parts(const BenchOptions& options) {
  const std::vector<BenchCase> cases = options.filters.empty() ? std::vector<BenchCase>{short_cases()[0]} : chosen_cases(options.filters);
  if (cases.size() != 1)
    throw Error("--parts is of one case, but --filter leaves " + std::to_string(cases.size()) + " (--list names them)");
  const EndingSignals signals([](int number) { caught_signal = number; });
  const PartsReport report =
      measure_parts(cases[0], compute::choose_device(options.device), options.parts, options.repeats, [] { return caught_signal != 0; });
  std::printf("%s", table_of(report).c_str());
  finish_printing();
  return caught_signal != 0 ? exit_signal + caught_signal : 0;
}

}  // namespace

int main(int argc, char** argv) {
  let_writing_fail();
  try {
    set_log_sink(log_warnings);
    const BenchOptions options = read_bench_options(argc, argv);
    switch (options.action) {
      case BenchOptions::Action::list:
        list(options);
        finish_printing();
        return 0;
      case BenchOptions::Action::parts:
        return run_parts(options);
      case BenchOptions::Action::start_up:
        print_start_up(options);
        finish_printing();
        return 0;
      case BenchOptions::Action::run:
        return run(options, argc);
      case BenchOptions::Action::nothing:
        return 0;
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "wavetank_bench: %s\n", error.what());
    return exit_error;
  }
  return exit_error;
}

#include "bench_run.h"

#include <cstdio>
#include <limits>
#include <utility>

#include "cold_build.h"
#include "text_table.h"
#include "wavetank/common/error.h"

namespace wavetank::bench {
namespace {

constexpr double usable_memory = 0.9;  // of the device's: it is not the only one to use it

std::string gibibytes(double bytes) { return figure(bytes / (1024.0 * 1024.0 * 1024.0)) + " GiB"; }

double bytes_per_particle(const Simulation& simulation) {
  return static_cast<double>(simulation.device_memory()) / static_cast<double>(simulation.state().particles);
}

}  // namespace

BenchRun::BenchRun(const BenchOptions& options, const compute::DeviceInfo& device, std::vector<std::string> command,
                   std::function<bool()> stopped)
    : options_(options), device_(device), command_(std::move(command)), stopped_(std::move(stopped)) {}

Report BenchRun::run(const std::vector<BenchCase>& cases) {
  Report report;
  report.device = device_.describe();
  report.repeats = options_.repeats;
  std::fprintf(stderr, "limits of %s\n", report.device.c_str());
  report.limits = measure_limits(device_);
  for (std::size_t k = 0; k < cases.size() && !stopped_(); ++k) {
    std::fprintf(stderr, "%zu of %zu: %s\n", k + 1, cases.size(), cases[k].name.c_str());
    try {
      if (std::optional<Measurement> measured = measure(cases[k])) report.cases.push_back(std::move(*measured));
    } catch (const Error& error) {
      if (stopped_()) break;  // what was started for it was ended too
      std::fprintf(stderr, "skipped %s: %s\n", cases[k].name.c_str(), error.what());
      report.skipped.push_back({cases[k].name, error.what()});
    }
  }
  report.interrupted = stopped_();
  return report;
}

std::optional<Measurement> BenchRun::measure(const BenchCase& bench_case) {
  const Kernels& kernels = kernels_of(bench_case.small_twin);
  check_memory(bench_case, kernels.bytes_per_particle);
  const Started started = start(make_case(bench_case, device_.indices()));
  const std::vector<Block> blocks = measure_blocks(*started.simulation, options_.repeats, stopped_);
  if (blocks.empty()) return {};
  Measurement measured = summarised(bench_case, started.simulation->state().particles, blocks);
  measured.bytes_per_particle = bytes_per_particle(*started.simulation);
  measured.start_up = started.time;
  measured.cold_build = kernels.cold_build;
  return measured;
}

const BenchRun::Kernels& BenchRun::kernels_of(const std::string& twin) {
  const auto known = kernels_.find(twin);
  if (known != kernels_.end()) return known->second;
  Kernels kernels;
  kernels.cold_build = std::numeric_limits<double>::quiet_NaN();
  if (options_.cold_build) {
    std::fprintf(stderr, "  building the kernels with empty caches\n");
    kernels.cold_build = cold_build_seconds(command_, twin, device_.indices());
  }
  kernels.bytes_per_particle = bytes_per_particle(*start(make_case(case_named(twin), device_.indices())).simulation);
  return kernels_.emplace(twin, kernels).first->second;
}

void BenchRun::check_memory(const BenchCase& bench_case, double bytes_per_particle) const {
  const double needed = bytes_per_particle * static_cast<double>(particles_at(bench_case.dimensions, bench_case.spacing));
  const double there = static_cast<double>(device_.global_memory);
  if (needed > usable_memory * there) throw Error("it needs about " + gibibytes(needed) + " on the device, which has " + gibibytes(there));
}

}  // namespace wavetank::bench
